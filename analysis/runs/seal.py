"""Sums by which damage is found: those of a run folder's files, in `ended`, and those that a text carries of itself.

runs.format says what `ended` looks like. A file that is read is checked by the sum of its end alone, which takes no time: there an
archive lists its arrays, each with its CRC-32, and zipfile compares an array with that when it reads it. verify() reads all."""

import errno
import hashlib
import json
import os
import re
import stat
import warnings
import zipfile
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from .arrays import RunFolderError, require_regular
from .format import ENDED_FILE, SEALED, STATES_FOLDER

# What a text that carries its sum begins with, as the first of a JSON object; summed() puts the sum in the place of the zeros.
SUM = "sha256"
UNSUMMED = {SUM: "0" * 64}
_OWN_SUM = re.compile(r'(?:# )?\{\s*"sha256": "([0-9a-f]{64})"')
FIRST = 100  # characters, in which the sum stands
_WITHOUT = re.compile(r'(?:# )?\{\s*"study"')  # a text of a version before 0.5.0


class Unsealed(UserWarning):
    """Runs without sums are read; the message is one line."""


NO_SUMS = Unsealed("runs of versions before 0.5.0 have no sums: damage that leaves them readable is not noticed")


@dataclass(frozen=True)
class Seal:
    """Sums of the files of a run folder that has ended. folder: its path; files: {name: SHA-256}, none of a run of a version before
    0.5.0; ends: {name: (byte, SHA-256 of the file from there on)}; names as seen from the folder."""

    folder: Path
    files: dict = field(default_factory=dict)
    ends: dict = field(default_factory=dict)

    @property
    def states(self):
        """Names of the states' files, sorted."""
        return sorted(name for name in self.files if name.startswith(f"{STATES_FOLDER}/"))

    def require(self, name):
        """Raise RunFolderError unless a file is that which the run has left: of an .npz the list of its arrays is looked at, of
        another one all."""
        if self.files:
            start, written = self.ends.get(name, (0, self.files.get(name)))
            if written is None:
                raise RunFolderError(f"{self.folder / name}: not of this run, which has left no such file; must be moved away")
            self._compare(name, start, written)

    def require_whole(self, name):
        """Raise RunFolderError unless each byte of a file is as the run has left it."""
        self._compare(name, 0, self.files[name])

    def _compare(self, name, start, written):
        file = os.path.join(self.folder, name)
        try:
            found = sum_of(file, start)
        except FileNotFoundError:
            raise RunFolderError(f"{file}: missing") from None
        except OSError as error:
            raise RunFolderError(f"{file}: cannot be read: {error.strerror}") from None
        if found != written:
            raise RunFolderError(
                f"{file}: not as the run has left it: its SHA-256{f' from byte {start} on' if start else ''} is {found[:12]}..., "
                f"must be {written[:12]}..., as in {ENDED_FILE}"
            )


def seal_text(folder, names):
    """Content (str) of `ended` for these files, names as seen from the folder; OSError where one cannot be read."""
    lines = [f"# {json.dumps({**UNSUMMED, 'check': f'sha256sum -c {ENDED_FILE}'})}"]
    for name in sorted(names):
        file = Path(folder) / name
        lines.append(f"{sum_of(file)}  {name}")
        if file.suffix == ".npz":
            start = _list_of_arrays(file)
            lines.append(f"# {sum_of(file, start)}  {name} from byte {start} on")
    return summed("\n".join(lines) + "\n")


def read_seal(folder):
    """Seal of a run folder (path), None where the run has not ended; RunFolderError where `ended` is damaged."""
    file = Path(folder) / ENDED_FILE
    text = read_text(file)
    if not text:
        return None if text is None else Seal(Path(folder))
    require_own_sum(file, text)
    lines = [line.split() for line in text.splitlines()[1:]]
    try:
        files = {name: written for written, name in (line for line in lines if line[0] != "#")}
        return Seal(Path(folder), files, {line[2]: (int(line[5]), line[1]) for line in lines if line[0] == "#"})
    except (ValueError, IndexError):
        raise RunFolderError(f"{file}: damaged: holds other lines than sums") from None


def require_sealed(seal, file_format):
    """Raise RunFolderError where a run of this format has ended without sums, whose `ended` was emptied then."""
    if seal is not None and not seal.files and file_format >= SEALED:
        raise RunFolderError(f"{seal.folder / ENDED_FILE}: empty; must hold the sums of the run's files")


def summed(text):
    """A text that begins with UNSUMMED, with its sum."""
    return text.replace(UNSUMMED[SUM], hashlib.sha256(text.encode()).hexdigest(), 1)


def read_summed(file):
    """The text of a file that summed() has made, or of one of a version before 0.5.0, without a sum; RunFolderError where it is missing or
    another text."""
    text = read_text(file)
    if text is None:
        raise RunFolderError(f"{file}: missing")
    if _WITHOUT.match(text):
        warnings.warn(NO_SUMS, stacklevel=1)
    else:
        require_own_sum(file, text)
    return text


def begins_with_sum(file):
    """Whether there is such a file, and it begins as summed() makes it."""
    with suppress(OSError), open(file, encoding="utf-8", errors="replace") as text:
        return bool(_OWN_SUM.match(text.read(FIRST)))
    return False


def require_own_sum(file, text):
    """RunFolderError where a file's text is not what summed() has made."""
    found = _OWN_SUM.match(text)
    if not found:
        raise RunFolderError(f"{file}: not as `analysis study` has written it: must begin with its sum")
    if summed(text[: found.start(1)] + UNSUMMED[SUM] + text[found.end(1) :]) != text:
        raise RunFolderError(f"{file}: not as it was written: its SHA-256 is another than its first line says")


def read_text(file):
    """A file's text (str), None where there is no such file; RunFolderError where it cannot be read."""
    require_regular(file)
    try:
        return Path(file).read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        return None
    except OSError as error:
        raise RunFolderError(f"{file}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise RunFolderError(f"{file}: damaged: {error}") from None


def sum_of(file, start=0):
    """SHA-256 (str) of a file from a byte on; OSError where it cannot be read, or is none."""
    found, handle = hashlib.sha256(), os.open(file, os.O_RDONLY | os.O_NONBLOCK)  # which does not wait for a pipe's writer
    try:
        about = os.fstat(handle)
        if not stat.S_ISREG(about.st_mode):
            raise OSError(errno.EINVAL, "is no regular file; must be one", os.fspath(file))
        while part := os.pread(handle, max(0, min(about.st_size - start, 2**20)), start):
            found.update(part)
            start += len(part)
    finally:
        os.close(handle)
    return found.hexdigest()


def _list_of_arrays(file):
    """Byte at which the list of an archive's files begins; OSError where it has none."""
    try:
        with zipfile.ZipFile(file) as archive:
            return archive.start_dir
    except zipfile.BadZipFile as error:
        raise OSError(errno.EIO, f"damaged since it was written: {error}", str(file)) from None
