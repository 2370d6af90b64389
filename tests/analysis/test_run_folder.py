"""Reading run folders: whole, unfinished, damaged and foreign ones."""

import io
import json
import shutil
import zipfile

import numpy as np
import pytest
from refused import refused
from written_runs import change_arrays, flip, state_arrays, unseal

from analysis import summarise
from analysis.figures.draw import figures_of
from analysis.report.text import long_text
from analysis.runs.files import RunFolderError
from analysis.runs.folder import open_run
from analysis.runs.format import CHANNELS, COLLISION


@pytest.fixture
def folder(run):
    """One without sums: what its files themselves tell of damage."""
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
    for things, key in ((run.history["d"], 0), (run.start.position, 0)):
        with pytest.raises((ValueError, TypeError)):
            things[key] = 1.0


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
    assert all(hasattr(run.start, quantity.name) for quantity in COLLISION.states)
    assert [q.name for q in COLLISION.history][1 : len(CHANNELS) + 1] == list(CHANNELS)


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


def test_a_kind_of_run_of_a_script_of_its_own(folder):
    """What every run has is read and checked; its own series are read as they are."""
    _change_record(folder, lambda r: r.update(kind="shrink"))
    filling = np.linspace(0.1, 0.2, 201)
    change_arrays(folder / "history.npz", d=None, v=None, contacts_between=None, filling=filling)
    for file in (folder / "states").iterdir():
        change_arrays(file, aggregate=np.array([0, 5]))
    run = open_run(folder)
    assert run.kind.name == "shrink" and np.array_equal(run.history["filling"], filling) and "d" not in run.history
    assert list(run.start.aggregate) == [0, 5] and list(figures_of(run)) == ["energy"]
    numbers = summarise(run)
    assert numbers["energy_closure"] < 1e-9 and numbers["outcome"] is None and numbers["d_max"] is None
    text = long_text(run, numbers)
    assert "a run of the kind shrink" in text and "energy closure" in text and "d_max" not in text
    change_arrays(folder / "history.npz", filling=np.zeros(7))
    with pytest.raises(RunFolderError, match="'filling' has the shape"):
        open_run(folder)


def test_different_grains_in_states_make_no_outcome_and_no_states_no_end(folder):
    change_arrays(folder / "states" / "000000.npz", aggregate=np.array([1, 0]))
    with pytest.raises(RunFolderError, match="don't hold the same grains"):
        summarise(open_run(folder))
    shutil.rmtree(folder / "states")
    with pytest.raises(RunFolderError, match="holds no state"):
        open_run(folder).last


def values(part=None, **changed):
    """What changes values of the record, or of a part of it."""
    return lambda folder: _change_record(folder, lambda record: (record[part] if part else record).update(changed))


def history(**changed):
    """What changes arrays of a folder's history."""
    return lambda folder: change_arrays(folder / "history.npz", **changed)


def state(**changed):
    """What changes arrays of a state's file."""
    return lambda file: change_arrays(file, **changed)


def _halve(file):
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


DAMAGE = {
    "no folder": (lambda f: shutil.rmtree(f), "no such run folder"),
    "a file": (lambda f: (shutil.rmtree(f), f.write_text("")), "is not a folder"),
    "no record": (lambda f: (f / "run.json").unlink(), "run.json: missing"),
    "half a record": (lambda f: _halve(f / "run.json"), "run.json: not valid JSON"),
    "foreign record": (lambda f: (f / "run.json").write_text("{}"), "run.json: not the record of a run: no 'format'"),
    "nested record": (lambda f: (f / "run.json").write_text("[" * 100_000), "not valid JSON: nested too deeply"),
    "no number": (values("parameters", velocity=float("nan")), "run.json: not valid JSON: NaN is no number of JSON"),
    "later format": (values(format=6), "format is 6, this analysis reads formats 1, 2, 3, 4 and 5"),
    "no derived": (lambda f: _change_record(f, lambda r: r.pop("derived")), "'derived' is missing"),
    "zero radius": (values("derived", grainRadius=0), "'grainRadius' must be a positive number, it is 0"),
    "no history": (lambda f: (f / "history.npz").unlink(), "history.npz: missing: the run has recorded no history"),
    "half a history": (lambda f: _halve(f / "history.npz"), "history.npz: damaged"),
    "a flipped byte": (lambda f: flip(f / "history.npz", 1 / 3, 0xFF), "history.npz: damaged"),
    "no drag": (history(drag=None), "history.npz: lacks the array 'drag'"),
    "short drag": (history(drag=np.zeros(3)), "'drag' has the shape (3,), expected"),
    "text in drag": (history(drag=np.array(["a"] * 201)), "'drag' must hold numbers"),
    "objects": (history(drag=np.array([None] * 201)), "history.npz: damaged"),
    "fractional contacts": (history(contacts=np.full(201, 0.5)), "'contacts' must be integers"),
    "time runs back": (history(time=-np.arange(201.0)), "'time' does not increase"),
    "no times": (history(time=np.zeros(0)), "expected (0,)"),
}  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGE)
def test_damaged_folders_say_what_and_where(folder, damage):
    spoil, message = DAMAGE[damage]
    spoil(folder)
    with refused(RunFolderError, message, str(folder)):
        open_run(folder)


def header_alone(name, shape):
    """What leaves an array's header without its bytes."""

    def spoil(file):
        with np.load(file) as archive:
            others = {key: archive[key] for key in archive.files if key != name}
        np.savez(file, **others)
        header = io.BytesIO()
        np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": shape})
        with zipfile.ZipFile(file, "a") as archive:
            archive.writestr(f"{name}.npy", header.getvalue())

    return spoil


STATE_DAMAGE = {
    "a size beyond all numbers": (header_alone("radius", (10**300,)), "'radius' has 0 bytes, by its header 8e+300"),
    "half": (_halve, "damaged"),
    "no radius": (state(radius=np.array([1e-7, 0.0])), "'radius' is 0 at index 1; must be > 0"),
    "a cell without an edge": (state(cell_size=np.array([1e-6, 0.0, 1e-6])), "'cell_size' is 0 at index 1"),
    "pair out of range": (state(contact_pairs=np.array([[0, 2]])), "names grain 2, there are grains 0 to 1"),
    "lost contact": (state(contact_pairs=np.zeros((0, 2), int)), "'contact_pairs' has the shape (0, 2)"),
    "third aggregate": (state(aggregate=np.array([0, 2])), "'aggregate' must be 0 or 1"),
    "no grain": (state(**state_arrays(0.0, np.zeros((0, 3)), np.zeros((0, 3)), [])), "holds no grain"),
    "nowhere": (state(position=np.full((2, 3), np.nan)), "'position' holds a value that is not finite"),
    "two times": (state(time=np.zeros(2)), "'time' must be one number"),
}  # fmt: skip


@pytest.mark.parametrize("damage", STATE_DAMAGE)
def test_damaged_states_say_what_and_where(folder, damage):
    """Some arrays of a state alone are checked too."""
    spoil, message = STATE_DAMAGE[damage]
    spoil(folder / "states" / "000000.npz")
    run = open_run(folder)
    with refused(RunFolderError, message, "000000.npz"):
        run.start
    assert run.last.radius.size == 2
    if damage == "nowhere":
        assert list(run.states.arrays(0, ("velocity",))) == ["velocity"]
        with refused(RunFolderError, message):
            run.states.arrays(0, ("position",))


def test_a_flipped_bit_of_a_state_is_noticed_or_changes_nothing(folder):
    """Dates and attributes of the archive are under no sum of it."""
    file = folder / "states" / "000000.npz"
    whole, state = file.read_bytes(), open_run(folder).start
    refused = 0
    for where in range(0, len(whole), 13):
        data = bytearray(whole)
        data[where] ^= 1 << where % 8
        file.write_bytes(data)
        try:
            found = open_run(folder).start
        except RunFolderError as error:
            assert "\n" not in str(error)
            refused += 1
        else:
            assert all(np.array_equal(getattr(found, q.name), getattr(state, q.name)) for q in COLLISION.states[:-1])
    assert refused > len(whole) / 13 / 2
