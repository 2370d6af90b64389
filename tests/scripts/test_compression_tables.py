"""The tables of the study of K13: what is in the repository is what the script writes, and every row can be run."""

import os

import pytest
from running import TOP

from yade_scripts.experiments.compression import KIND, complete
from yade_scripts.materials import pair_constants
from yade_scripts.runner import rows
from yade_scripts.studies import compression

STUDIES = os.path.join(TOP, "yade_scripts", "studies")


@pytest.fixture
def at_top(monkeypatch):
    monkeypatch.chdir(TOP)


@pytest.mark.parametrize("which", ["desk", "full"])
def test_the_table_is_what_the_script_writes(tmp_path, which):
    compression.write_tables(tmp_path)
    name = f"compression-{which}.table"
    with open(os.path.join(STUDIES, name)) as kept:
        assert (tmp_path / name).read_text() == kept.read()


@pytest.mark.parametrize("which, number, hours", [("desk", 65, 12), ("full", 140, 300)])
def test_every_row_can_be_run(at_top, which, number, hours):
    """With stable steps; in the core hours that the Makefile tells, at 40 million contact updates a second."""
    found = rows.read(os.path.join(STUDIES, f"compression-{which}.table"))
    assert len(found) == number and not any(row.error for row in found)
    assert all(row.kind.name == KIND.name for row in found)
    for row in found:
        constants = pair_constants(row.parameters)
        drag = row.parameters.linearDamping * 2 * constants["reducedMass"] / constants["timeUnit"]
        complete(row.parameters, {**constants, "linearDrag": drag}, 1)
    seconds = sum(row.estimate.contacts * row.estimate.steps for row in found) / 4e7
    assert 0.5 * hours < seconds / 3600 < hours
