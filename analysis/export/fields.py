"""What is exported of a state: one list for grains and one for contacts, which every format follows.

Names are those by which OVITO knows particles of granular codes (id, radius, mass, v, omega), SI units throughout."""

from dataclasses import dataclass
from typing import Callable

import numpy as np

from ..measures.periodic_cell import nearest_image

UNITS = {"m": 1.0, "um": 1e-6, "nm": 1e-9}  # of lengths, where a format lets one choose


@dataclass(frozen=True)
class Field:
    """A quantity of every grain or contact: name, unit, meaning; values(Exported) -> (N,), (N, 3), (M,) or (M, 3)."""

    name: str
    unit: str
    meaning: str
    values: Callable


class Exported:
    """A state of a run as it is exported: state, density [kg/m^3] or None, and what follows from them."""

    def __init__(self, state, density):
        self.state, self.density = state, density
        first, second = state.contact_pairs[:, 0], state.contact_pairs[:, 1]
        between = state.position[second] - state.position[first]
        if state.cell_vectors is not None:
            between = _within(between, state.cell_vectors, np.round)
        elif state.cell_size is not None:
            between = nearest_image(between, state.cell_size)
        self.first, self.second, self.between = first, second, between  # (M,), (M,), (M, 3) [m]
        planes = state.plane_contacts
        self.on_planes = np.empty((0, 2), dtype=int) if planes is None else planes  # (K, 2): grain and plane

    def inside(self):
        """Positions (N, 3) [m]: in a periodic cell the images inside it."""
        state = self.state
        if state.cell_vectors is not None:
            return _within(state.position, state.cell_vectors, np.floor)
        return state.position if state.cell_size is None else state.position % state.cell_size

    def distance(self):
        """(M,) [m], of the grains' centres."""
        return np.linalg.norm(self.between, axis=1)

    def normal_forces(self):
        """(N, 3) [N], the sum of the contacts' normal forces on each grain, those with planes too."""
        on_first = -self.state.contact_normal_force[:, None] * self.between / self.distance()[:, None]
        total = np.zeros_like(self.state.position)
        np.add.at(total, self.first, on_first)
        np.add.at(total, self.second, -on_first)
        if len(self.on_planes):
            grains, planes = self.on_planes.T
            axis, force = self.state.plane_axis[planes], self.state.plane_contact_normal_force
            away = self.state.position[grains, axis] - self.state.plane_position[planes]
            np.add.at(total, (grains, axis), force * np.sign(away))
        return total

    def coordination(self):
        """(N,) int, contacts of each grain, those with planes too."""
        ends = np.concatenate([self.state.contact_pairs.ravel(), self.on_planes[:, 0]])
        return np.bincount(ends.astype(np.intp), minlength=len(self.state.radius))

    def fragments(self):
        """(N,) int, as measures.fragments.fragment_labels."""
        from ..measures.fragments import fragment_labels  # loads scipy, which listing the fields does without

        return fragment_labels(len(self.state.radius), self.state.contact_pairs)

    def overlap(self):
        """(M,) [m]."""
        return self.state.radius[self.first] + self.state.radius[self.second] - self.distance()

    def mass(self):
        """(N,) [kg]."""
        if self.state.mass is not None:
            return self.state.mass
        return 4.0 / 3.0 * np.pi * self.density * self.state.radius**3

    def material(self):
        """(N,) int."""
        return np.zeros(len(self.state.radius), dtype=int) if self.state.material is None else self.state.material


def _within(vectors, edges, whole):
    """Vectors (N, 3) less whole numbers of the cell's edges, the columns of (3, 3): np.round or np.floor of theirs."""
    return vectors - whole(vectors @ np.linalg.inv(edges).T) @ edges.T


GRAINS = (
    Field("id", "", "row of the grain in the states of the run", lambda e: np.arange(len(e.state.radius))),
    Field("radius", "m", "radius", lambda e: e.state.radius),
    Field("mass", "kg", "mass", lambda e: e.mass()),
    Field("material", "", "number of the material, from 0", lambda e: e.material()),
    Field("v", "m/s", "velocity", lambda e: e.state.velocity),
    Field("omega", "rad/s", "angular velocity", lambda e: e.state.angular_velocity),
    Field("aggregate", "", "aggregate at the start", lambda e: e.state.aggregate.astype(int)),
    Field("fragment", "", "fragment, 0 that of the most grains", lambda e: e.fragments()),
    Field("coordination", "", "number of contacts", lambda e: e.coordination()),
    Field("normal_force", "N", "sum of the normal forces of the contacts", lambda e: e.normal_forces()),
)
CONTACTS = (
    Field("id1", "", "id of the first grain", lambda e: e.first.astype(int)),
    Field("id2", "", "id of the second grain", lambda e: e.second.astype(int)),
    Field("normal_force", "N", "normal force, positive when repulsive", lambda e: e.state.contact_normal_force),
    Field("bonded", "", "1 for a sintered bond", lambda e: e.state.contact_bonded.astype(int)),
    Field("overlap", "m", "sum of the radii (before sintering) less the distance", lambda e: e.overlap()),
)


def grain_fields(exported):
    """{name: array} of the grains, without `mass` if the run has no density, and `material` if it has one."""
    missing = {"mass"} if exported.density is None and exported.state.mass is None else set()
    missing |= {"material"} if exported.state.material is None else set()
    return {field.name: field.values(exported) for field in GRAINS if field.name not in missing}


def exported_states(run):
    """An Exported for each state of a RunFolder, one at a time; RunFolderError when there is none."""
    run.start  # noqa: B018 (raises)
    density = run.derived.get("density")
    for state in run.states:
        yield Exported(state, density)
