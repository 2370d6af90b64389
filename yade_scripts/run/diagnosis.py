"""Why a run has failed, in one line."""

import numpy as np


class RunFailed(RuntimeError):
    """The simulation can't be continued; the message is one line."""


def suspects(state):
    """What to look at in a failed state: its fastest body and the contact of largest overlap, as a clause.

    state: as contact_law.snapshot() gives it.
    """
    speed = np.linalg.norm(state["velocity"], axis=1)
    fastest = np.argmax(speed)
    text = f'; body {state["ids"][fastest]} is the fastest ({speed[fastest]:.4g} m/s)'
    first, second = state["contact_pairs"].T
    if not len(first):
        return text + ", and none touch any more"
    radius, apart = state["radius"], state["position"][first] - state["position"][second]
    if "cell_size" in state:
        apart -= state["cell_size"] * np.round(apart / state["cell_size"])  # of the nearest images
    overlap = radius[first] + radius[second] - np.linalg.norm(apart, axis=1)
    relative = overlap / np.minimum(radius[first], radius[second])
    deepest = np.argmax(relative)
    return (
        f'{text}, the contact of largest overlap is that of body {state["ids"][first[deepest]]} and body '
        f'{state["ids"][second[deepest]]} ({relative[deepest]:.4g} of the smaller radius)'
    )
