"""Tables of the study of Kataoka et al. (2013, K13): static compression of BCCA clusters in periodic cells.

full: what Figs 4 to 13 show, ten clusters of every set of parameters. desk: a selection for an evening on two cores:
the fiducial parameters with three clusters, fewer grains with more, every parameter varied at 1024 grains, and cells
that are stretched again, which K13 leaves to later work. own: more clusters of the paper's size, of 1,024 and of 4,096
grains, up to the filling factor where the paper's law ends. Rows stand in the order of their worth: one cluster of
every set first."""

# t0; K13 takes 0.1. The pressure, by the work of the boundaries, is that at a step of 0.05 to 1 % below a filling of
# 0.1 and to 2 % above, with damping and without, less than seeds differ (docs/measurements.md).
STEP = 0.3
FIDUCIAL = {"grains": 16384, "strainRate": "3e-7"}
RATES = ("1e-7", "3e-7", "1e-6", "3e-6", "1e-5")
ROLLING = ("2e-10", "4e-10", "16e-10", "32e-10")  # m; beside ice's 8e-10
DAMPING = ({"linearDamping": "0"}, {"linearDamping": "0.1"})
SILICATE = {"material": "silicate"}

# Sets of parameters of the desk study, and how many clusters of each; 1024 grains at 1e-6 are the base of what varies.
BASE = {"grains": 1024, "strainRate": "1e-6"}
DESK = (
    [({**BASE, "strainRate": rate}, 4 if rate != "1e-7" else 2) for rate in ("1e-6", "1e-5", "3e-6", "3e-7", "1e-7")]
    + [({**BASE, **damping}, 4) for damping in DAMPING]
    + [({**BASE, "criticalRolling": rolling}, 4) for rolling in ROLLING]
    + [({**BASE, "stepFraction": 0.1}, 2)]
    + [({**BASE, "finalFilling": filling, "stretch": "x"}, 2) for filling in ("0.1", "0.2", "0.3", "0.4")]
    + [({**BASE, "finalFilling": "0.35", "stretch": "xyz"}, 1), ({**BASE, "finalFilling": "0.64"}, 2)]
    + [({"grains": 4096, "strainRate": "3e-7"}, 4), ({"grains": 4096, "strainRate": "3e-7", **SILICATE}, 3)]
    + [({**FIDUCIAL}, 3)]
)
FULL = (
    [({**FIDUCIAL, "strainRate": rate}, 10) for rate in RATES[::-1]]
    + [({**FIDUCIAL, "grains": grains}, 10) for grains in (1024, 4096)]
    + [({**FIDUCIAL, **damping}, 10) for damping in DAMPING]
    + [({**FIDUCIAL, "criticalRolling": rolling}, 10) for rolling in ROLLING]
    + [({**FIDUCIAL, **SILICATE}, 10)]
)
# Clusters beside those of the desk, to where K13's law ends and the bin around 0.1: above it the paper claims nothing.
TO_LAW = {"strainRate": "3e-7", "finalFilling": "0.12"}
OWN = (
    [({**TO_LAW, "grains": 16384}, range(2, 11))]
    + [({**TO_LAW, "grains": 1024, "strainRate": rate}, range(5, 9)) for rate in ("3e-7", "1e-5")]
    + [({**TO_LAW, "grains": 4096}, range(2, 5))]
    + [({**BASE, "finalFilling": "0.12", **rolling}, range(5, 9)) for rolling in ({}, {"criticalRolling": "4e-10"})]
)

SHORT = {"grains": "N", "strainRate": "Cv", "linearDamping": "k", "criticalRolling": "xi", "stepFraction": "step"}


def name(parameters, seed):
    """Name of a row and its run folder, such as ice-N1024-Cv1e-6-k0-s1."""
    parts = [parameters.get("material", "ice")]
    parts += [f"{SHORT[key]}{parameters[key]}" for key in SHORT if key in parameters]
    parts += [f"to{parameters['finalFilling']}"] if "finalFilling" in parameters else []
    parts += [f"stretch-{parameters['stretch']}"] if "stretch" in parameters else []
    return "-".join([*parts, f"s{seed}"])


def rows(sets, folder):
    """Rows of [(parameters, number of clusters or their seeds)]: first one cluster of every set, then the others."""
    found = []
    for parameters, seeds in sets:
        row = {"!SCRIPT": "yade_scripts/compress.py", "material": "ice", "stepFraction": STEP, **parameters}
        for seed in range(1, seeds + 1) if isinstance(seeds, int) else seeds:
            own = name(parameters, seed)
            found.append({"description": own, **row, "seed": seed, "threads": 1, "out": f"{folder}/{own}"})
    return sorted(found, key=lambda row: row["seed"] > 1)


HEAD = """Kataoka et al. (2013), Figs 4 to 13: static compression of BCCA clusters in periodic cells. {}
Units: strainRate: 1/t0; criticalRolling: m; stepFraction: t0."""


def tables():
    """{size: (rows, head)}."""
    more = "More clusters, the paper's size among them, up to where its law ends."
    return {
        "desk": (rows(DESK, "runs/compression"), HEAD.format("A selection, and cells stretched again.")),
        "full": (rows(FULL, "runs/compression-full"), HEAD.format("All of the paper's.")),
        "own": (rows(OWN, "runs/compression-own"), HEAD.format(more)),
    }
