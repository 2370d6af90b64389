"""One YADE from which the runs of a module are forked."""

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path

import pytest
from faults import Forks


@pytest.fixture(scope="session")
def forks():
    with fast_folder() as folder:
        found = Forks(folder)
        yield found
        found.close()


@contextmanager
def fast_folder():
    """A temporary folder in memory where there is such a place: fsync is free there."""
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=memory, ignore_cleanup_errors=True) as folder:
        yield Path(folder)
