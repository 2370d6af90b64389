"""Tables of the study of Arakawa et al. (2024, A24): head-on collisions of equal CPE aggregates of ice grains.

full: what Figs 4 to 9 show (section 3), ten seeds of every collision. desk: a selection for an evening, at twice the
time step. first: one figure (Fig. 8, R = 40), some minutes. prediction: pairs whose largest compression was predicted
from their packings before they ran. referee: what the comparison with the paper leaves open, mostly pairs of desk with
one thing changed. Rows stand in the order of their worth: small aggregates first, the first points of every figure
early."""

from itertools import product

STEP, PAPERS_STEP, LONG_STEP = 0.2, 0.1, 0.3  # t0; at 0.2 the ledger closes to 5e-4 of K(0) or better
REFERENCE = 5  # i of the velocity 10^(0.1 i) m/s at which sizes are compared (Figs 5 to 7)
VELOCITIES = range(8)
FILLINGS = (0.4, 0.3)

# {(filling, radius): seeds} at the reference velocity, seeds of every other velocity at R = 40, and of slow collisions
# of larger aggregates, which show best whether tau_max falls with velocity (the elastic limit's sign)
DESK_SIZES = {(filling, radius): n for radius, n in {40: 20, 50: 8, 60: 8, 80: 3}.items() for filling in FILLINGS}
DESK_VELOCITIES = 10
DESK_SLOW = {(0.4, 60): 3, (0.3, 60): 2}
SLOW = (0, 2)
TIME_UNIT = "1.936532021439599e-10"  # s: t0 of ice
# The paper follows aggregates of 80 grain radii for 1000 ns, which is 64.6 t0 per grain radius; times from the start.
DURATION = "64.6*{radius}*" + TIME_UNIT
# The slowest at R = 40 are followed for twice as long, when more of them have stuck or parted.
FOLLOWED = {(40, i): "1e-6" for i in range(3)}  # {(radius, i): duration [s]}
FIRST = 2  # seeds of each of these that come before any third
FIRST_LOOK = (1, 3, 5, 7)  # i of the velocities of the table first
LONG = "runs/elastoplastic-long"


def row(filling, radius, i, seed, folder="runs/elastoplastic", step=STEP, duration=None, ending="", **changed):
    """A row of a table, whose run folder is FOLDER/fFILLING-RRADIUS-iI-sSEED and the ending; duration [s] as text
    (DURATION if left out); changed: other parameters of the collision."""
    name = f"f{filling:g}-R{radius:g}-i{i}-s{seed}{ending}"
    found = {"description": name, "filling": filling, "radius": radius, "velocity": f"10**(0.1*{i})", "seed": seed}
    found |= {**changed, "duration": duration or DURATION.format(radius=radius), "stepFraction": step, "threads": 1}
    return {**found, "out": f"{folder}/{name}"}


def desk():
    """Rows of the small study."""
    sizes = [(*size, REFERENCE, seed) for size, seeds in DESK_SIZES.items() for seed in range(1, seeds + 1)]
    scenes = product(range(1, DESK_VELOCITIES + 1), FILLINGS, VELOCITIES)
    velocities = [(filling, 40, i, seed) for seed, filling, i in scenes if i != REFERENCE]
    slow = [(*size, i, seed) for size, seeds in DESK_SLOW.items() for i in SLOW for seed in range(1, seeds + 1)]
    ordered = sorted(sizes + velocities + slow, key=_worth)
    return [row(*scene, duration=FOLLOWED.get((scene[1], scene[2]))) for scene in ordered]


def full():
    """Rows of all of the paper's runs."""
    scenes = {*product(FILLINGS, (40, 50, 60, 70, 80), (REFERENCE,)), *product(FILLINGS, (40, 80), VELOCITIES)}
    scenes = sorted(scenes, key=lambda scene: (scene[1], -scene[0], scene[2]))
    ordered = sorted(((*scene, seed) for scene in scenes for seed in range(1, 11)), key=_worth)
    return [row(*scene, folder="runs/elastoplastic-full", step=PAPERS_STEP) for scene in ordered]


def _worth(scene):
    """Sorts collisions by their worth."""
    _, radius, _, seed = scene
    return seed > FIRST, radius, seed


def first():
    """Rows of one figure."""
    seeds = range(1, FIRST + 1)
    return [row(0.4, 40, i, seed, folder="runs/elastoplastic-first") for seed in seeds for i in FIRST_LOOK]


def prediction():
    """Rows of pairs that were predicted: from the filling of the zones that meet at R = 60 and 80, and from the overlap
    of a rigid approach at R = 40."""

    def pairs(radius, i, seeds, **more):
        return [row(f, radius, i, s, viscoelasticTime=0, **more) for f in FILLINGS for s in seeds]

    slow = pairs(40, 0, range(201, 211), duration="8e-7", ending="-0.8us")
    return pairs(60, REFERENCE, range(101, 109)) + slow + pairs(80, REFERENCE, range(4, 11))


# What the comparison leaves open: (radius, exponents, seeds, fillings, what else differs from desk).
LONGER = {"step": LONG_STEP, "duration": "3e-6", "ending": "-3us", "folder": LONG}
REFEREE = [
    # Is drag left on? With T_vis: paired differences of d_max and t_max.
    *(
        (40, (REFERENCE,), range(1, 11), (filling,), {"viscoelasticTime": f"{ps}e-12", "ending": f"-T{ps}ps"})
        for filling, ps in product(FILLINGS, (1, 3, 6))
    ),
    # Did the paper keep the grains outside the largest piece?
    (40, (REFERENCE,), range(1, 21), FILLINGS, {"removeLooseGrains": 1, "ending": "-largest"}),
    # Neighbours that start without overlap (next to none: rounding would decide at 0 which touch).
    (40, (REFERENCE,), range(1, 11), FILLINGS, {"initialOverlap": 0.001, "ending": "-overlap0.001"}),
    # R = 70 of Figs 5 and 6.
    (70, (REFERENCE,), range(1, 6), FILLINGS, {}),
    # Outcomes: sticking at 1 to 2.5 m/s. Of a pair that has also run for less the longer run counts.
    (40, (0, 2, 4), range(1, 21), (0.4,), LONGER),
    # E* at 0.4, where tau v/delta differs most between elastic and rigid-plastic spheres, until the halves part
    # fastest.
    (80, (0, 2), range(1, 7), (0.4,), {"step": LONG_STEP, "duration": "8e-7", "ending": "-0.8us"}),
    # E* hangs on delta_offset, the line of d_max against size: the ends of the sizes, until the halves part fastest.
    (80, (REFERENCE,), range(11, 51), (0.4,), {"step": LONG_STEP, "duration": "4e-7", "ending": "-0.4us"}),
    (40, (REFERENCE,), range(21, 61), (0.4,), {"step": LONG_STEP, "duration": "3e-7", "ending": "-0.3us"}),
    (60, (0, 2, 4), range(1, 11), (0.4,), LONGER),
]


def referee():
    """Rows of REFEREE."""
    usual = {"viscoelasticTime": 0, "removeLooseGrains": 0, "initialOverlap": 1}
    return [
        row(filling, radius, i, seed, **{**usual, **changed})
        for radius, exponents, seeds, fillings, changed in REFEREE
        for filling, i, seed in product(fillings, exponents, seeds)
    ]


FIGURES = "Arakawa et al. (2024), section 3 and Figs 4 to 9: head-on collisions of equal CPE aggregates of ice grains."
UNITS = "Units: radius: grain radii; velocity: m/s; duration: s; stepFraction: t0."
PREDICTED = "Arakawa et al. (2024): pairs whose largest compression was predicted from their packings before they ran."
OPEN = "Arakawa et al. (2024): what the comparison leaves open."


def tables():
    """{size: (rows, head)}."""
    with_drag = UNITS.replace("duration", "viscoelasticTime, duration")
    return {
        "first": (first(), f"{FIGURES} One figure: Fig. 8 at R = 40.\n{UNITS}"),
        "desk": (desk(), f"{FIGURES} A selection.\n{UNITS}"),
        "full": (full(), f"{FIGURES} All of the paper's.\n{UNITS}"),
        "prediction": (prediction(), f"{PREDICTED}\n{with_drag}"),
        "referee": (referee(), f"{OPEN}\n{with_drag}"),
    }
