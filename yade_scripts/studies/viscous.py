"""Tables of the study of Arakawa et al. (2022, A22): collisions of two equal BPCA aggregates of ice grains.

full: section 2.4, 416 collisions of aggregates of 50,000 grains, one seed. desk: an evening on two cores: the whole
grid of B_off, speed and T_vis with aggregates of 500 grains and several seeds, the speeds around v_fra with 2,000, both
at twice the time step, and the paper's own size where Fig. 1 is, with three pairs of aggregates where the paper has
one. prediction: larger aggregates, whose <f_gro> was predicted from those of 500 and 2,000 grains before they ran, and
one head-on collision of the paper's size. own: the paper's own size, with and without drag, followed to the paper's
last time. Rows stand in the order of their worth: whole grids of one seed after another."""

from itertools import product

TWELFTHS = range(13)  # B_off^2 in twelfths
EXPONENTS = range(13, 21)  # i of 10^(0.1 i) m/s
PICOSECONDS = (0, 1, 3, 6)  # T_vis
FULL_GRAINS = 50_000
REFERENCE = (3, 17)  # twelfths and i of Fig. 1: B_off^2 = 3/12, 50.1 m/s
DURATION = "6.34e-6"  # s: the last time of Fig. 1
STATES = 21  # every 0.317 us: the times of Figs 1, 10 and 11 are among them

# {grains of an aggregate: (exponents i, seeds)}
DESK = {500: (EXPONENTS, 4), 2000: (range(16, 21), 3)}
REFERENCE_SEEDS, REFERENCE_PICOSECONDS = 3, (0, 6)  # at the paper's size
STEP, LONGER_STEP = 0.1, 0.2  # t0; the longer one for smaller aggregates: its ledger closes to 1e-3 of K(0)

OWN_PAIRS = {REFERENCE[1]: 4, 18: 6}  # by i; v_fra is 50 to 60 m/s in the paper
EDGE = (2, 4, 5)  # twelfths: beside REFERENCE, whose pairs the desk table has too
# Followed to the end, with a shorter step while the aggregates fly through each other: the ledger closes to 1e-4 of
# K(0).
FOLLOWED = {"endWhenApart": 0, "stepFraction": 0.2, "impactStepFraction": 0.1}

PREDICTED_GRAINS, PREDICTED_SEEDS, PREDICTED_EXPONENTS = 10_000, 2, range(17, 21)
# Seven offsets are no mean by the paper's eq 29: the head-on peak has the weight 1/12 in place of 1/24, and <f_gro> of
# 2,000 grains at 63 m/s is higher by 0.04.
EVERY_SECOND, THE_OTHERS = TWELFTHS[::2], TWELFTHS[1::2]


def grid(grains, exponents, seeds, times=PICOSECONDS):
    """[(grains, twelfths, i, picoseconds, seed)] of every B_off, speed and T_vis, seed by seed."""
    places = product(seeds, reversed(exponents), times, TWELFTHS)
    return [(grains, twelfths, i, time, seed) for seed, i, time, twelfths in places]


def desk():
    """Collisions of the desk table: every seed in turn, the paper's size first, then size by size."""
    scenes = []
    for seed in range(1, max(seeds for _, seeds in DESK.values()) + 1):
        if seed <= REFERENCE_SEEDS:
            scenes += [(FULL_GRAINS, *REFERENCE, time, seed) for time in REFERENCE_PICOSECONDS]
        for grains, (exponents, seeds) in DESK.items():
            scenes += grid(grains, exponents, [seed]) if seed <= seeds else []
    return scenes


def full():
    """Collisions of the paper, those of Fig. 1 first."""
    return sorted(grid(FULL_GRAINS, EXPONENTS, [1]), key=lambda scene: scene[1:3] != REFERENCE)


def prediction():
    """Collisions that were predicted, without drag and with the most: of every second offset head-on ones first, then
    seed by seed, and one of the paper's size; then the offsets between, seed by seed."""
    seeds = range(1, PREDICTED_SEEDS + 1)
    scenes = grid(PREDICTED_GRAINS, PREDICTED_EXPONENTS, seeds, REFERENCE_PICOSECONDS)
    first = [scene for scene in scenes if scene[1] in EVERY_SECOND]
    first = sorted([*first, (FULL_GRAINS, 0, REFERENCE[1], 0, 1)], key=lambda scene: scene[1] > 0)
    return first + [scene for scene in scenes if scene[1] in THE_OTHERS]


def own():
    """Collisions of the paper's size: at 50.1 m/s offsets about the edge of merging first, pair by pair, then the
    others; at 63.1 m/s pair by pair, those without drag first."""
    first, faster = (
        grid(FULL_GRAINS, [i], range(1, pairs + 1), REFERENCE_PICOSECONDS) for i, pairs in OWN_PAIRS.items()
    )
    first.sort(key=lambda scene: (scene[1] not in EDGE, scene[4], scene[1]))
    return first + sorted(faster, key=lambda scene: scene[3])


def rows(scenes, folder, **others):
    """Rows of a table, with run folders FOLDER/nGRAINS-vI-bTWELFTHS-tPS-sSEED."""
    found = []
    for grains, twelfths, i, time, seed in scenes:
        name = f"n{grains}-v{i}-b{twelfths}-t{time}-s{seed}"
        row = {"description": name, "packing": "bpca", "grains": grains, "impact": f"({twelfths}/12)**0.5"}
        row |= {"velocity": f"10**(0.1*{i})", "viscoelasticTime": f"{time}e-12", "seed": seed, "duration": DURATION}
        row |= {"endWhenApart": 1, "states": STATES, "stepFraction": STEP if grains == FULL_GRAINS else LONGER_STEP}
        found.append({**row, "threads": 1, "out": f"{folder}/{name}", **others})
    return found


HEAD = (
    "Arakawa et al. (2022), section 2.4: collisions of two equal BPCA aggregates of ice grains, B_off^2 = 0 to 1. {}\n"
    "Units: impact: r_c,tar + r_c,pro (eq 27); velocity: m/s; viscoelasticTime, duration: s; stepFraction: t0."
)


def tables():
    """{size: (rows, head)}."""
    found = {
        "desk": (desk(), "runs/viscous", "Smaller aggregates, and six collisions of the paper's size."),
        "prediction": (prediction(), "runs/viscous", "Larger aggregates, predicted before they ran."),
        "full": (full(), "runs/viscous-full", "All of the paper's."),
    }
    found = {size: (rows(scenes, folder), HEAD.format(which)) for size, (scenes, folder, which) in found.items()}
    followed = rows(own(), "runs/viscous-own", **FOLLOWED)
    return {**found, "own": (followed, HEAD.format("The paper's size at 50.1 and 63.1 m/s, to its last time."))}
