"""Run a table to its end, however often it is stopped in between.

    python3 yade_scripts/study.py TABLE [-j JOBS]    run what is left, JOBS threads at once
    python3 yade_scripts/study.py TABLE --longer 6e-6    go on with runs that ended undecided, to that duration [s]
    python3 yade_scripts/study.py TABLE --device gpu     collisions on a GPU (make gpu), what it can't run as otherwise;
                                                     processor: by the same code
    python3 yade_scripts/study.py TABLE --status     what is done, running, waiting, failed; runs nothing
    python3 yade_scripts/study.py TABLE --slurm [-j JOBS] [-- --time=12:00:00]
                                                     what is left as job arrays of Slurm, JOBS tasks of each at once;
                                                     after --: options of sbatch

Rows whose run folder has ended are skipped, provided that its parameters are the row's (its duration may be longer);
runs that were killed, or ended undecided before the row's duration, resume from their last checkpoint. Before anything
runs, the time it will take is printed: steps times contacts at the speed of a usual core, and once rows have ended, at
theirs. Ctrl-C and SIGTERM stop the runs, each with a checkpoint. Logs are in runs/logs/NAME of the table. TABLE may
also be the name of a study's table, elastoplastic-desk, which is written into yade_scripts/studies if it isn't there.
Of yade-batch's columns !SCRIPT, !THREADS and !OMP_NUM_THREADS count.

With --slurm each row that is left is one task, or short ones share one. A minute before its time limit a task writes
its checkpoint and is queued again. --dry-run prints the scripts, and submits nothing.

Exit status: 0 when every row has ended (--slurm: is submitted), 1 when a row failed (one line on stderr for each; the
others have run), 2 for a table that can't be used, 128 and the signal's number when stopped.
"""

import argparse
import os
import signal
import sys
from pathlib import Path

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from analysis.startup import end_quietly, require_libraries

end_quietly(signal.SIGINT)
require_libraries()
from analysis.printable import printable, shell_line
from analysis.runs.status import DONE, FAILED, RUNNING, WAITING
from analysis.version import version_text
from yade_scripts.parameters import InputError, one_line, one_line_errors, show, tell
from yade_scripts.run import on_device
from yade_scripts.run.parameters import CORES
from yade_scripts.run.script import StopSignals
from yade_scripts.runner import slurm
from yade_scripts.runner.batch import LOGS
from yade_scripts.runner.study import Study
from yade_scripts.studies import tables

SCRIPT = os.path.basename(__file__)
STOPPING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def parse_arguments(arguments):
    """The options; .sbatch has those after --."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", metavar="TABLE")
    jobs = f"threads at once (default: one for each core, {CORES}); with --slurm tasks of an array (default: all)"
    parser.add_argument("-j", "--jobs", type=int, metavar="JOBS", help=jobs)
    parser.add_argument("--version", action="version", version=f"study.py {version_text()}")
    parser.add_argument("--longer", type=float, metavar="SECONDS", help="duration to which undecided runs go on")
    parser.add_argument("--device", choices=tuple(on_device.LIBRARIES), help="where collisions run that can run there")
    parser.add_argument("--status", action="store_true", help="print what has become of each row, and run nothing")
    parser.add_argument("--slurm", action="store_true", help="submit what is left; after --: options of sbatch")
    parser.add_argument("--dry-run", action="store_true", help="with --slurm: print the job scripts, submit nothing")
    end = arguments.index("--") if "--" in arguments else len(arguments)
    options = parser.parse_args(arguments[:end])
    options.sbatch = arguments[end + 1 :]
    if options.jobs is not None and options.jobs < 1:
        parser.error(f"-j = {options.jobs}: must be 1 or more")
    if (options.sbatch or options.dry_run) and not options.slurm:
        parser.error(f'{"--dry-run" if options.dry_run else options.sbatch[0]}: must be given with --slurm')
    if options.longer is not None and not (options.longer > 0 and not options.slurm):
        parser.error(f"--longer = {options.longer:g}: must be > 0, and without --slurm")
    if options.device and (options.longer is not None or options.slurm):
        parser.error("--device: must be given without --slurm and --longer (its runs leave no checkpoints)")
    if options.status and options.slurm:
        parser.error("--status: must be given without --slurm")
    return options


def place_of(table):
    """The folder in which a table has been run: the one that one stands in, or else the nearest above the table."""
    places = [Path.cwd(), *Path(table).absolute().parents]
    return next((place for place in places if (place / LOGS / Path(table).stem).is_dir()), places[0])


def submit(study, options):
    """Submit the rows that are left and not in the queue to Slurm, or print their scripts; the exit status."""
    states, queued = study.states_with_queue(sure=True)
    refused = [(row, state) for row, state in zip(study.rows, states) if state.refused]
    for row, state in refused:
        tell(f"{row.name}: {state.note}; the other rows are submitted", SCRIPT)
    left = [
        row
        for row, state, in_queue in zip(study.rows, states, queued)
        if state.kind in (WAITING, FAILED) and not state.refused and not in_queue
    ]
    jobs = slurm.jobs(study.folder, left, options.jobs)
    if options.dry_run:
        if not left:
            tell("all rows have ended, or are in the queue: nothing to submit", SCRIPT)
        texts = [f"{script}# {shell_line(slurm.command(folder, options.sbatch))}\n" for folder, _, _, script in jobs]
        print("\n".join(texts), end="", flush=True)
        return int(bool(refused))
    study.folder.remove_logs(left)
    for folder, rows, tasks, script in jobs:
        job = slurm.submit(folder, rows, tasks, script, options.sbatch)
        print(f"Slurm job {job}: {len(rows)} rows in {tasks} tasks, {rows[0].threads} threads each", flush=True)
    done, running = (sum(state.kind == kind for state in states) for kind in (DONE, RUNNING))
    print(
        f"{printable(study.name)}: {len(states)} rows, {done} done, {running} running, {len(refused)} failed, "
        f"{sum(queued)} in the queue before, {len(left)} submitted"
    )
    return int(bool(refused))


def close(study, states, stop):
    """Print how it went; the exit status."""
    for row, state in zip(study.rows, states):
        if state.kind == FAILED and not row.error:  # which was printed at the start
            tell(f"{row.name}: {state.note}", SCRIPT)
        elif state.kind not in (DONE, FAILED) and not stop.received:
            tell(f"{row.name}: was stopped; another call resumes it", SCRIPT)
    done, failed = (sum(state.kind == kind for state in states) for kind in (DONE, FAILED))
    left = f", {len(states) - done - failed} left" if stop.received else ""
    print(f"{printable(study.name)}: {len(states)} rows, {done} done, {failed} failed{left}{study.undecided(states)}")
    if stop.received:
        return 128 + stop.received
    return 0 if done == len(states) else 1


def main(arguments):
    options = parse_arguments(arguments)
    with one_line_errors(SCRIPT):
        table = options.table if os.path.exists(options.table) else tables.find(options.table)
        if options.status and (place := place_of(table)) != Path.cwd():
            table = os.path.abspath(table)
            os.chdir(place)
        study = Study(table, options.jobs or CORES, options.longer)
        library = on_device.library_of(options.device) if options.device else None
        if options.status:
            states, _ = study.states_with_queue()
            show(study.table(states) + study.undecided(states))
            return 0
        if not options.dry_run:
            study.folder.lock()
        if options.slurm:
            return submit(study, options)
    stop = StopSignals(STOPPING if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN else STOPPING[:2])  # nohup
    wrong = [row for row in study.rows if row.error]
    for row in wrong:
        tell(f"{row.name}: {row.error}{'; the other rows are run' if len(wrong) < len(study.rows) else ''}", SCRIPT)
    try:
        states = study.run(stop, library)
    except (InputError, OSError) as error:  # yade is missing, the disk is full
        tell(one_line(error), SCRIPT)
        return 1
    stop.restore()
    return close(study, states, stop)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
