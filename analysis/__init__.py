"""Analysis of collisions of cohesive dust aggregates: run folders in, numbers and figures out. Needs no YADE.

A24 = Arakawa et al. 2024 (elastoplastic collisions), A22 = Arakawa et al. 2022 (viscous dissipation), K13 =
Kataoka et al. 2013 (static compression). Everything is in SI units."""

from .channels import CHANNELS, DISSIPATED, STORED
from .run_folder import RunFolder, RunFolderError, State, open_run
from .summary import summarise

__all__ = [
    "CHANNELS",
    "DISSIPATED",
    "STORED",
    "RunFolder",
    "RunFolderError",
    "State",
    "open_run",
    "summarise",
]
