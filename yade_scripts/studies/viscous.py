"""Tables of the study of Arakawa et al. (2022, A22): collisions of two equal BPCA aggregates of ice grains.

full: section 2.4, 416 collisions of aggregates of 50,000 grains, one seed. desk: an evening on two cores: the whole
grid of B_off, speed and T_vis with aggregates of 500 grains and four seeds, the speeds around v_fra with 2,000 and
three, both at twice the time step, and the paper's own size where Fig. 1 is. own: the paper's own size, with and
without drag, followed to the paper's last time. Rows stand in the order of their worth: whole grids of one seed after
another."""

from itertools import product

GRAINS = 50_000  # of the paper
TWELFTHS = range(13)  # B_off^2 in twelfths
EXPONENTS = range(13, 21)  # i of 10^(0.1 i) m/s
PICOSECONDS = (0, 1, 3, 6)  # T_vis
REFERENCE = (3, 17)  # twelfths and i of Fig. 1: B_off^2 = 3/12, 50.1 m/s
DURATION = "6.34e-6"  # s: the last time of Fig. 1
STATES = 21  # every 0.317 us: the times of Figs 1, 10 and 11 are among them
STEP, LONGER_STEP = 0.1, 0.2  # t0; the longer one for smaller aggregates: its ledger closes to 1e-3 of K(0)
EDGE = (2, 4, 5)  # twelfths: beside REFERENCE, whose pairs the desk table has too
# Followed to the end, with a shorter step while aggregates fly through each other: the ledger closes to 1e-4 of K(0).
FOLLOWED = {"endWhenApart": 0, "stepFraction": 0.2, "impactStepFraction": 0.1}

HEAD = (
    "Arakawa et al. (2022), section 2.4: collisions of two equal BPCA aggregates of ice grains, B_off^2 = 0 to 1. {}\n"
    "Units: impact: r_c,tar + r_c,pro (eq 27); velocity: m/s; viscoelasticTime, duration: s; stepFraction: t0."
)


def grid(grains, exponents, seeds, times=PICOSECONDS):
    """[(grains, twelfths, i, picoseconds, seed)] of every B_off, speed and T_vis, seed by seed."""
    places = product(seeds, reversed(exponents), times, TWELFTHS)
    return [(grains, twelfths, i, time, seed) for seed, i, time, twelfths in places]


def desk():
    """Every seed in turn: the paper's size first, then size by size."""
    scenes = []
    for seed in (1, 2, 3, 4):
        if seed < 4:
            scenes += [(GRAINS, *REFERENCE, time, seed) for time in (0, 6)]
        scenes += grid(500, EXPONENTS, [seed])
        if seed < 4:
            scenes += grid(2000, range(16, 21), [seed])
    return scenes


def own():
    """At 50.1 m/s offsets about the edge of merging first, pair by pair, then the others; at 63.1 m/s those without
    drag first (v_fra is 50 to 60 m/s in the paper)."""
    first, faster = grid(GRAINS, [17], range(1, 5), (0, 6)), grid(GRAINS, [18], range(1, 7), (0, 6))
    first.sort(key=lambda scene: (scene[1] not in EDGE, scene[4], scene[1]))
    return first + sorted(faster, key=lambda scene: scene[3])


def rows(scenes, folder, **others):
    """Rows of a table, with run folders FOLDER/nGRAINS-vI-bTWELFTHS-tPS-sSEED."""
    found = []
    for grains, twelfths, i, time, seed in scenes:
        name = f"n{grains}-v{i}-b{twelfths}-t{time}-s{seed}"
        row = {"description": name, "packing": "bpca", "atRest": 0, "grains": grains, "impact": f"({twelfths}/12)**0.5"}
        row |= {"velocity": f"10**(0.1*{i})", "viscoelasticTime": f"{time}e-12", "seed": seed, "duration": DURATION}
        row |= {"endWhenApart": 1, "states": STATES, "stepFraction": STEP if grains == GRAINS else LONGER_STEP}
        found.append({**row, "threads": 1, "out": f"{folder}/{name}", **others})
    return found


def tables():
    """{size: (rows, head)}."""
    full = sorted(grid(GRAINS, EXPONENTS, [1]), key=lambda scene: scene[1:3] != REFERENCE)  # those of Fig. 1 first
    which = "Smaller aggregates, and six collisions of the paper's size."
    followed = "The paper's size at 50.1 and 63.1 m/s, to its last time."
    return {
        "desk": (rows(desk(), "runs/viscous"), HEAD.format(which)),
        "full": (rows(full, "runs/viscous-full"), HEAD.format("All of the paper's.")),
        "own": (rows(own(), "runs/viscous-own", **FOLLOWED), HEAD.format(followed)),
    }
