"""Whether runs, and the tables of studies, are as they were written: all their files are read, and compared with their sums."""

from pathlib import Path

from .arrays import RunFolderError
from .folder import read_record, state_files
from .format import CHECKPOINT_FOLDER, ENDED_FILE, HEARTBEAT_FILE
from .seal import NO_SUMS, read_seal, read_summed
from .status import run_of
from .write import is_unfinished

_WITHOUT_SUMS = (ENDED_FILE, HEARTBEAT_FILE, f"{CHECKPOINT_FOLDER}/", ".heartbeat-")  # files of runs
NAMED = 3  # files that a line names


def verify_run(folder):
    """([what differs], [what else there is to say]) of a run folder (path), in lines."""
    folder = Path(folder)
    try:
        seal = read_seal(folder)
    except RunFolderError as error:
        return [str(error)], []
    if seal is None:
        if run_of(folder).get("outcome") == "completed":
            return [f"{folder / ENDED_FILE}: missing, though the run is completed"], []
        return [], ["has no sums before it has ended"]
    if not seal.files:
        problems = _wrong(read_record, folder)
        return problems, [] if problems else [str(NO_SUMS)]
    checks = [_wrong(seal.require_whole, name) for name in sorted(seal.files)] + [_wrong(state_files, folder, seal)]
    problems, others = sum(checks, []), _others(folder, seal)
    said = [] if problems else [f"{len(seal.files)} files, as the run has left them"]
    if others:
        more = f" and {len(others) - NAMED} more" if len(others) > NAMED else ""
        said.append(f"also holds {', '.join(others[:NAMED])}{more}, which the run has not written")
    return problems, said


def verify_text(file):
    """The same of a study's runs.csv or comparison.json."""
    problems = _wrong(read_summed, file)
    return problems, [] if problems else ["as it was written"]


def _wrong(check, *of):
    """[what check(*of) finds wrong]."""
    try:
        check(*of)
    except RunFolderError as error:
        return [str(error)]
    return []


def _others(folder, seal):
    """Names of the files in a folder that are not the run's, sorted."""
    found = (path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir())
    theirs = (name for name in found if name not in seal.files and not name.startswith(_WITHOUT_SUMS))
    return sorted(name for name in theirs if not is_unfinished(Path(name).name))
