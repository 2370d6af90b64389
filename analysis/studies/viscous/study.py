"""The study of A22's collisions."""

from ...runs.collect import Scene
from ..definition import Study
from .comparison import remarks, sections
from .measure import COLUMNS, measure
from .results import make_results

STUDY = Study(
    question="How much does viscous drag between grains help colliding aggregates to grow, at which velocity do they fragment, and how are "
    "the fragments distributed? Arakawa, Tanaka & Kokubo (2022, A22), Impacts of viscous dissipation on collisional growth and "
    "fragmentation of dust aggregates.",
    title="Viscous dissipation, oblique collisions and fragments beside A22",
    # Collisions of equal BPCA aggregates of equal ice grains, without bonds, springs held at their limits.
    scene=Scene(
        name="A22's scene",
        values={"packing": "bpca", "neck": 0.0, "planar": 0, "material": "ice", "sizes": "equal", "limit": "held"},
        numbers=("grains", "impact", "velocity", "viscoelasticTime", "seed"),
    ),
    columns=COLUMNS,
    measure=measure,
    results=make_results,
    sections=sections,
    remarks=remarks,
)
