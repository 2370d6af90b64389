"""One YADE from which the runs of a module are forked."""

import os
import shutil
import tempfile
from pathlib import Path

import pytest
from faults.forks import Forks
from faults.scenarios import Bench


@pytest.fixture(scope="session")
def forks():
    with fast_folder() as folder:
        found = Forks(folder)
        yield found
        found.close()


@pytest.fixture(scope="session")
def bench(forks):
    with fast_folder() as folder:
        yield Bench(forks, folder)


class fast_folder:
    """A temporary folder in memory where there is such a place: fsync is free there."""

    def __enter__(self):
        memory = "/dev/shm"
        self.path = tempfile.mkdtemp(dir=memory if os.access(memory, os.W_OK) else None)
        return Path(self.path)

    def __exit__(self, *_):
        shutil.rmtree(self.path, ignore_errors=True)
