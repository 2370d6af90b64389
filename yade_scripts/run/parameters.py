"""Parameters of every kind of run (how it is stepped, where it is written), and where a script's parameters come
from."""

import hashlib
import os
import sys
from ctypes import CDLL
from dataclasses import dataclass

from analysis.runs.format import value_text
from yade_scripts.parameters import (
    NOT_NEGATIVE,
    POSITIVE,
    SWITCH,
    Check,
    ParameterError,
    Parameters,
    between,
    one_of,
    parameter,
)
from yade_scripts.run import table
from yade_scripts.time_step import AUTO, STABLE_STEP

# In YADE libgomp counts them: with OMP_PROC_BIND it has bound this process to the first.
CORES = CDLL("libgomp.so.1").omp_get_num_procs() if "yade" in sys.modules else len(os.sched_getaffinity(0))
SPRINGS = ("sliding", "rolling", "twisting")
TOLERANCE = 1e-4  # with stepFraction=auto
STEP = Check(
    f"> 0 and <= {STABLE_STEP}, less in dense packings and with drag, or {AUTO}", lambda x: 0 < x <= STABLE_STEP
)
FOLDER = Check("a folder that can be written", lambda text: text != "")
LONGEST = 200  # bytes of a file's name; Linux has 255, and temporary files and logs add to it


@dataclass(frozen=True)
class RunParameters(Parameters):
    """The run."""

    stepFraction: float | str = parameter(0.1, STEP, "time step; auto: the longest for tolerance", "t0", word=AUTO)
    tolerance: float | None = parameter(
        None,
        between(1e-7, 1e-2),
        "with stepFraction=auto: largest error of the energy ledger over K(0), or over the boundaries' work in a "
        f"compression ({TOLERANCE:g})",
        "1",
    )
    engine: str = parameter("fused", one_of(["fused", "functors"]), "JKRWadaEngine, or YADE's own loop (much slower)")
    limit: str = parameter(
        "held",
        one_of(["held", "cut"]),
        "displacements of contacts at their limits: held there (W07), or their springs cut and new ones formed (S17)",
    )
    sliding: int = parameter(1, SWITCH, "0: contacts do not resist sliding")
    rolling: int = parameter(1, SWITCH, "0: contacts do not resist rolling")
    twisting: int = parameter(1, SWITCH, "0: contacts do not resist twisting")
    slidingStiffnessFactor: float = parameter(
        1.0, POSITIVE, "stiffness of sliding k_s over 8 a0 G*: 1 (W07, A22), or 2 (S17 eqs 11 and 12 as printed)", "1"
    )
    rollingStiffnessFactor: float = parameter(1.0, POSITIVE, "stiffness of rolling k_r over 4 F_c/R (W07, A22)", "1")
    springDamping: float = parameter(
        0.0, NOT_NEGATIVE, "c of the damping k c dD/dt of sliding, rolling and twisting springs; 0: they ring on", "s"
    )
    threads: int | None = parameter(
        None,
        Check(">= 1", lambda n: n >= 1),
        "of the fused engine, at most the machine's cores (as many as YADE has); more than 2 are of use from 24,000 "
        "grains on, more than 4 from 48,000 and so on; the functors have those of YADE",
        of_consequence=False,
    )
    states: int = parameter(
        22, between(2, 10_000), "states written, evenly in time, start and end among them", of_consequence=False
    )
    out: str | None = parameter(
        None, FOLDER, "run folder (runs/ and the row's description, or the parameters)", of_consequence=False
    )
    overwrite: int = parameter(0, SWITCH, "1: replace a run that has ended or was stopped", of_consequence=False)
    resume: int = parameter(0, SWITCH, "1: resume from the folder's checkpoint, if it has one", of_consequence=False)
    checkpointInterval: float = parameter(300.0, POSITIVE, "wall time between checkpoints", "s", of_consequence=False)

    @classmethod
    def parse(cls, texts, description=None):
        """As Parameters.parse; `out` is named after the table's row (description) or the parameters."""
        found = super().parse(texts)
        if found.out is not None:
            return found
        name, in_name = found.title()  # and whatever else was given and has consequences
        others = [key for key in sorted(texts) if key not in in_name and cls.columns()[key].of_consequence]
        name += "".join(f"-{key}{value_text(getattr(found, key))}" for key in others)
        return found.changed(out="runs/" + (file_name(description or name).lstrip(".") or "run"))

    def title(self):
        """(name of a run of these parameters, names of the parameters that are in it)."""
        return "run", ()

    ONLY_WITH = [("tolerance", "stepFraction", [AUTO]), *(("springDamping", name, [1]) for name in SPRINGS)]

    def filled_in(self):
        """The default tolerance with stepFraction=auto."""
        chosen = self.stepFraction == AUTO and self.tolerance is None
        return super(RunParameters, self.changed(tolerance=TOLERANCE) if chosen else self).filled_in()

    @property
    def has_all_springs(self):
        """Whether contacts resist sliding, rolling and twisting."""
        return all(getattr(self, name) for name in SPRINGS)

    def with_threads(self, of_yade):
        """The same with the number of threads; of_yade: those that YADE was started with."""
        threads = self.threads or (min(of_yade, CORES) if self.engine == "fused" else of_yade)
        if self.engine == "fused" and threads > CORES:
            raise ParameterError(
                f"threads = {threads}: more than there are cores for this process; must be 1 to {CORES}"
            )
        if self.engine != "fused" and threads != of_yade:
            must = "must be the same (yade -jN, or the column !OMP_NUM_THREADS of a table)"
            raise ParameterError(f"threads = {threads}: YADE was started with {of_yade}; {must}")
        return self.changed(threads=threads)


def file_name(text):
    """text as the name of one file: letters, digits and -_.,=+, others as _; a long one ends in a hash of the text."""
    name = "".join(c if c.isalnum() or c in "-_.,=+" else "_" for c in text)
    if len(name.encode()) <= LONGEST:
        return name
    end = "-" + hashlib.sha256(text.encode()).hexdigest()[:12]
    return name.encode()[: LONGEST - len(end)].decode(errors="ignore") + end


def from_arguments(arguments):
    """{name: text} of arguments such as velocity=10 seed=3; raises ParameterError for anything else."""
    texts = {}
    for argument in arguments:
        name, equals, text = argument.partition("=")
        if not equals or not name:
            raise ParameterError(f"argument '{argument}': not understood; must be name=value, or --help")
        if name in texts:
            raise ParameterError(f"{name}: given twice; must be given once")
        texts[name] = text
    return texts


def gather(arguments, kind):
    """({name: text}, description) of a script: the row of a table (YADE_BATCH, or table=FILE:LINE), and the arguments.

    The description is None without a row, and where an argument of consequence makes another run of it."""
    texts = from_arguments(arguments)
    where = texts.pop("table", None) or os.environ.get("YADE_BATCH")
    if not where:
        return texts, None
    file, _, line = where.rpartition(":")
    if not file:
        raise ParameterError(f"table = {where}: must be FILE:LINE, one row of a table; study.py runs all")
    rows, known = {str(row.line): row for row in table.read(file)}, kind.parameters.columns()
    if line not in rows:
        raise ParameterError(f"table {where}: no such row; must be a line of {', '.join(rows)}")
    another = any(name not in known or known[name].of_consequence for name in texts)
    return {**table.own(rows[line].cells), **texts}, (None if another else rows[line].description)
