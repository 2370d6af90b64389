"""Tables of the study of Kataoka et al. (2013, K13): static compression of BCCA clusters in periodic cells.

full: what Figs 4 to 13 show, ten clusters of every set of parameters. desk: a selection for an evening on two cores:
the fiducial parameters with three clusters, fewer grains with more, and every parameter varied at 1024 grains. own:
more clusters of the paper's size, of 1,024 and of 4,096 grains, up to the filling factor where the paper's law ends.
Rows stand in the order of their worth: one cluster of every set first."""

# t0; K13 takes 0.1. The pressure, by the work of the boundaries, is that at a step of 0.05 to 1 % below a filling of
# 0.1 and to 2 % above, with damping and without, less than seeds differ (docs/measurements.md).
STEP = 0.3
FIDUCIAL = {"grains": 16384, "strainRate": "3e-7"}
BASE = {"grains": 1024, "strainRate": "1e-6"}  # of what varies in desk
ROLLING = [{"criticalRolling": rolling} for rolling in ("2e-10", "4e-10", "16e-10", "32e-10")]  # m; ice: 8e-10
DAMPING = [{"linearDamping": "0"}, {"linearDamping": "0.1"}]
SILICATE = {"material": "silicate"}
# To where K13's law ends and the bin around 0.1: above it the paper claims nothing.
TO_LAW = {"strainRate": "3e-7", "finalFilling": "0.12"}

# [(parameters, seeds)]
DESK = [
    *(({**BASE, "strainRate": rate}, range(1, 5)) for rate in ("1e-6", "1e-5", "3e-6", "3e-7")),
    ({**BASE, "strainRate": "1e-7"}, (1, 2)),
    *(({**BASE, **varied}, range(1, 5)) for varied in DAMPING + ROLLING),
    ({**BASE, "stepFraction": 0.1}, (1, 2)),
    ({**BASE, "finalFilling": "0.64"}, (1, 2)),
    ({**FIDUCIAL, "grains": 4096}, range(1, 5)),
    ({**FIDUCIAL, "grains": 4096, **SILICATE}, (1, 2, 3)),
    (FIDUCIAL, (1, 2, 3)),
]
RATES = [{"strainRate": rate} for rate in ("1e-5", "3e-6", "1e-6", "3e-7", "1e-7")]
FEWER = [{"grains": 1024}, {"grains": 4096}]
FULL = [({**FIDUCIAL, **varied}, range(1, 11)) for varied in RATES + FEWER + DAMPING + ROLLING + [SILICATE]]
OWN = [  # beside the desk's
    ({**TO_LAW, "grains": 16384}, range(2, 11)),
    *(({**TO_LAW, "grains": 1024, "strainRate": rate}, range(5, 9)) for rate in ("3e-7", "1e-5")),
    ({**TO_LAW, "grains": 4096}, range(2, 5)),
    *(({**BASE, "finalFilling": "0.12", **rolling}, range(5, 9)) for rolling in ({}, {"criticalRolling": "4e-10"})),
]

SHORT = {"grains": "N", "strainRate": "Cv", "linearDamping": "k", "criticalRolling": "xi"}
SHORT |= {"stepFraction": "step", "finalFilling": "to"}
HEAD = """Kataoka et al. (2013), Figs 4 to 13: static compression of BCCA clusters in periodic cells. {}
Units: strainRate: 1/t0; criticalRolling: m; stepFraction: t0."""


def rows(sets, folder):
    """Rows of [(parameters, seeds)], with names and run folders such as ice-N1024-Cv1e-6-k0-s1."""
    found = []
    for parameters, seeds in sets:
        row = {"!SCRIPT": "yade_scripts/compress.py", "material": "ice", "atRest": 0, "stepFraction": STEP}
        row |= parameters
        varied = [f"{short}{parameters[name]}" for name, short in SHORT.items() if name in parameters]
        for seed in seeds:
            name = "-".join([row["material"], *varied, f"s{seed}"])
            found.append({"description": name, **row, "seed": seed, "threads": 1, "out": f"{folder}/{name}"})
    return sorted(found, key=lambda row: row["seed"] > 1)


def tables():
    """{size: (rows, head)}."""
    more = "More clusters, the paper's size among them, up to where its law ends."
    return {
        "desk": (rows(DESK, "runs/compression"), HEAD.format("A selection.")),
        "full": (rows(FULL, "runs/compression-full"), HEAD.format("All of the paper's.")),
        "own": (rows(OWN, "runs/compression-own"), HEAD.format(more)),
    }
