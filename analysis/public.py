"""The names that `import analysis` offers."""
# ruff: noqa: F401, I001

from .atlas.own import outcome_table
from .atlas.query import outcome
from .measures.compression import compression_and_velocity, maximum_compression
from .measures.fragments import cumulative_cross_section, cumulative_grains, fragment_labels, fragment_masses
from .measures.fragments import fragment_sizes, growth_efficiency
from .runs.ledger import closure, fractions_at, total_energy
from .measures.conduction import conductivity
from .measures.structure import correlation_dimension, filling_factor, geodesic_radius, grains_within
from .measures.structure import gyration_radius, inner_coordination, mean_coordination
from .report.rows import summarise, table
from .runs.files import RunFolderError
from .runs.folder import RunFolder, State, open_run
from .runs.pieces import fragments
from .studies.plot import plot

__all__ = [name for name in dir() if not name.startswith("_")]
