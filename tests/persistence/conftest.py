"""One YADE from which the runs of a module are forked."""

import pytest
from faults import Forks, fast_folder


@pytest.fixture(scope="session")
def forks():
    with fast_folder() as folder:
        found = Forks(folder)
        yield found
        found.close()
