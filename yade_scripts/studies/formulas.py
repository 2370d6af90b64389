"""Tables of the page of formulas: strength and structure of compressed BCCA clusters, as codes of disks use them.

desk: clusters are compressed in periodic cells and then stretched along x until they break (tensile strength as in
Tatsuuma et al. 2019, compressive strength as in Kataoka et al. 2013; states serve the conduction of heat). Eight
clusters a point: fillings, surface energy, grain radius, critical rolling displacement and material, half the rate, and
four times as many grains at OF_LARGE. Rows stand in the order of their worth."""

from itertools import product

from analysis.studies.formulas import FILLINGS, OF_LARGE

SEEDS = range(1, 5), range(5, 9)  # four clusters of each set first
BASE = {"grains": 1024, "strainRate": "1e-6"}
MIDDLE = {**BASE, "finalFilling": "0.2"}
STEP = 0.25  # t0

# parameters of each set of eight clusters
CELLS = [
    *({**BASE, "finalFilling": filling} for filling in FILLINGS),
    {**MIDDLE, "surfaceEnergy": "0.02"},
    *({**MIDDLE, "grainRadius": radius} for radius in ("5e-8", "1e-6")),
    *({**MIDDLE, "criticalRolling": rolling} for rolling in ("2e-10", "32e-10")),
    {**MIDDLE, "grainRadius": "1e-6", "criticalRolling": "80e-10"},
    {**MIDDLE, "strainRate": "5e-7"},
    {**MIDDLE, "material": "silicate"},
    *({**MIDDLE, "finalFilling": filling, "grains": 4096} for filling in OF_LARGE),
]
SHORT = {"grains": "N", "strainRate": "Cv", "finalFilling": "to", "surfaceEnergy": "gamma", "grainRadius": "r"}
SHORT |= {"criticalRolling": "xi"}
HEAD = """BCCA clusters that are compressed in periodic cells, then stretched along x: strength and structure.
Units: strainRate: 1/t0; surfaceEnergy: J/m^2; grainRadius, criticalRolling: m; stepFraction: t0."""


def tables():
    """{size: (rows, head)}."""
    found = []
    for seeds, parameters in product(SEEDS, CELLS):
        row = {"!SCRIPT": "yade_scripts/compress.py", "material": "ice", "stepFraction": STEP, "stretch": "x"}
        row |= parameters
        varied = [f"{short}{parameters[name]}" for name, short in SHORT.items() if name in parameters]
        for seed in seeds:
            name = "-".join([row["material"], *varied, f"s{seed}"])
            found.append({"description": name, **row, "seed": seed, "threads": 1, "out": f"runs/formulas/{name}"})
    return {"desk": (found, HEAD)}
