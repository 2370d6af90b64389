"""An aggregate onto a plate at rest (collide.py target=wall): the plate is at x = 0, and the aggregate comes along -x."""

import numpy as np

from yade_scripts import packings
from yade_scripts.packings.placing import START_GAP
from yade_scripts.parameters import ParameterError

AGGREGATE, WALL = "aggregate", "wall"  # targets
AXIS = 0
NOT_OF_PLATES = {
    "projectileGrains": "the aggregate has grains",
    "projectileFile": "the aggregate is of file",
    "impact": "it meets the plate at right angles",
    "neck": "there are no sintered bonds to plates",
}


def require_usable(parameters):
    """Raise ParameterError for what a collision with a plate doesn't have."""
    for name, reason in NOT_OF_PLATES.items():
        value = getattr(parameters, name)
        if value:
            raise ParameterError(f"{name} = {value}: given with target = {WALL}; must be left out: {reason}")


def as_pair(parameters):
    """The parameters as step_choice knows them, which was measured on pairs: half of a pair meets its image as an aggregate a
    plate."""
    return parameters.changed(velocity=2 * parameters.velocity) if parameters.target == WALL else parameters


def placed(packing, velocity):
    """([Packing in its place], [its velocity (3,) [m/s]])."""
    gap = START_GAP * packing.radius.max() - (packing.position[:, AXIS] - packing.radius).min()
    return [packings.moved(packing, (gap, 0.0, 0.0))], [np.array([-velocity, 0.0, 0.0])]


def time_of_touch(packing, velocity):
    """Time [s] until the first grain of a placed packing touches the plate."""
    return float((packing.position[:, AXIS] - packing.radius).min() / velocity)


def series(state, aggregate_radius):
    """{name: value} of a collision's own series, by the mean distance from the plate; R_agg [m]."""
    d, v = aggregate_radius - state["position"][:, AXIS].mean(), -state["velocity"][:, AXIS].mean()
    return {"d": d, "v": v, "contacts_between": len(state["plane_contacts"])}
