"""From paths to one table with the runs of a study."""

import errno
from dataclasses import dataclass, field

import pandas

from ..printable import suggested
from ..progress import progress
from ..report.rows import differing, frame, parameters_of, varied
from ..runs.collect import collect, joined, provenance
from ..runs.files import RunFolderError
from ..runs.format import value_text
from ..runs.table import FOLDER, RUN, TableError, make_table, read_table, table_text
from .columns import NotMeasured

TABLE_FILE = "runs.csv"
LENGTH = "duration", "endWhenApart"  # how long a run is: of two of one collision the longer one counts


@dataclass
class Gathered:
    """Runs of a study: table (DataFrame, a row a run; None where there is none), provenance (runs.collect), notes
    (a line for each run left out) and problems (one for each path or run that could not be read)."""

    table: pandas.DataFrame = None
    provenance: dict = None
    notes: list = field(default_factory=list)
    problems: list = field(default_factory=list)

    def csv(self, study):
        """The table of runs as a file (str)."""
        return table_text(self.table, study.columns, {"study": study.name, "provenance": self.provenance})


def gather(study, paths):
    """Gathered runs of a study.Study: tables (.csv) are read, then run folders measured.

    Of runs with the same values in scene.key one is counted, since more would make errors too small: a table's row
    before a folder (whose states serve figures), and of folders the longest run. Of runs that must be alike and are
    not none is counted."""
    collection = collect(paths, study.scene)
    found = Gathered(notes=list(collection.notes), problems=list(collection.problems))
    parts, taken = [], {}
    for file in collection.tables:
        try:
            table, origin = _read(study, file)
        except TableError as error:
            found.problems.append(str(error))
            continue
        keys = [_key(study, row) for row in table.to_dict("records")]
        new = [key not in taken for key in keys]
        if not all(new):
            found.notes.append(f"{file}: {new.count(False)} runs are in a table before it, which counts")
        taken.update((key, f"{file}, {run}") for key, run, counts in zip(keys, table[RUN], new) if counts)
        parts.append((table[new], origin))
    unlike = _unlike(study, collection.runs) if study.alike else None
    if unlike:
        found.problems.append(unlike)
        return found
    folders = {}
    measured = _measure(study, collection.runs, taken, found, folders)
    if measured:
        table = make_table([(run.path, values) for run, values in measured])
        parts.append((table, provenance([run for run, _ in measured])))
    if parts:
        tables, origins = zip(*parts)
        found.table = pandas.concat(tables, ignore_index=True)
        found.table[FOLDER] = [folders.get(_key(study, row), row[FOLDER]) for row in found.table.to_dict("records")]
        found.provenance = {**joined(origins), "runs": len(found.table)} if len(origins) > 1 else origins[0]
    return found


def require_own(file, name):
    """OSError where a table (Path) is there that no analysis of a study of this name has written."""
    if file.exists() and f'"study": "{name}"' not in file.open(encoding="utf-8", errors="replace").readline():
        raise OSError(errno.EEXIST, f"no analysis of {name} has written it; must be another folder", str(file))


def _read(study, file):
    table, head = read_table(file, study.columns)
    if head.get("study") != study.name or not isinstance(head.get("provenance"), dict):
        raise TableError(f"{file}: a table of the study {head.get('study')}: must be of {study.name}")
    keys = [_key(study, row) for row in table.to_dict("records")]
    if len(set(keys)) < len(keys):
        raise TableError(f"{file}: two runs have the same {', '.join(study.scene.key)}")
    return table, head["provenance"]


def _measure(study, runs, taken, found, folders):
    """[(RunFolder, {column: value})] of those not in a table; folders takes {key: path} of those that are."""
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
        key, same = _key(study, values), f"the same {', '.join(study.scene.key)} as"
        if key in taken:
            folders.setdefault(key, str(run.path))
            found.notes.append(f"{run.path}: {same} {taken[key]}, counted once")
        elif key in measured:
            short, measured[key] = sorted([(run, values), measured[key]], key=_end)
            found.notes.append(f"{short[0].path}: {same} {measured[key][0].path}, which is as long or longer, left out")
        else:
            measured[key] = run, values
    return list(measured.values())


def _end(measured):
    return float(measured[0].history["time"][-1])


def _key(study, values):
    return tuple(value_text(values[name]) for name in study.scene.key)


def _unlike(study, runs):
    """What is wrong with RunFolders that must be alike: one line, or None. A parameter that a run of an earlier
    version lacks is as in the others; those of the study's key and the length of runs may differ."""
    rows, usual = [(run.path, parameters_of(run)) for run in runs], {}
    for _, row in reversed(rows):
        usual.update(row)
    strange = [name for name in study.scene.values if rows and name not in usual]
    if strange:
        return f"{strange[0]}: no run has this parameter{suggested(strange[0], usual)}"
    found = frame([(path, {**usual, **row}) for path, row in rows]) if rows else None
    names = [name for name in varied(found) if name not in (*study.scene.key, *LENGTH)] if rows else []
    return (
        differing(found, names, "name them in varied, or give collision_study() one value of each") if names else None
    )
