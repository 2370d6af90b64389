"""Reading run folders: whole, unfinished, damaged and foreign ones; the ledger of their energies."""

import io
import json
import zipfile

import numpy as np
import pytest
from refused import refused
from written_runs import change_arrays, flip, unseal

from analysis import summarise
from analysis.runs.files import RunFolderError
from analysis.runs.folder import open_run
from analysis.runs.format import CHANNELS, COLLISION
from analysis.runs.ledger import closure, closure_history, fractions, fractions_at, total_energy


@pytest.fixture
def folder(run):
    """One without sums: what its files alone show of damage."""
    return unseal(run)


def _change_record(folder, change):
    record = json.loads((folder / "run.json").read_text())
    change(record)
    (folder / "run.json").write_text(json.dumps(record))


def test_a_whole_run_with_arrays_that_cannot_be_changed(folder):
    run = open_run(folder)
    assert run.ended and len(run.states) == 3 and run.derived["grainRadius"] == 1e-7
    assert run.start.time == 0.0 and run.last.time == run.history["time"][-1]
    assert run.states.times == pytest.approx([state.time for state in run.states])
    assert run.states.nearest(run.last.time * 0.99) == 2
    assert run.last.position.shape == (2, 3) and len(run.start.contact_pairs) == 1 and len(run.last.contact_pairs) == 0
    for array in (run.history["d"], run.start.position):
        with pytest.raises(ValueError):
            array[0] = 1.0


def test_what_a_folder_may_lack_and_hold_besides(folder):
    (folder / "ended").unlink()
    for name in ("000003.npz.tmp", "notes.txt"):
        (folder / "states" / name).write_text("mine")
    change_arrays(folder / "history.npz", d=np.r_[open_run(folder).history["d"][:-1], np.nan])
    change_arrays(folder / "states" / "000000.npz", cell_size=np.array([1e-6, 2e-6, 3e-6]))
    text = (folder / "run.json").read_text()
    (folder / "run.json").write_text(text, encoding="utf-8-sig")
    run = open_run(folder)
    assert not run.ended and len(run.states) == 3 and np.isnan(run.history["d"][-1]) and run.record == json.loads(text)
    assert list(run.start.cell_size) == [1e-6, 2e-6, 3e-6] and run.last.cell_size is None


def test_a_folder_of_format_1_is_read_and_lacks_nothing_else(folder):
    """It has no kind and no work from outside."""
    new = open_run(folder)
    _change_record(folder, lambda r: (r.update(format=1), r.pop("kind")))
    change_arrays(folder / "history.npz", boundaryWork=None, constraintWork=None, externalWork=None)
    old = open_run(folder)
    assert old.kind is new.kind is COLLISION and old.record["format"] == 1
    assert set(old.history) == set(new.history) == {q.name for q in COLLISION.history if not q.optional}
    assert all(np.array_equal(old.history[name], new.history[name]) for name in old.history)
    assert not old.history["boundaryWork"].any() and old.start.cell_size is None
    assert summarise(old) == summarise(new)
    change_arrays(folder / "history.npz", connection=None)
    with pytest.raises(RunFolderError, match="lacks the array 'connection'"):
        open_run(folder)


DAMAGE = {
    "run.json: missing": lambda f: (f / "run.json").unlink(),
    "run.json: not the record of a run": lambda f: (f / "run.json").write_text("{}"),
    "format is 99": lambda f: _change_record(f, lambda record: record.update(format=99)),
    "history.npz: damaged": lambda f: flip(f / "history.npz", 1 / 3, 0xFF),
    "'drag' has the shape (3,)": lambda f: change_arrays(f / "history.npz", drag=np.zeros(3)),
}


@pytest.mark.parametrize("words", DAMAGE)
def test_damaged_folders_say_what_and_where(folder, words):
    DAMAGE[words](folder)
    with refused(RunFolderError, words, str(folder)):
        open_run(folder)


def header_alone(file):
    """Leave the header of an array without its bytes, of a size beyond all numbers."""
    change_arrays(file, radius=None)
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (10**300,)})
    with zipfile.ZipFile(file, "a") as archive:
        archive.writestr("radius.npy", header.getvalue())


STATE_DAMAGE = {
    "'radius' has 0 bytes, by its header 8e+300": header_alone,
    "'contact_pairs' must be of grains 0 to 1": dict(contact_pairs=np.array([[0, 2]])),
    "'position' holds a value that is not finite": dict(position=np.full((2, 3), np.nan)),
}


@pytest.mark.parametrize("words", STATE_DAMAGE)
def test_damaged_states_say_what_and_where(folder, words):
    file, spoil = folder / "states" / "000000.npz", STATE_DAMAGE[words]
    change_arrays(file, **spoil) if isinstance(spoil, dict) else spoil(file)
    run = open_run(folder)
    with refused(RunFolderError, words, "000000.npz"):
        run.start
    assert run.last.radius.size == 2


def test_the_ledger_sums_every_channel_and_closure_is_undefined_without_motion_at_the_start():
    usual = {name: np.zeros(4) for name in CHANNELS} | {"kinetic": np.array([2.0, 1.0, 0.5, 0.0])}
    usual |= {"normal": np.array([-10.0, -10.0, -11.0, -12.0]), "connection": np.array([0.0, 1.0, 2.5, 4.0])}
    assert list(total_energy(usual)) == [-8.0] * 4 and closure(usual) == 0.0
    for channel in CHANNELS:
        leaky = {**usual, channel: usual[channel] + [0.0, 0.2, -0.3, 0.1]}
        assert closure_history(leaky) == pytest.approx([0.0, 0.1, -0.15, 0.05]), channel
        assert closure(leaky) == pytest.approx(0.15)
    parts, between = fractions(usual), fractions_at({**usual, "time": np.arange(4.0)}, 2.5)
    assert sum(parts.values()) == pytest.approx(np.ones(4)) and sum(between.values()) == pytest.approx(1.0)
    assert parts["normal"] == pytest.approx([0.0, 0.0, -0.5, -1.0]) and between["normal"] == pytest.approx(-0.75)
    at_rest = {**usual, "kinetic": np.zeros(4)}
    assert closure(at_rest) is None and fractions(at_rest) is None
