"""Snapshots of collisions, from run folders or from the few states that a gallery keeps of them."""

from dataclasses import dataclass, replace
from typing import Callable

import numpy as np

from ..figures.collision import draw_view, reach
from ..figures.style import panels, styled
from ..runs.files import read_arrays
from ..runs.table import NoRunFolder, run_folder

HELD = 0.99  # of the grains: what flies farther than all but the last hundredth leaves a panel
FULL = 32_000  # of an int16


@dataclass(frozen=True)
class Snapshot:
    """A state: time [s], position (N,3) [m], radius (N,) [m], aggregate (N,) int."""

    time: float
    position: np.ndarray
    radius: np.ndarray
    aggregate: np.ndarray


@dataclass(frozen=True)
class SnapshotFigure:
    """name, caption (as definition.StudyFigure); collisions: definition.Results -> [(row of the table (itertuples), title, times (T,) [s])],
    one row of panels each, a panel a time: the saved state that is nearest. Every panel has its own scale, with a bar, and holds that part
    of the grains (held)."""

    name: str
    caption: str
    collisions: Callable
    vector = False
    held: float = HELD

    @styled
    def draw(self, results):
        """The Figure of definition.Results; None without such runs; NoRunFolder where neither run folder nor kept states are at hand."""
        found = self.collisions(results)
        rows = [(title, states_of(results, row, times), row.grain_radius) for row, title, times in found]
        if not rows:
            return None
        figure, axes = panels(len(rows), max(len(states) for _, states, _ in rows), 2.7, 2.75)
        for places, (title, states, unit) in zip(axes, rows):
            for place, state in zip(places, states):
                centre = state.position.mean(axis=0)
                half = 1.05 * reach(replace(state, position=state.position - centre), self.held) / unit
                draw_view(place, state, unit, half, centre=centre)
                _scale_bar(place, half)
            for place in places[len(states) :]:
                place.set_axis_off()
            places[0].set_title(title, fontsize=9, loc="left")
        return figure


def states_of(results, row, times):
    """[Snapshot] of a run (a row of the table) nearest to times (T,) [s], each once: of its folder, or of those kept in the gallery. What
    comes from a folder is remembered in results.snapshots, to be kept."""
    if isinstance(row.folder, str):
        run = run_folder(row)
        states = [run.states[k] for k in sorted({run.states.nearest(time) for time in times})]
        found = [Snapshot(float(own.time), own.position, own.radius, own.aggregate) for own in states]
        results.snapshots[row.run] = found
        return found
    file = results.kept / f"{row.run}.npz" if results.kept else None
    if file is None or not file.is_file():
        raise NoRunFolder(row.run)
    return read_snapshots(file)


def write_snapshots(file, snapshots):
    """Write [Snapshot] of one run into an .npz (path or file): positions to 1/32,000 of the largest."""
    positions = np.array([own.position for own in snapshots])
    unit = np.abs(positions).max() / FULL
    np.savez_compressed(
        file,
        time=[own.time for own in snapshots],
        unit=unit,
        position=np.rint(positions / unit).astype(np.int16),
        radius=snapshots[0].radius.astype(np.float32),
        aggregate=snapshots[0].aggregate.astype(np.uint8),
    )


def read_snapshots(file):
    """[Snapshot] that write_snapshots wrote; RunFolderError where the file is damaged."""
    kept = read_arrays(file, ("time", "unit", "position", "radius", "aggregate"))
    radius, aggregate = kept["radius"].astype(float), kept["aggregate"].astype(int)
    positions = kept["position"] * float(kept["unit"])
    return [Snapshot(float(time), place, radius, aggregate) for time, place in zip(kept["time"], positions)]


def _scale_bar(axes, half):
    """A bar of 1, 2 or 5 times a power of ten grain radii, at the lower left of a panel of that half width."""
    power = 10.0 ** np.floor(np.log10(0.6 * half))
    length = max(step * power for step in (1, 2, 5) if step * power <= 0.6 * half)
    axes.plot([-0.92 * half, -0.92 * half + length], [-0.92 * half] * 2, color="0.1", lw=2.5)
    axes.text(-0.92 * half, -0.88 * half, f"{length:g} $r$", fontsize=8, va="bottom")
