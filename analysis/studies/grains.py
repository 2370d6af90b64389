"""Names that moved to columns.py."""

from .columns import GRAINS, OF_GRAINS, PAPERS, grains_text, other_grains, require_papers_grains  # noqa: F401
