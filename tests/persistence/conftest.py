"""One YADE from which the runs of a module are forked."""

import os
import tempfile
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import pytest
from faults.forks import Forks
from faults.trial import Trial


@pytest.fixture(scope="session")
def forks():
    with fast_folder() as folder:
        found = Forks(folder)
        yield found
        found.close()


@pytest.fixture(scope="session")
def trial_of(forks):
    """trial_of(command) -> its Trial, made once."""
    with fast_folder() as folder:
        yield cache(lambda command: Trial(forks, command, tempfile.mkdtemp(dir=folder)))


@contextmanager
def fast_folder():
    """A temporary folder in memory where there is such a place: fsync is free there."""
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=memory, ignore_cleanup_errors=True) as folder:
        yield Path(folder)
