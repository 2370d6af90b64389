"""Analysis of runs of cohesive dust aggregates: run folders in, tables, numbers and figures out. Needs no YADE.

    import analysis
    run = analysis.open_run("runs/demo")        # run.parameters["velocity"], run.history["d"], run.last.position
    run.last.fragments()                        # DataFrame, a row a piece
    runs = analysis.table("runs/**")            # DataFrame, a row a run
    analysis.plot("sticking", runs, x="velocity").savefig("sticking.png")

dir(analysis) lists what there is; each docstring says shapes and units. Functions of measures take plain arrays:
analysis.fragment_labels(grains, contact_pairs) and so on; what cannot be is refused in one line, WrongArgument (a ValueError).
`analysis.__version__` and `analysis.commit` say which sources these are.

A24 = Arakawa et al. 2024 (elastoplastic collisions), A22 = Arakawa et al. 2022 (viscous dissipation), K13 =
Kataoka et al. 2013 (static compression), S17 = Sirono & Ueno 2017 (sintered aggregates). Everything is in SI units."""

from importlib import import_module

# Loaded when they are first asked for: the scripts that yade runs import analysis.runs.format only.
_PUBLIC = {
    ".runs.folder": ("RunFolder", "State", "open_run"),
    ".arguments": ("WrongArgument",),
    ".runs.arrays": ("RunFolderError",),
    ".report.rows": ("table",),
    ".report.plot": ("plot",),
    ".report.summary": ("summarise",),
    ".atlas.grid": ("outcome",),
    ".measures.probability": ("exact_interval",),
    ".measures.pieces": ("fragments",),
    ".measures.fragments": (
        *("fragment_labels", "fragment_sizes", "fragment_masses", "growth_efficiency"),
        *("cumulative_number", "cumulative_grains", "cumulative_cross_section"),
    ),
    ".measures.structure": ("correlation_dimension", "filling_factor", "grains_within", "gyration_radius"),
    ".measures.coordination": ("inner_coordination", "mean_coordination"),
    ".measures.compression": ("compression_length", "maximum_compression", "mutual_velocity"),
    ".measures.ledger": ("closure", "fractions_at", "total_energy"),
}
_PLACES = {name: place for place, names in _PUBLIC.items() for name in names}
__all__ = sorted(_PLACES)


def __getattr__(name):
    if name in ("__version__", "commit"):
        from . import version

        return version.version() if name == "__version__" else version.commit()
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_PLACES[name], __name__), name)


def __dir__():
    return [*__all__, "__version__", "commit"]
