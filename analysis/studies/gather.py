"""From paths to one table with the runs of a study."""

from dataclasses import dataclass, field

import pandas

from ..printable import suggested
from ..progress import progress
from ..report.rows import differing, frame, parameters_of, varied
from ..runs.collect import collect, joined, provenance
from ..runs.files import RunFolderError
from ..runs.table import FOLDER, RUN, TableError, make_table, read_table
from .definition import NotMeasured

LENGTH = "duration", "endWhenApart"  # how long a run is: of two of one collision the longer one counts


@dataclass
class Gathered:
    """What was found: table (DataFrame, a row a run; None where there is none), provenance (dict), notes (str, one a run
    left out), alike ({parameter: value} that runs which must be alike share), problems (str, one a path or run that could not be read), earlier
    (what tables that were read say of runs left out), shown (str, one a run whose numbers are a table's: its states serve figures)."""

    table: pandas.DataFrame = None
    provenance: dict = None
    alike: dict = field(default_factory=dict)
    notes: list = field(default_factory=list)
    problems: list = field(default_factory=list)
    earlier: list = field(default_factory=list)
    shown: list = field(default_factory=list)


def gather(study, paths):
    """Gathered runs of a study: tables (.csv) are read, then run folders measured. Of runs with the same values in scene.key only one is
    counted, since more would make errors too small: a table's row, of tables the first's, and of folders the longest run. Where a row
    has a folder too, figures that need a run's states take them from there. Of runs that must be alike and are not none is counted."""
    collection = collect(paths, study.scene)
    found = Gathered(notes=list(collection.notes), problems=list(collection.problems))
    taken, parts, folders, shared = {}, [], {}, []
    for file in collection.tables:
        try:
            table, head, earlier = _read(study, file, taken)
        except TableError as error:
            found.problems.append(str(error))
            continue
        parts.append((table, head["provenance"]))
        shared.append((file, head.get("alike") or {}))
        found.earlier += earlier
    shared += [(run.path, parameters_of(run)) for run in collection.runs if study.alike]
    if study.alike and shared:
        found.alike, unlike = _alike(study, shared)
        if unlike:
            found.problems.append(unlike)
            return found
    measured = _measure(study, collection.runs, taken, found, folders)
    if measured:
        rows = [(run.path, values) for run, values in measured]
        parts.append((make_table(rows), provenance([run for run, _ in measured])))
    if parts:
        tables, origins = zip(*parts)
        found.table = pandas.concat(tables, ignore_index=True) if len(tables) > 1 else tables[0]
        found.provenance = {**joined(origins), "runs": len(found.table)} if len(origins) > 1 else origins[0]
        found.table[FOLDER] = [folders.get(_key(study, row), row[FOLDER]) for row in found.table.to_dict("records")]
    return found


def _alike(study, rows):
    """({parameter: value} that runs share which must be alike, what is wrong where they differ: one line, or None) of [(path, parameters)] of
    runs and tables of runs, or name what none has. The study's key may differ; a parameter that a run of an earlier version lacks is as in the others."""
    usual, own = {}, (*study.scene.key, *LENGTH)
    for _, row in reversed(rows):
        usual.update(row)
    strange = [name for name in study.scene.values if name not in usual]
    if strange:
        return {}, f"{strange[0]}: no run has this parameter{suggested(strange[0], usual)}"
    found = frame([(path, {**usual, **row}) for path, row in rows])
    names = [name for name in varied(found) if name not in own]
    advice = "name them in varied, or give collision_study() one value of each"
    shared = {name: value for name, value in usual.items() if name not in own}
    return shared, differing(found, names, advice) if names else None


def _measure(study, runs, taken, found, folders):
    """[(RunFolder, {column: value})]; folders takes {key: path} of those that are in a table already."""
    measured = {}
    for run in progress(runs, "reading runs"):
        try:
            values = study.measure(run)
        except NotMeasured as error:
            found.notes.append(f"{error}, left out")
            continue
        except RunFolderError as error:
            found.problems.append(str(error))
            continue
        key = _key(study, values)
        same = f"the same {_listed(study.scene.key)} as"
        if key in taken:
            folders.setdefault(key, str(run.path))
            found.shown.append(f"{run.path}: {same} {taken[key]}, counted once")
        elif key not in measured:
            measured[key] = run, values
        else:
            short, measured[key] = sorted([(run, values), measured[key]], key=_end)
            long = measured[key]
            why = "which is longer, " if _end(short) < _end(long) else ""
            found.notes.append(f"{short[0].path}: {same} {long[0].path}, {why}left out")
    return list(measured.values())


def _end(measured):
    """Time of the last sample [s] of a RunFolder, the first of a tuple."""
    return float(measured[0].history["time"][-1])


def _read(study, file, taken):
    """(table, head, notes) of a file of an earlier analysis."""
    table, head = read_table(file, study.columns)
    if head.get("study") != study.name or not isinstance(head.get("provenance"), dict):
        raise TableError(f"{file}: a table of the study {head.get('study')}: must be of {study.name}")
    if head["provenance"].get("runs") != len(table):
        said = head["provenance"].get("runs")
        raise TableError(f"{file}: says that it holds {said} runs, it holds {len(table)}")
    keys = [_key(study, row) for row in table.to_dict("records")]
    if len(set(keys)) < len(keys):
        raise TableError(f"{file}: two runs have the same {_listed(study.scene.key)}")
    new = [key not in taken for key in keys]
    notes = list(head.get("notes", []))
    if not all(new):
        notes.append(f"runs of {file.name} that are in a table before it, which counts: {new.count(False)}")
    taken.update((key, f"{file}, {run}") for key, run, counts in zip(keys, table[RUN], new) if counts)
    return table[new], head, notes


def _key(study, values):
    return tuple(v if isinstance(v := values[name], str) else f"{v:.9g}" for name in study.scene.key)


def _listed(names):
    return ", ".join(names[:-1]) + " and " + names[-1] if len(names) > 1 else names[0]
