"""The parameters of a collision: one list of fields, from which defaults, checks and the help text follow."""

import math
from dataclasses import dataclass
from typing import Any, Callable

from yade_scripts import step_choice
from yade_scripts.aggregates import bcca_radius
from yade_scripts.materials import MATERIALS, equilibrium_overlap
from yade_scripts.packings import grain_number, maximum_filling
from yade_scripts.step_choice import AUTO

# Velocity Verlet is stable at 0.4 t0 and blows up at 0.5 t0 on A24's scene, without drag (measured).
STABLE_STEP = 0.4
SAFETY = STABLE_STEP / 0.5
# A24 follows aggregates of 80 grain radii for 1000 ns: 12.5 ns per grain radius, in units of ice's t0.
DURATION_PER_RADIUS = 64.6
MOST_GRAINS = 5_000_000
MOST_BCCA_GRAINS = 100_000
LARGEST_NECK = 0.7  # the largest of S17
FUSED_THREADS = 2  # JKRWadaEngine's domains
TOLERANCE, TOLERANCES = 1e-4, (1e-7, 1e-2)  # with stepFraction=auto: default, and what is allowed


class ParameterError(ValueError):
    """A wrong parameter; the message is one line: what, where, what is allowed."""


@dataclass(frozen=True)
class Field:
    """One column of a table. kind: float, int or str; default None: worked out from the others.

    word: a text that a number's column may hold as well.
    """

    name: str
    kind: type
    default: Any
    unit: str
    allowed: str
    accepts: Callable[[Any], bool]
    meaning: str
    word: str = None


def _one_of(names):
    return ", ".join(names), lambda value: value in names


FIELDS = [
    Field(
        "packing",
        str,
        "cpe",
        "",
        *_one_of(["cpe", "bcca"]),
        "how the aggregates are made: close-packed and extracted, or cluster-cluster aggregation",
    ),
    Field(
        "filling",
        float,
        None,
        "1",
        "> 0 and at most what the lattice holds",
        lambda x: x > 0,
        "filling factor N (r/R)^3 of a cpe aggregate, N (r/R)^2 of a planar one (0.4 if not given)",
    ),
    Field(
        "radius",
        float,
        None,
        "grain radii",
        "> 0",
        lambda x: x > 0,
        "radius of a cpe aggregate (20 if grains is not given either)",
    ),
    Field(
        "grains",
        int,
        None,
        "",
        f"2 to {MOST_GRAINS}",
        lambda n: 2 <= n <= MOST_GRAINS,
        "grains per aggregate, instead of radius (bcca: 1024 if not given)",
    ),
    Field("velocity", float, 10**0.5, "m/s", "> 0", lambda x: x > 0, "relative velocity of the aggregates"),
    Field(
        "impact",
        float,
        0.0,
        "1",
        "0 to 1",
        lambda x: 0 <= x <= 1,
        "impact parameter B_off in units of the sum of the radii (A22 eq 27)",
    ),
    Field("viscoelasticTime", float, 0.0, "s", ">= 0", lambda x: x >= 0, "T_vis of the viscous drag (A22 eq 7)"),
    Field(
        "neck",
        float,
        0.0,
        "1",
        f"0, or above that of a contact that is not sintered (ice: 0.1237) and at most {LARGEST_NECK}",
        lambda x: 0 <= x <= LARGEST_NECK,
        "neck radius over grain radius of the sintered bonds that the aggregates start with; 0: no bonds (S17)",
    ),
    Field("planar", int, 0, "", "0 or 1", lambda n: n in (0, 1), "1: grains confined to a plane"),
    Field("material", str, "ice", "", *_one_of(list(MATERIALS)), "what the grains are made of"),
    Field("seed", int, 1, "", ">= 0", lambda n: n >= 0, "of the random packings"),
    Field(
        "duration",
        float,
        None,
        "s",
        "> 0",
        lambda x: x > 0,
        "time that is simulated (64.6 t0 per grain radius of R: 12.5 ns for ice)",
    ),
    Field(
        "stepFraction",
        float,
        0.1,
        "t0",
        f"> 0 and <= {STABLE_STEP}, less in dense packings and with drag, or {AUTO}",
        lambda x: 0 < x <= STABLE_STEP,
        f"time step; {AUTO}: the longest that keeps to tolerance",
        word=AUTO,
    ),
    Field(
        "tolerance",
        float,
        None,
        "K(0)",
        "{:g} to {:g}, with stepFraction=auto only".format(*TOLERANCES),
        lambda x: TOLERANCES[0] <= x <= TOLERANCES[1],
        f"largest error of the ledger, with stepFraction={AUTO} ({TOLERANCE:g})",
    ),
    Field(
        "engine",
        str,
        "fused",
        "",
        *_one_of(["fused", "functors"]),
        "JKRWadaEngine, or YADE's own loop (the reference, much slower)",
    ),
    Field(
        "threads",
        int,
        None,
        "",
        ">= 1",
        lambda n: n >= 1,
        "threads: 1 or 2 for the fused engine; those that yade -j or yade-batch set for the functors",
    ),
    Field(
        "out",
        str,
        None,
        "",
        "a folder that can be written",
        lambda text: text != "",
        "run folder (runs/<description of the row, or a name made from the parameters>)",
    ),
    Field("overwrite", int, 0, "", "0 or 1", lambda n: n in (0, 1), "1: replace a run that has ended"),
    Field(
        "resume",
        int,
        0,
        "",
        "0 or 1",
        lambda n: n in (0, 1),
        "1: go on from the run folder's checkpoint, if there is one",
    ),
    Field("checkpointInterval", float, 300.0, "s", "> 0", lambda x: x > 0, "wall time between checkpoints"),
]
BY_NAME = {field.name: field for field in FIELDS}


def help_text():
    """A line per parameter: name, default, unit, meaning, what is allowed."""
    lines = ["parameters (name=value, or the columns of a table):"]
    for field in FIELDS:
        default = (
            "" if field.default is None else f" = {field.default:g}" if field.kind is float else f" = {field.default}"
        )
        unit = f" [{field.unit}]" if field.unit else ""
        lines.append(f"  {field.name}{default}{unit}: {field.meaning}; allowed: {field.allowed}")
    return "\n".join(lines)


def parse(texts, description=None):
    """Parameters {name: value}, every field by its name, from texts {name: text or number}.

    Numbers may be written as arithmetic (10**0.5), text with or without quotes. radius and grains are both
    filled in, and tolerance if stepFraction is AUTO, otherwise it is None. duration and threads stay None until
    complete() unless they are given, and stepFraction stays AUTO. Raises ParameterError with one line that says
    what is wrong and what is allowed.
    """
    values = {field.name: field.default for field in FIELDS}
    for name, text in texts.items():
        if name not in BY_NAME:
            raise ParameterError(f'{name}: unknown parameter; allowed: {", ".join(BY_NAME)}')
        values[name] = _value(BY_NAME[name], text)
    if values["radius"] is not None and values["grains"] is not None:
        raise ParameterError(
            "radius and grains: both given; allowed: one of the two, the other follows from " "filling"
        )
    _fill_in_size(values)
    _fill_in_tolerance(values)
    if values["out"] is None:
        values["out"] = "runs/" + _file_name(description or _name_from(texts, values))
    return values


def complete(values, constants, threads):
    """The same, with what depends on the contact (the plugin's pairConstants) and on YADE's threads."""
    _require_sintered(values["neck"], constants)
    limit = step_limit(constants, _filling_as_stiff(values, constants))
    if values["stepFraction"] == AUTO:
        values = dict(values, stepFraction=_chosen_step(values, constants, limit))
    if values["stepFraction"] > limit:
        what = "neck, filling and drag" if values["neck"] else "filling and drag"
        raise ParameterError(
            f'stepFraction = {values["stepFraction"]:g}: unstable at this {what}; ' f'allowed: at most {limit:.3g} (t0)'
        )
    if values["engine"] == "fused":
        threads = values["threads"] or min(threads, FUSED_THREADS)
        if threads > FUSED_THREADS:
            raise ParameterError(
                f"threads = {threads}: more than the fused engine has domains; allowed: 1 to " f"{FUSED_THREADS}"
            )
    elif values["threads"] not in (None, threads):
        raise ParameterError(
            f'threads = {values["threads"]}: YADE was started with {threads}; allowed: '
            'the same (yade -jN, or the column !OMP_NUM_THREADS of a table)'
        )
    values = dict(values, threads=threads)
    if values["duration"] is None:
        values["duration"] = DURATION_PER_RADIUS * values["radius"] * constants["timeUnit"]
    return values


def step_chosen(values, constants):
    """How complete() came to values['stepFraction'], in one line."""
    if values["tolerance"] is None:
        return "as given"
    return step_choice.reason(values, constants, step_limit(constants, _filling_as_stiff(values, constants)))


def _require_sintered(neck, constants):
    unsintered = constants["equilibriumContactRadius"] / (2 * constants["reducedRadius"])
    if 0 < neck <= unsintered:
        raise ParameterError(
            f"neck = {neck:g}: no thicker than a contact that is not sintered; allowed: 0 (not "
            f"sintered), or above {unsintered:.4g} and at most {LARGEST_NECK}"
        )


def step_limit(constants, filling):
    """Largest stepFraction that is allowed; constants: as scene.pair_constants() gives them.

    filling: of a CPE packing, or of one as stiff against turning.

    SAFETY times the step at which the first of two vibrations of a CPE packing grows, each an estimate that
    was compared with runs. All grains turning in phase, against 12 p sliding springs each (p the filling
    relative to the full lattice's): w^2 = 40 p k_s/m, unstable from w dt = 2 on; runs blew up between 0.45
    and 0.5 t0 at filling 0.4, 0.4 and 0.45 at 0.6, 0.35 and 0.4 at 0.74. A grain moving against eight of
    twelve neighbours, each contact at 45 degrees to the motion: w^2 = 8 (k_n + k_s)/m with the drag 8 c/m,
    taken with the velocity extrapolated from the last two half steps: unstable from w^2 dt^2 + 4 (8 c/m) dt =
    4 on; runs with T_vis = 6 ps blew up between 0.25 and 0.3 t0 at filling 0.74.

    Bonds vibrate likewise, with k_ss and k_st for k_n and k_s. At necks of 0.2, 0.5 and 0.7 noise broke them from
    0.15, 0.17 and 0.18 t0 on at filling 0.4 and in a planar packing of filling 0.8, from 0.14, 0.15 and 0.16 at
    0.7, and from 0.21, 0.23 and 0.24 in BCCA.
    """
    mass, contact_radius = 2 * constants["reducedMass"], constants["equilibriumContactRadius"]
    normal_stiffness = 1.2 * constants["pullOffForce"] / constants["equilibriumOverlap"]  # A24 eq 38
    sliding_stiffness = constants["slidingStiffness"]
    lattice = maximum_filling(2 * constants["reducedRadius"], constants["equilibriumOverlap"])
    share = min(1.0, filling / lattice)
    turning = 2 / math.sqrt(40 * share * sliding_stiffness / mass)
    drag = 4 * 8 * (constants["dragPerContactRadius"] * contact_radius + constants["linearDrag"]) / mass
    stiffness = 8 * (normal_stiffness + sliding_stiffness) / mass
    moving = 8 / (drag + math.sqrt(drag**2 + 16 * stiffness))
    steps = [turning, moving]
    if constants.get("bond"):
        bond = constants["bond"]
        steps += [
            2 / math.sqrt(40 * share * bond["slidingStiffness"] / mass),
            2 / math.sqrt(8 * (bond["normalStiffness"] + bond["slidingStiffness"]) / mass),
        ]
    return min(STABLE_STEP, SAFETY * min(steps) / constants["timeUnit"])


def _filling_as_stiff(values, constants):
    """Filling factor of the CPE packing whose grains meet as much resistance when all turn in phase.

    Of 12 contacts of a site in space two thirds resist, of 6 in a plane all (share 3/4); of a BCCA aggregate
    four are taken (share 1/2), which is more than most grains have.
    """
    radius, overlap = 2 * constants["reducedRadius"], constants["equilibriumOverlap"]
    full = maximum_filling(radius, overlap)
    if values["packing"] == "bcca":
        return 0.5 * full
    if values["planar"]:
        return 0.75 * full * values["filling"] / maximum_filling(radius, overlap, True)
    return values["filling"]


def _chosen_step(values, constants, limit):
    if values["packing"] != "cpe" or values["planar"] or values["neck"]:
        raise ParameterError(
            "stepFraction = auto: measured for cpe aggregates in space without necks only; allowed "
            "here: a number (t0)"
        )
    try:
        return step_choice.choose(values, constants, limit)
    except step_choice.ToleranceTooTight as problem:
        raise ParameterError(str(problem)) from None


def _value(field, text):
    if field.word is not None and _text(text) == field.word:
        return field.word
    value = _text(text) if field.kind is str else _number(field, text)
    if not field.accepts(value):
        raise ParameterError(f"{field.name} = {text}: not allowed; allowed: {field.allowed}{_unit(field)}")
    return value


def _unit(field):
    return f" [{field.unit}]" if field.unit and field.unit != "1" else ""


def _text(text):
    text = str(text).strip()
    return text[1:-1] if len(text) >= 2 and text[0] in "'\"" and text[-1] == text[0] else text


def _number(field, text):
    """A finite number from a number, or from arithmetic with the names of math as in YADE's own tables."""
    try:
        value = eval(_text(text), {"__builtins__": {}}, vars(math)) if isinstance(text, str) else text
        number = float(value) if isinstance(value, (int, float)) else None
    except Exception:  # whatever a typing error in an expression may raise
        number = None
    kind = "a whole number" if field.kind is int else "a finite number"
    if number is None or not math.isfinite(number) or (field.kind is int and number != int(number)):
        raise ParameterError(f"{field.name} = {text}: not {kind}; allowed: {field.allowed}{_unit(field)}")
    return field.kind(value)


def _fill_in_tolerance(values):
    if values["stepFraction"] == AUTO:
        values["tolerance"] = TOLERANCE if values["tolerance"] is None else values["tolerance"]
    elif values["tolerance"] is not None:
        raise ParameterError(
            f'tolerance = {values["tolerance"]:g}: given with stepFraction = '
            f'{values["stepFraction"]:g}; allowed: with stepFraction={AUTO} only'
        )


def _fill_in_size(values):
    if values["packing"] == "bcca":
        _fill_in_bcca(values)
        return
    dimensions = 2 if values["planar"] else 3
    if values["filling"] is None:
        values["filling"] = 0.4
    if values["grains"] is not None:
        values["radius"] = (values["grains"] / values["filling"]) ** (1 / dimensions)
        return
    if values["radius"] is None:
        values["radius"] = 20.0
    try:
        grains = grain_number(values["filling"], values["radius"], bool(values["planar"]))
    except OverflowError:
        grains = math.inf
    if not 2 <= grains <= MOST_GRAINS:
        at_least, at_most = ((n / values["filling"]) ** (1 / dimensions) for n in (2, MOST_GRAINS))
        raise ParameterError(
            f'radius = {values["radius"]:g}: {grains:g} grains at filling '
            f'{values["filling"]:g}; allowed: about {at_least:.3g} to {at_most:.3g} '
            f'[grain radii], for 2 to {MOST_GRAINS} grains'
        )
    values["grains"] = grains


def _fill_in_bcca(values):
    """Radius and filling factor follow from the aggregates, which are made for that."""
    for name in ("filling", "radius"):
        if values[name] is not None:
            raise ParameterError(f"{name} = {values[name]:g}: given with packing = bcca; allowed: grains only")
    if values["grains"] is None:
        values["grains"] = 1024
    if values["grains"] > MOST_BCCA_GRAINS:
        raise ParameterError(
            f'grains = {values["grains"]}: more than bcca makes in a minute; allowed: 2 to ' f'{MOST_BCCA_GRAINS}'
        )
    material = MATERIALS[values["material"]]
    values["radius"] = bcca_radius(
        values["grains"], equilibrium_overlap(material) / material.grainRadius, values["seed"], values["planar"]
    )
    values["filling"] = values["grains"] / values["radius"] ** (2 if values["planar"] else 3)


def _name_from(texts, values):
    """collide-ice-f0.4-R20-v3.162-s1, and whatever else was given."""
    in_name = ["material", "packing", "filling", "radius", "grains", "velocity", "seed"]
    size = "bcca-N{grains}" if values["packing"] == "bcca" else "f{filling:g}-R{radius:.4g}"
    name = ("collide-{material}-" + size + "-v{velocity:.4g}-s{seed}").format(**values)
    left_out = in_name + ["out", "overwrite", "resume", "checkpointInterval", "threads"]
    return name + "".join(f"-{key}{values[key]}" for key in sorted(texts) if key not in left_out)


def _file_name(text):
    """text as the name of one folder."""
    allowed = "-_.,=+"
    return "".join(c if c.isalnum() or c in allowed else "_" for c in text).lstrip(".")[:200] or "run"
