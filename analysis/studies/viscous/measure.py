"""One row of numbers for each collision."""

from functools import lru_cache

import numpy as np

from ...measures.fragments import fragment_labels, fragment_sizes, growth_efficiency
from ...measures.ledger import closure, initial_kinetic_energy
from ...measures.of_run import met
from ...measures.pair_velocities import NEAR, pair_velocities, root_mean_square
from ...runs.arrays import RunFolderError
from ...runs.table import Column
from ...theory import Material, pair_constants, sticking_velocity
from ..definition import NotMeasured
from ..grains import require_papers_grains
from .grid import offset_of_grid, time_of_grid, velocity_of_grid

# A22's five ways to lose energy; connection and disconnection together are its E_dis,c.
DISSIPATION = ("rollingDissipation", "slidingDissipation", "twistingDissipation", "connection", "disconnection", "drag")

# r_c that the aggregates' centres go until A22's last time, 6.34 us, in its slowest collisions: 10^1.3 m/s, r_c = 72.27 r of 1e-7 m.
RADII_TRAVELLED = 10**1.3 * 6.34e-6 / 72.27e-7
ENOUGH = 0.9  # of these: r_c scatters from pair to pair
REFERENCE_VELOCITY, REFERENCE_SQUARE = 10**1.7, 3 / 12  # m/s, B_off^2: the collision that A22 shows most
SAME = 1e-6  # relative, of the grid
FAST = 10.0  # m/s: A22 section 5.1 counts the pairs beyond

COLUMNS = (
    Column("grains", "", "grains of each aggregate", kind="i"),
    Column("impact", "", "B_off (A22 eq 27); (k/12)^(1/2) where the run's is that rounded"),
    Column("velocity", "m/s", "collision velocity; 10^(0.1 i) m/s where the run's is that rounded"),
    Column("viscoelasticTime", "s", "T_vis"),
    Column("seed", "", "random seed of the pair of aggregates", kind="i"),
    Column("grain_radius", "m", "radius of a grain"),
    Column("energy_unit", "J", "F_c delta_c"),
    Column("sticking_velocity", "m/s", "v_stick of two such grains head-on (A22 eq 30); inf where they always stick"),
    Column("characteristic_radius", "m", "mean r_c of the two aggregates"),
    Column("met", "", "whether the aggregates touched", kind="b"),
    Column("largest", "", "N_lar: grains of the largest fragment", kind="i"),
    Column("growth", "", "f_gro (A22 eq 28)"),
    Column("fragments", "", "their grains at the end, as NUMBERxGRAINS, the largest first", kind="O"),
    Column("kinetic_at_start", "J", "K(0)"),
    *(Column(name, "J", "change from the start to the end") for name in DISSIPATION),
    Column("formed", "", "N_con: contacts formed", gaps=True),
    Column("broken", "", "N_cut: contacts broken", gaps=True),
    Column(
        "pair_speed",
        "m/s",
        f"largest rms over the states of v_rel of pairs nearer than {NEAR:g} r (50.1 m/s, B_off^2 = 3/12)",
        gaps=True,
    ),
    Column(
        "fast_pairs",
        "",
        f"the same of the number of such pairs that approach, or that part, faster than {FAST:g} m/s; over N_tot",
        gaps=True,
        absent=float("nan"),
    ),
    Column("closure", "", "largest error of the energy ledger over K(0)"),
    Column("time", "s", "time at the end"),
)


def measure(run):
    """{column: value} of a RunFolder of A22's scene that has ended. NotMeasured where the two aggregates are not equally
    large, the grains are others than A22's or the run is too short for its fragments to be final, RunFolderError where something
    is missing."""
    start, end, history = run.start, run.last, run.history
    numbers = np.bincount(start.aggregate, minlength=2)
    if numbers[0] != numbers[1]:
        raise NotMeasured(f"{run.path}: aggregates of {numbers[0]} and {numbers[1]} grains, A22's are equal")
    scene = _scene(run, int(numbers[0]))
    require_papers_grains(run)
    _require_final(run, scene)
    sizes = fragment_sizes(fragment_labels(len(end.radius), end.contact_pairs))
    largest = int(sizes.max())
    return {
        **scene,
        "met": met(run),
        "largest": largest,
        "growth": growth_efficiency(largest, int(numbers[0]), int(numbers[1])),
        "fragments": sizes_text(sizes),
        "kinetic_at_start": initial_kinetic_energy(history),
        **{name: float(history[name][-1] - history[name][0]) for name in DISSIPATION},
        **{name: _last(history, name) for name in ("formed", "broken")},
        **dict(
            zip(("pair_speed", "fast_pairs"), largest_of_pairs(run) if is_reference(scene) else (float("nan"),) * 2)
        ),
        "closure": closure(history),
        "time": float(history["time"][-1]),
    }


def _require_final(run, scene):
    """NotMeasured where a run ended with its duration before the aggregates' centres would have gone as many r_c as in the
    paper's slowest collisions; runs that ended because nothing could meet any more are final."""
    time, duration = float(run.history["time"][-1]), run.parameters.get("duration")
    if duration is None or time < 0.999 * float(duration):
        return
    least = ENOUGH * RADII_TRAVELLED * scene["characteristic_radius"] / scene["velocity"]
    if time < least:
        raise NotMeasured(
            f"{run.path}: lasts {time:.3g} s, too short for final fragments: must be {least:.3g} s or more"
        )


def is_reference(row):
    """Whether it is the collision that A22 looks at most: 50.1 m/s, B_off^2 = 3/12; row: mapping, measured."""
    return abs(row["velocity"] / REFERENCE_VELOCITY - 1) < SAME and abs(row["impact"] ** 2 - REFERENCE_SQUARE) < SAME


def largest_of_pairs(run):
    """(largest root mean square of v_rel [m/s], largest number of pairs that approach or part faster than FAST over N_tot) over
    the states of a RunFolder (A22 Fig. 12, section 5.1)."""
    values = [own for _, own in _pairs_of_states(run)]
    fast = max(np.count_nonzero(sign * own > FAST) for own in values for sign in (1, -1))
    return float(np.nanmax([root_mean_square(own) for own in values])), fast / len(run.start.radius)


def pair_speeds(run):
    """[(time [s], root mean square of v_rel [m/s])] of the states of a RunFolder."""
    return [(time, root_mean_square(values)) for time, values in _pairs_of_states(run)]


def _pairs_of_states(run):
    """(time [s], v_rel (M,) [m/s] of pairs nearer than NEAR) of each state of a RunFolder."""
    distance = NEAR * run.derived["grainRadius"]
    for k, time in enumerate(run.states.times):
        arrays = run.states.arrays(k, ("position", "velocity"))
        yield float(time), pair_velocities(arrays["position"], arrays["velocity"], distance)


def sizes_text(sizes):
    """Fragments' grains (K,) as text: '1x43957 2x12 30x1'.

    >>> sizes_text([1, 5, 1])
    '1x5 2x1'
    """
    grains, number = np.unique(sizes, return_counts=True)
    return " ".join(f"{n}x{g}" for g, n in zip(grains[::-1], number[::-1]))


def sizes_from_text(text):
    """The sizes (K,) int that sizes_text wrote; ValueError where it is something else.

    >>> sizes_from_text("1x5 2x1").tolist()
    [5, 1, 1]
    """
    pairs = [part.split("x") for part in text.split()]
    return np.repeat([int(grains) for _, grains in pairs], [int(number) for number, _ in pairs])


def _scene(run, grains):
    derived, parameters = run.derived, run.parameters
    try:
        radius = float(derived["grainRadius"])
        names = ("young", "poisson", "density", "surfaceEnergy", "criticalRolling", "viscoelasticTime")
        pair = pair_constants(Material(*(float(derived[name]) for name in names)), radius)
        characteristic = [float(derived[f"{name}CharacteristicRadius"]) for name in ("target", "projectile")]
    except (KeyError, TypeError, ValueError) as error:
        raise RunFolderError(f"{run.path}: cannot be measured: {error}") from None
    return {
        "grains": grains,
        "impact": offset_of_grid(float(parameters["impact"])),
        "velocity": velocity_of_grid(float(parameters["velocity"])),
        "viscoelasticTime": time_of_grid(float(parameters["viscoelasticTime"])),
        "seed": int(parameters["seed"]),
        "grain_radius": radius,
        "energy_unit": pair.pull_off_force * pair.pull_off_overlap,
        "sticking_velocity": _sticking_velocity(pair),
        "characteristic_radius": float(np.mean(characteristic)),
    }


# Integrated once for each kind of grain: PairConstants are hashable.
_sticking_velocity = lru_cache(sticking_velocity)


def _last(history, name):
    return float(history[name][-1]) if name in history else float("nan")
