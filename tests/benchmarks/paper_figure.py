"""The figure of make bench-papers: contact updates a second at each moment of the papers' runs."""

import matplotlib
import numpy as np
from paper_moments import moments_of, title_of

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ENGINE, LAMMPS = "#c1272d", "#f2a134"
NAME = "bench-papers.png"


def draw(found, folder):
    """bench-papers.png: a line for each moment, with all turns of one and of two threads, and LAMMPS."""
    moments = moments_of(found)
    about = f"{found['machine']['cpu']}, {found['machine']['cores']} cores"
    with plt.rc_context({"axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}):
        figure, axis = plt.subplots(figsize=(9, 1.2 + 0.32 * len(moments)), constrained_layout=True)
        for threads, face in ((1, "white"), (2, ENGINE)):
            points = [(m.contacts / ms / 1e3, k) for k, m in enumerate(moments) for ms in m.turns(threads)]
            dots(axis, points, ENGINE, face, f"engine, {threads} thread{'s' * (threads - 1)}")
        for cores, face in ((1, "white"), (2, LAMMPS)):
            runs = [(k, m.found["lammps"].get(str(cores))) for k, m in enumerate(moments)]
            points = [(run["contacts"] / run["msPerStep"] / 1e3, k) for k, run in runs if run]
            dots(axis, points, LAMMPS, face, f"LAMMPS, {cores} core{'s' * (cores - 1)}")
        axis.set(xlabel="million contact updates a second", xlim=(0, None), yticks=range(len(moments)))
        axis.set_yticklabels([f"{title_of(m.scene)}; {m.name}" for m in moments], fontsize=8)
        axis.invert_yaxis()
        axis.grid(alpha=0.25)
        axis.legend(fontsize=8)
        figure.suptitle(about, fontsize=9, color="0.35")
        figure.savefig(folder / NAME, dpi=110)
        plt.close(figure)


def dots(axis, points, colour, face, label):
    if points:
        x, y = np.array(points).T
        axis.plot(x, y, "o", color=colour, markerfacecolor=face, markersize=5, label=label)
