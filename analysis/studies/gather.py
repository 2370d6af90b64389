"""From paths to one table with the runs of a study."""

import errno
from dataclasses import dataclass
from pathlib import Path

import pandas

from ..printable import Refused, suggested
from ..progress import progress
from ..report.rows import differing, frame, parameters_of, varied
from ..runs.collect import joined, provenance, run_folders
from ..runs.files import RunFolderError
from ..runs.folder import open_run
from ..runs.format import ENDED_FILE, value_text
from ..runs.table import ENDING, FOLDER, RUN, make_table, read_table, table_text
from .columns import NotMeasured

TABLE_FILE = "runs.csv"
LENGTH = "duration", "endWhenApart"  # how long a run is: of two of one collision the longer one counts


@dataclass
class Gathered:
    """Runs of a study: notes (a line for each run left out), problems (one for each path or run that could not be
    read), table (DataFrame, a row a run; None where there is none), provenance (runs.collect)."""

    notes: list
    problems: list
    table: pandas.DataFrame = None
    provenance: dict = None

    def csv(self, study):
        """The table of runs as a file (str)."""
        return table_text(self.table, study.columns, {"study": study.name, "provenance": self.provenance})


def gather(study, paths):
    """Gathered runs of a study.Study: tables (.csv) are read, then run folders measured.

    Of runs with the same values in study.key one is counted, since more would make errors too small: a table's row
    before a folder (whose states serve figures), and of folders the longest run. Of runs that must be alike and are
    not none is counted."""
    found, rows, origins = Gathered([], []), {}, []
    tables = [path for path in map(Path, paths) if path.suffix == ENDING and path.is_file()]
    for file in tables:
        try:
            own, origin = _read(study, file)
        except (Refused, RunFolderError) as error:
            found.problems.append(str(error))
            continue
        if known := len(own.keys() & rows.keys()):
            found.notes.append(f"{file}: {known} runs are in a table before it, which counts")
        rows |= {key: row for key, row in own.items() if key not in rows}
        origins.append(origin)
    measured = _measure(study, [path for path in paths if Path(path) not in tables], found)
    unlike = _unlike(study, [run for run, _ in measured]) if study.alike else None
    if unlike:
        found.problems.append(unlike)
        return found
    measured = _once(study, measured, rows, found)
    if measured:
        origins.append(provenance([run for run, _ in measured]))
    parts = [pandas.DataFrame(rows.values()), make_table((run.path, values) for run, values in measured)]
    parts = [part for part in parts if len(part)]
    if parts:
        found.table = pandas.concat(parts, ignore_index=True)
        found.provenance = {**joined(origins), "runs": len(found.table)} if len(origins) > 1 else origins[0]
    return found


def require_own(file, name):
    """OSError where a table (Path) is there that no analysis of a study of this name has written."""
    if file.exists() and f'"study": "{name}"' not in file.open(encoding="utf-8", errors="replace").readline():
        raise OSError(errno.EEXIST, f"no analysis of {name} has written it; must be another folder", str(file))


def _read(study, file):
    """({key: row}, provenance) of a table."""
    table, head = read_table(file, study.columns)
    if head.get("study") != study.name or not isinstance(head.get("provenance"), dict):
        raise Refused(f"{file}: a table of the study {head.get('study')}: must be of {study.name}")
    rows = {_key(study, row): row for row in table.to_dict("records")}
    if len(rows) < len(table):
        raise Refused(f"{file}: two runs have the same {', '.join(study.key)}")
    return rows, head["provenance"]


def _measure(study, paths, found):
    """[(RunFolder, {column: value})] of those that have ended and are the study's."""
    measured = []
    for path, problem in progress(run_folders(paths), "reading runs"):
        try:
            if problem:
                raise RunFolderError(problem)
            if not (path / ENDED_FILE).is_file():  # a run that is under way has perhaps no history yet
                raise NotMeasured(f"{path}: has not ended")
            run = open_run(path)
            study.require(run)
            measured.append((run, study.measure(run)))
        except NotMeasured as error:
            found.notes.append(f"{error}, left out")
        except RunFolderError as error:
            found.problems.append(str(error))
    return measured


def _once(study, runs, rows, found):
    """Of _measure() those that are not in a table, the longest of each key; rows of a table get their folder."""
    measured, known, same = {}, [], f"the same {', '.join(study.key)} as"
    for run, values in runs:
        key = _key(study, values)
        if key in rows:
            rows[key][FOLDER] = rows[key][FOLDER] or str(run.path)
            known.append(f"{run.path}: {same} {rows[key][RUN]} of a table, counted once")
        elif key in measured:
            by_length = sorted([(run, values), measured[key]], key=lambda own: own[0].history["time"][-1])
            short, measured[key] = by_length
            found.notes.append(f"{short[0].path}: {same} {measured[key][0].path}, which is as long or longer, left out")
        else:
            measured[key] = run, values
    if known:
        found.notes.append(known[0] + (f", as are {len(known) - 1} more" if known[1:] else ""))
    return list(measured.values())


def _key(study, values):
    return tuple(value_text(values[name]) for name in study.key)


def _unlike(study, runs):
    """What is wrong with RunFolders that must be alike: one line, or None. A parameter that a run of an earlier
    version lacks is as in the others; those of the study's key and the length of runs may differ."""
    rows, usual = [(run.path, parameters_of(run)) for run in runs], {}
    for _, row in reversed(rows):
        usual.update(row)
    if not rows:
        return None
    for name in study.values:
        if name not in usual:
            return f"{name}: no run has this parameter{suggested(name, usual)}"
    found = frame([(path, {**usual, **row}) for path, row in rows])
    names = [name for name in varied(found) if name not in (*study.key, *LENGTH)]
    must = "name them in varied, or give collision_study() one value of each"
    return differing(found, names, must) if names else None
