"""Whether runs, and the tables of studies, are as they were written: all their files are read, and compared with their sums."""

from pathlib import Path

from .files import RunFolderError, begins_with_sum, is_unfinished, read_bytes, read_summed
from .folder import read_ended, read_record, state_files
from .format import CHECKPOINT_FOLDER, ENDED_FILE, HEARTBEAT_FILE
from .status import run_of

_WITHOUT_SUMS = (ENDED_FILE, HEARTBEAT_FILE, f"{CHECKPOINT_FOLDER}/", ".heartbeat-")  # files of runs
NAMED = 3  # files that a line names
NO_SUMS = "has no sums (of a version before 0.5.0): damage that leaves it readable is not noticed"


def verify_run(folder):
    """([what differs], [what else there is to say]) of a run folder (path), in lines."""
    folder = Path(folder)
    try:
        sums = read_ended(folder)
    except RunFolderError as error:
        return [str(error)], []
    if sums is None:
        if run_of(folder).get("outcome") == "completed":
            return [f"{folder / ENDED_FILE}: missing, though the run is completed"], []
        return [], ["has no sums before it has ended"]
    if not sums:
        problems = _wrong(read_record, folder)
        return problems, [] if problems else [NO_SUMS]
    checks = [_wrong(read_bytes, folder / name, digits) for name, digits in sorted(sums.items())]
    problems, others = sum([*checks, _wrong(state_files, folder, sums)], []), _others(folder, sums)
    said = [] if problems else [f"{len(sums)} files, as the run has left them"]
    if others:
        more = f" and {len(others) - NAMED} more" if len(others) > NAMED else ""
        said.append(f"also holds {', '.join(others[:NAMED])}{more}, which the run has not written")
    return problems, said


def verify_text(file):
    """The same of a study's runs.csv or comparison.json."""
    problems = _wrong(read_summed, file)
    return problems, [] if problems else ["as it was written" if begins_with_sum(file) else NO_SUMS]


def _wrong(check, *of):
    """[what check(*of) finds wrong]."""
    try:
        check(*of)
    except RunFolderError as error:
        return [str(error)]
    return []


def _others(folder, sums):
    """Names of the files in a folder that are not the run's, sorted."""
    found = (path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir())
    theirs = (name for name in found if name not in sums and not name.startswith(_WITHOUT_SUMS))
    return sorted(name for name in theirs if not is_unfinished(Path(name).name))
