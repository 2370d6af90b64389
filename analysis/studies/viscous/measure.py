"""What is measured of each collision of A22's: its place in the grid, fragments, energy, contacts and pairs of neighbours."""

from functools import lru_cache

import numpy as np

from ...measures.fragments import fragment_labels, fragment_sizes, growth_efficiency
from ...measures.ledger import initial_kinetic_energy
from ...measures.motion import NEAR, pair_velocities, root_mean_square
from ...measures.of_run import derived_constants
from ...runs.table import Column
from ...theory import Material, pair_constants, sticking_velocity
from ..columns import CLOSURE, END, GRAIN_RADIUS, MET, SEED, group, one, parameter
from ..definition import NotMeasured
from ..grains import require_papers_grains
from ..runs import alike
from .grid import offset_of_grid, time_of_grid, velocity_of_grid

# A22's five ways to lose energy; connection and disconnection together are its E_dis,c.
DISSIPATION = ("rollingDissipation", "slidingDissipation", "twistingDissipation", "connection", "disconnection", "drag")

# r_c that the aggregates' centres go until A22's last time, 6.34 us, in its slowest collisions: 10^1.3 m/s, r_c = 72.27 r of 1e-7 m.
RADII_TRAVELLED = 10**1.3 * 6.34e-6 / 72.27e-7
ENOUGH = 0.9  # of these: r_c scatters from pair to pair
REFERENCE = {"velocity": 10**1.7, "square": 3 / 12}  # m/s, B_off^2: the collision that A22 shows most
EVENTS = {"formed": "N_con", "broken": "N_cut"}  # contacts, and A22's names of their numbers
LATER = {"gaps": True, "absent": np.nan}  # of a column that the first runs don't have
FAST = 10.0  # m/s: A22 section 5.1 counts the pairs beyond
PAIR_SPEED = f"largest rms over the states of v_rel of pairs nearer than {NEAR:g} r (50.1 m/s, 3/12)"
FAST_PAIRS = f"the same of the number that approach, or that part, faster than {FAST:g} m/s; over N_tot"


def _grains(run):
    """NotMeasured where the two aggregates are not equally large."""
    numbers = np.bincount(run.start.aggregate, minlength=2)
    if numbers[0] != numbers[1]:
        raise NotMeasured(f"{run.path}: aggregates of {numbers[0]} and {numbers[1]} grains, A22's are equal")
    require_papers_grains(run)
    return int(numbers[0])


def _of_two_grains(run, row):
    own = derived_constants(run, "young", "poisson", "density", "surfaceEnergy", "criticalRolling", "viscoelasticTime")
    pair = pair_constants(Material(*own), row["grain_radius"])
    return pair.pull_off_force * pair.pull_off_overlap, _sticking_velocity(pair)


# Integrated once for each kind of grain: PairConstants are hashable.
_sticking_velocity = lru_cache(sticking_velocity)


def _characteristic_radius(run):
    return float(np.mean(derived_constants(run, "targetCharacteristicRadius", "projectileCharacteristicRadius")))


def _fragments(run, row):
    """NotMeasured where the run is too short for them to be final: where it ended with its duration before the aggregates' centres would have
    gone as many r_c as in the paper's slowest collisions. Runs that ended because nothing could meet any more are final."""
    time, duration = float(run.history["time"][-1]), run.parameters.get("duration")
    least = ENOUGH * RADII_TRAVELLED * row["characteristic_radius"] / row["velocity"]
    if duration is not None and time >= 0.999 * float(duration) and time < least:
        said = f"lasts {time:.3g} s, too short for final fragments: must be {least:.3g} s or more"
        raise NotMeasured(f"{run.path}: {said}")
    sizes = fragment_sizes(fragment_labels(len(run.last.radius), run.last.contact_pairs))
    largest = int(sizes.max())
    return largest, growth_efficiency(largest, row["grains"], row["grains"]), sizes_text(sizes)


def _largest_of_pairs(run, row):
    """(largest root mean square of v_rel [m/s], largest number of pairs that approach or part faster than FAST over N_tot) of pairs nearer
    than NEAR over the states (A22 Fig. 12, section 5.1); NaN for other collisions than REFERENCE, since all states are read."""
    if not alike([row["velocity"], row["impact"] ** 2], np.array(list(REFERENCE.values()))).all():
        return np.nan, np.nan
    distance, states = NEAR * run.derived["grainRadius"], range(len(run.states))
    arrays = (run.states.arrays(k, ("position", "velocity")) for k in states)
    values = [pair_velocities(own["position"], own["velocity"], distance) for own in arrays]
    fast = max(np.count_nonzero(sign * own > FAST) for own in values for sign in (1, -1))
    return float(np.nanmax([root_mean_square(own) for own in values])), fast / len(run.start.radius)


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


MEASURED = (
    one("grains", "", "grains of each aggregate", _grains, kind="i"),
    parameter("impact", "", "B_off (A22 eq 27); (k/12)^(1/2) where the run's is that rounded", shown=offset_of_grid),
    parameter("velocity", "m/s", "collision velocity; 10^(0.1 i) where it is that rounded", shown=velocity_of_grid),
    parameter("viscoelasticTime", "s", "T_vis of the viscous drag", shown=time_of_grid),
    SEED,
    GRAIN_RADIUS,
    group(
        _of_two_grains,
        Column("energy_unit", "J", "F_c delta_c"),
        Column("sticking_velocity", "m/s", "v_stick of two such grains head-on (A22 eq 30); inf: they always stick"),
    ),
    one("characteristic_radius", "m", "mean r_c of the two aggregates", _characteristic_radius),
    MET,
    group(
        _fragments,
        Column("largest", "", "N_lar: grains of the largest fragment", kind="i"),
        Column("growth", "", "f_gro (A22 eq 28)"),
        Column("fragments", "", "their grains at the end, as NUMBERxGRAINS, the largest first", kind="O"),
    ),
    one("kinetic_at_start", "J", "K(0)", lambda run: initial_kinetic_energy(run.history)),
    group(
        lambda run, row: [float(run.history[name][-1] - run.history[name][0]) for name in DISSIPATION],
        *(Column(name, "J", "change from the start to the end") for name in DISSIPATION),
    ),
    group(
        lambda run, row: [float(run.history[name][-1]) if name in run.history else np.nan for name in EVENTS],
        *(Column(name, "", f"{symbol}: contacts {name}", gaps=True) for name, symbol in EVENTS.items()),
    ),
    group(
        _largest_of_pairs,
        Column("pair_speed", "m/s", PAIR_SPEED, gaps=True),
        Column("fast_pairs", "", FAST_PAIRS, **LATER),
    ),
    CLOSURE,
    END,
)
