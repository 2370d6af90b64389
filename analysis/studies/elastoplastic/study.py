"""The study of A24's collisions."""

from ...runs.collect import Scene
from ..collision_points import HEAD_ON_ICE
from ..definition import Study
from .comparison import remarks, sections
from .measure import COLUMNS, measure
from .results import make_results

STUDY = Study(
    question="Do equal close-packed aggregates that collide head on compress like elastoplastic spheres (Andrews 1930), and with which "
    "yield stress and elastic modulus? Arakawa et al. (2024, A24), On the elastoplastic behavior in collisional compression of "
    "spherical dust aggregates.",
    title="Elastoplastic collisions beside A24",
    # Head-on collisions of CPE aggregates, without drag and bonds.
    scene=Scene(
        name="A24's scene",
        values={"packing": "cpe", **HEAD_ON_ICE},
        numbers=("filling", "radius", "velocity", "seed"),
    ),
    columns=COLUMNS,
    measure=measure,
    results=make_results,
    sections=sections,
    remarks=remarks,
)
