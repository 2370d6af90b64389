"""Tables of the study of Arakawa et al. (2024, A24): head-on collisions of equal CPE aggregates of ice grains.

full: what Figs 4 to 9 show (section 3), ten seeds of every collision. desk: a selection for an evening, at twice the
time step. first: one figure (Fig. 8, R = 40), some minutes. Rows stand in the order of their worth: two seeds of every
collision first, small aggregates before large ones."""

from itertools import product

FILLINGS, EXPONENTS = (0.4, 0.3), range(8)  # i of the velocity 10^(0.1 i) m/s
REFERENCE = 5  # i at which sizes are compared (Figs 5 to 7)
TIME_UNIT = "1.936532021439599e-10"  # s: t0 of ice
STEP, PAPERS_STEP = 0.2, 0.1  # t0; at 0.2 the ledger closes to 5e-4 of K(0) or better

HEAD = """Arakawa et al. (2024), section 3 and Figs 4 to 9: head-on collisions of equal CPE aggregates of ice grains. {}
Units: radius: grain radii; velocity: m/s; duration: s; stepFraction: t0."""


def desk():
    """[(filling, radius, i, seed)] of the selection: sizes, velocities at R = 40, and slow collisions of larger
    aggregates, which show best whether tau_max falls with velocity (the elastic limit's sign)."""
    seeds = {40: 20, 50: 8, 60: 8, 80: 3}  # by radius
    sizes = [(f, r, REFERENCE, seed) for r, f in product(seeds, FILLINGS) for seed in range(1, seeds[r] + 1)]
    velocities = [(f, 40, i, seed) for seed, f, i in product(range(1, 11), FILLINGS, EXPONENTS) if i != REFERENCE]
    slow = [(f, 60, i, seed) for f, seeds in ((0.4, (1, 2, 3)), (0.3, (1, 2))) for i in (0, 2) for seed in seeds]
    return sorted(sizes + velocities + slow, key=worth)


def full():
    """The same of all of the paper's runs."""
    scenes = {*product(FILLINGS, (40, 50, 60, 70, 80), [REFERENCE]), *product(FILLINGS, (40, 80), EXPONENTS)}
    scenes = sorted(scenes, key=lambda scene: (-scene[0], scene[2]))
    return sorted(((*scene, seed) for scene in scenes for seed in range(1, 11)), key=worth)


def worth(scene):
    _, radius, _, seed = scene
    return seed > 2, radius, seed


def rows(scenes, folder, step=STEP, slow_duration=None):
    """Rows of a table, with run folders FOLDER/fFILLING-RRADIUS-iI-sSEED; slow_duration [s]: of the slowest at R = 40.

    The paper follows aggregates of 80 grain radii for 1000 ns, which is 64.6 t0 per grain radius."""
    found = []
    for filling, radius, i, seed in scenes:
        name = f"f{filling:g}-R{radius:g}-i{i}-s{seed}"
        row = {"description": name, "filling": filling, "radius": radius, "velocity": f"10**(0.1*{i})", "seed": seed}
        row["duration"] = slow_duration if slow_duration and radius == 40 and i < 3 else f"64.6*{radius}*{TIME_UNIT}"
        found.append({**row, "stepFraction": step, "threads": 1, "out": f"{folder}/{name}"})
    return found


def tables():
    """{size: (rows, head)}; in desk the slowest run twice as long, when more of them have stuck or parted."""
    first = [(0.4, 40, i, seed) for seed in (1, 2) for i in (1, 3, 5, 7)]
    return {
        "first": (rows(first, "runs/elastoplastic-first"), HEAD.format("One figure: Fig. 8 at R = 40.")),
        "desk": (rows(desk(), "runs/elastoplastic", slow_duration="1e-6"), HEAD.format("A selection.")),
        "full": (rows(full(), "runs/elastoplastic-full", PAPERS_STEP), HEAD.format("All of the paper's.")),
    }
