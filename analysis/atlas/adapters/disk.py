"""A disk in DustPy with and without the atlas, and its figure.

    python3 -m analysis.atlas.adapters.disk analysis/gallery/atlas     # or make disk

runs DustPy with the folder's outcomes.txt and writes disk.npz there, or takes the disk.npz that is there, without
DustPy, and draws disk.png. A disk.npz of another outcomes.txt is refused.

DustPy's defaults, but for: 30 radial cells from 5 to 300 au (100 from 1 to 1000); ice grains (rhoMonomer 1 g/cm^3,
not 1.67) with a filling factor of FILLING (1), as compact ones are no aggregates; masses from 1e-14 g (1e-12), two
grains of 0.1 um. With the atlas aggregates of the inner disk grow to the largest mass of DustPy's grid, 1e5 g.
"""

import hashlib
import json
import sys
from pathlib import Path

import numpy as np

from ...figures.style import new_figure, save_small, styled
from ...progress import progress
from ...runs.files import replacing
from .dustpy import use_atlas

YEARS, FILLING = 1e5, 0.3
TITLES = {"dustpy": "DustPy: breaks above 1 m/s", "clamp": "the atlas, beyond its data the nearest of it"}


def run(outcomes, with_atlas):
    """The disk after YEARS as a dict: sigma [g/cm^2 per ln a], outside, size [cm] (Nr, Nm), radius (Nr,) [au], report
    (JSON). With DustPy alone `outside` and `report` are those of the atlas in the same disk."""
    from dustpy import Simulation, constants, std

    sim = Simulation(verbosity=0)
    sim.ini.grid.Nr, sim.ini.grid.rmin, sim.ini.grid.rmax = 30, 5 * constants.au, 300 * constants.au
    sim.ini.grid.mmin, sim.ini.dust.rhoMonomer = 1e-14, 1.0
    sim.initialize()
    sim.writer = None
    sim.dust.fill[...] = FILLING
    sim.update()
    sim.dust.Sigma[...] = std.dust.MRN_distribution(sim)  # its largest size follows from the filling
    sim.update()
    sim.t.snapshots = np.array([YEARS]) * constants.year
    atlas = use_atlas(sim, outcomes) if with_atlas else None
    sim.run()
    mass = float((sim.dust.Sigma * sim.grid.A[:, None]).sum() / constants.M_earth)
    atlas = atlas or use_atlas(sim, outcomes)
    arrays = {
        "sigma": sim.dust.Sigma / (np.log(sim.grid.m[1] / sim.grid.m[0]) / 3.0),
        "outside": atlas.outside_of_bins(sim),
        "size": sim.dust.a,
        "radius": sim.grid.r / constants.au,
    }
    report = json.dumps({"dust in Earth masses": mass, **atlas.report(sim)})
    return {"report": report, **{name: np.asarray(values, dtype=np.float32) for name, values in arrays.items()}}


@styled
def figure(runs):
    """Figure of {name: run()}: surface density over distance and size, hatched where most are outside of the data."""
    drawing = new_figure(4.6 * len(runs), 5.0, layout="constrained")
    panels = drawing.subplots(1, len(runs), sharey=True, squeeze=False)[0]
    top = max(np.max(run["sigma"]) for run in runs.values())
    levels = np.arange(-6, np.ceil(np.log10(top)) + 0.5, 0.5)
    for panel, (name, run) in zip(panels, runs.items()):
        radius, size = np.broadcast_to(run["radius"][:, None], run["size"].shape), run["size"]
        with np.errstate(divide="ignore"):
            filled = panel.contourf(radius, size, np.log10(run["sigma"]), levels=levels, cmap="viridis", extend="min")
        if name != "dustpy":
            mostly = np.where(run["outside"] > 0.5, 1.0, 0.0)
            panel.contourf(radius, size, mostly, levels=[0.5, 1.5], colors="none", hatches=["///"])
        panel.set(xscale="log", yscale="log", xlabel="distance from the star [au]", title=TITLES[name])
        panel.set_ylim(size.min(), 1e2)
    panels[0].set_ylabel("radius of the aggregates [cm]")
    drawing.colorbar(filled, ax=panels, label="log surface density [g/cm$^2$ per ln a]", shrink=0.9)
    return drawing


def main(folder):
    """Exit status; see the module."""
    folder = Path(folder)
    outcomes, kept = folder / "outcomes.txt", folder / "disk.npz"
    table = hashlib.sha256(outcomes.read_bytes()).hexdigest()
    if not kept.exists():
        runs = {name: run(outcomes, name == "clamp") for name in progress(TITLES, "disk")}
        arrays = {f"{name} {key}": value for name, values in runs.items() for key, value in values.items()}
        with replacing(kept) as file:
            np.savez_compressed(file, table=table, **arrays)
    with np.load(kept) as file:
        arrays = dict(file)
    if str(arrays.pop("table")) != table:
        print(f"{kept}: of another table than {outcomes}; must be removed to be made again", file=sys.stderr)
        return 2
    parts = ("sigma", "outside", "size", "radius", "report")
    runs = {name: {part: arrays[f"{name} {part}"] for part in parts} for name in TITLES}
    for name, own in runs.items():
        print(name, own["report"])
    save_small(figure(runs), folder / "disk.png")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
