"""Where runs come from: commits, machines, steps and cost, as their run.json says."""

from collections import Counter

_COUNTED = {"commits": "commit", "machines": "machine", "versions": "versions", "stepFractions": "step [t0]"}


def provenance(runs):
    """Dict of what made the runs (RunFolder): runs, commits, machines, versions (each {text: number of runs}),
    stepFractions [t0] ({value: number}), steps (their sum, as if there were no shorter ones) and hours (of wall time)."""
    records = [run.record for run in runs]
    return {
        "runs": len(runs),
        "commits": _count(_commit(r) for r in records),
        "machines": _count(_machine(r.get("hardware") or {}) for r in records),
        "versions": _count(", ".join(f"{k} {v}" for k, v in (r.get("versions") or {}).items()) for r in records),
        "stepFractions": _count(_step(run.parameters) for run in runs),
        "steps": sum(int(run.derived.get("steps") or 0) for run in runs),
        "hours": round(sum(float(r.get("wallTime") or 0.0) for r in records) / 3600.0, 2),
    }


def joined(origins):
    """Dict like provenance's of all the runs of several such dicts."""
    origins = list(origins)
    counts = {key: dict(sum((Counter(o[key]) for o in origins), Counter()).most_common()) for key in _COUNTED}
    steps, hours = sum(o["steps"] for o in origins), round(sum(o["hours"] for o in origins), 2)
    return {"runs": sum(o["runs"] for o in origins), **counts, "steps": steps, "hours": hours}


def provenance_lines(origin):
    """The same as lines of text."""
    made = sum(origin["commits"].values())
    more = "" if made == origin["runs"] else f" (with those that others replaced {made}, of which is what follows)"
    yield f"{origin['runs']} runs{more}, {origin['steps']} steps, {origin['hours']:g} h of run time"
    for key, text in _COUNTED.items():
        yield f"{text}: " + "; ".join(f"{name} ({number} runs)" for name, number in origin[key].items())


def _commit(record):
    """Twelve digits, and '-changed' where its files were others."""
    commit, *changed = str(record.get("commit", "unknown")).split("-", 1)
    return "-".join([commit[:12], *changed])


def _count(texts):
    return dict(Counter(texts).most_common())


def _step(parameters):
    step, shorter = str(parameters.get("stepFraction", "unknown")), parameters.get("impactStepFraction")
    return step if shorter is None else f"{step} (impact: {shorter})"


def _machine(hardware):
    return f"{hardware.get('cpu') or 'unknown processor'}, {hardware.get('cores', '?')} cores"
