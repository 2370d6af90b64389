"""The run folder's format, once: what is in run.json, history.npz and states/NNNNNN.npz, with units and shapes.

Scripts write what stands here and the analysis reads it. All quantities are in SI units. A folder holds

    run.json            parameters, derived constants, versions, commit, seed, hardware, wall time, time
                        reached, status (running, completed, interrupted, failed: why), outcome of a completed
                        collision, what ended a compression (endedBy)
    history.npz         time series, arrays (T,)
    states/NNNNNN.npz   the grains and their contacts at one moment: N grains, M contacts, P planes, K contacts with
                        planes
    ended               the run came to its planned end; the SHA-256 of the files above, as sha256sum prints them
    checkpoint/         while the run is under way, or was stopped: not part of the format
    lock                while the run is under way: on which machine (lock.py); not part of the format

`ended` is written last, when all the rest is on the disk, so that there is none without sums. It is what sha256sum
prints, and `sha256sum -c ended` checks it. Files that others put into the folder are not in it.

Format 1 had no `kind` in run.json (every run was a collision), no `boundaryWork` and `constraintWork` in the history
and no `cell_size` in states. Format 2 has them. Format 3 has `externalWork` as well. Until then
`ended` was empty; format 4 has the sums, and in lines that begin with # sums of archives' ends. Until format 5
the status stood under `outcome`. Format 7 has `springDamping` in the history.
"""

from dataclasses import dataclass
from math import isclose

FORMAT = 7
READABLE = (1, 2, 3, 4, 5, 6, 7)
SEALED = 4  # the first that has sums

RUN_FILE, HISTORY_FILE, ENDED_FILE = "run.json", "history.npz", "ended"
STATES_FOLDER, CHECKPOINT_FOLDER = "states", "checkpoint"
LOCK_FILE = "lock"


def state_file(number):
    """Name of the file of state `number`, counted from 0."""
    return f"{number:06d}.npz"


@dataclass(frozen=True)
class Channel:
    """An energy channel [J]; the sum of all is constant in time.

    kind: STORED (held now), LOST (dissipated since the start) or WORK (done since the start against what holds or
    moves the grains). colour: in figures. since: the first format that has it; in older folders it is zero."""

    name: str
    kind: str
    label: str
    colour: str
    since: int = 1


STORED, LOST, WORK = "stored", "lost", "work"

# In the order used everywhere. The plugin's list is contact_law/kernel/energy_channels.hpp; a test compares the two.
# Stored energies in cool colours, dissipation in warm ones, with one order of hues for sliding, rolling, twisting.
CHANNEL_TABLE = (
    Channel("kinetic", STORED, "kinetic", "#9aa5b1"),
    Channel("normal", STORED, "normal (JKR potential)", "#1f5fa8"),
    Channel("sliding", STORED, "sliding, stored", "#57b8d9"),
    Channel("rolling", STORED, "rolling, stored", "#1b8a8f"),
    Channel("twisting", STORED, "twisting, stored", "#7fd1ae"),
    Channel("slidingDissipation", LOST, "sliding dissipation", "#f2b134"),
    Channel("rollingDissipation", LOST, "rolling dissipation", "#d7301f"),
    Channel("twistingDissipation", LOST, "twisting dissipation", "#fc8d59"),
    Channel("connection", LOST, "connection", "#8c4a9e"),
    Channel("disconnection", LOST, "disconnection", "#d094d8"),
    Channel("drag", LOST, "drag", "#7a5230"),
    Channel("springDamping", LOST, "damping of springs", "#c79a6b", since=7),
    Channel("bondBreaking", LOST, "bond breaking", "#3b2a20"),
    Channel("boundaryWork", WORK, "work on the boundaries", "#4d4d4d", since=2),
    Channel("constraintWork", WORK, "work on constraints", "#b3b3b3", since=2),
    Channel("externalWork", WORK, "work against outside forces", "#d9d9d9", since=3),
)
CHANNELS = tuple(channel.name for channel in CHANNEL_TABLE)
STORED_CHANNELS = tuple(channel.name for channel in CHANNEL_TABLE if channel.kind == STORED)
LOST_CHANNELS = tuple(channel.name for channel in CHANNEL_TABLE if channel.kind == LOST)
LABELS = {channel.name: channel.label for channel in CHANNEL_TABLE}
COLOURS = {channel.name: channel.colour for channel in CHANNEL_TABLE}


@dataclass(frozen=True)
class Quantity:
    """An array of a history or a state.

    shape: of "T", "N", "M", "P", "K" (samples, grains, contacts, planes, contacts with these) and numbers; kind:
    numpy's letter of the type, "f", "i" or "b"; optional: left out where the scene has none; gaps: may be NaN in
    places; positive: all values are > 0; since: the first format that has it, zeros stand for it in older folders."""

    name: str
    shape: tuple
    unit: str
    meaning: str
    kind: str = "f"
    optional: bool = False
    gaps: bool = False
    since: int = 1
    positive: bool = False


@dataclass(frozen=True)
class RunKind:
    """A kind of run, by the `kind` of run.json: what its history holds beside what every run has, and how many
    aggregates there are (their numbers are 0, 1, ...; None: any number)."""

    name: str
    series: tuple
    aggregates: int | None = None

    @property
    def history(self):
        """Quantities of history.npz, in the order of its columns: time, the channels, the contacts, broken bonds by
        mode (where there were bonds at the start), the kind's own."""
        channels = (Quantity(c.name, ("T",), "J", c.label, since=c.since) for c in CHANNEL_TABLE)
        return (TIME_SERIES, *channels, CONTACTS, *BONDS, *self.series)


TIME_SERIES = Quantity("time", ("T",), "s", "time, rising")
CONTACTS = Quantity("contacts", ("T",), "", "number of contacts", "i")

# Sintered bonds that have broken since the start, by mode: names in the history, and their order in a state.
BROKEN_BONDS = ("brokenByStretching", "brokenBySliding", "brokenByRolling", "brokenByTwisting")
BONDS = tuple(
    Quantity(name, ("T",), "", "sintered bonds broken since the start", "i", optional=True) for name in BROKEN_BONDS
)

STATE = (
    Quantity("time", (), "s", "time"),
    Quantity("position", ("N", 3), "m", "positions; unwrapped in a periodic cell"),
    Quantity("velocity", ("N", 3), "m/s", "velocities"),
    Quantity("angular_velocity", ("N", 3), "rad/s", "angular velocities"),
    Quantity("radius", ("N",), "m", "radii, of sintered grains those before they shrank", positive=True),
    Quantity("aggregate", ("N",), "", "number of the aggregate that a grain belongs to at the start", "i"),
    Quantity("material", ("N",), "", "of several, which of derived `materials` in run.json", "i", optional=True),
    Quantity("mass", ("N",), "kg", "of grains of several materials", optional=True, positive=True),
    Quantity("contact_pairs", ("M", 2), "", "rows of the two grains of a contact", "i"),
    Quantity("contact_normal_force", ("M",), "N", "normal force, elastic and viscous, positive when repulsive"),
    Quantity("contact_bonded", ("M",), "", "whether a contact is a sintered bond", "b"),
    Quantity("contact_neck", ("M",), "1", "of a bond: the neck's radius over the grains'; else 0", optional=True),
    Quantity("bonds_broken", (4,), "", "sintered bonds broken since the start, as BROKEN_BONDS", "i", optional=True),
    Quantity("plane_axis", ("P",), "", "of each plane, the axis across which it lies: 0, 1, 2", "i", optional=True),
    Quantity("plane_position", ("P",), "m", "of each plane, where on that axis", optional=True),
    Quantity("plane_contacts", ("K", 2), "", "rows of the grain and of the plane of a contact", "i", optional=True),
    Quantity("plane_contact_normal_force", ("K",), "N", "as contact_normal_force", optional=True),
    Quantity("cell_size", (3,), "m", "edges of the periodic cell", optional=True, positive=True),
    Quantity("cell_vectors", (3, 3), "m", "of a sheared cell, its edges as columns", optional=True),
)

# Of a collision on a plate, d is the aggregate's radius less its mean distance.
RESTING = "resting"
COLLISION = RunKind(
    "collision",
    (
        Quantity("d", ("T",), "m", "compression length (A24 eqs 10, 11); NaN with all grains on one side", gaps=True),
        Quantity("v", ("T",), "m/s", "mutual velocity (A24 eqs 12, 13), positive while approaching", gaps=True),
        Quantity("contacts_between", ("T",), "", "contacts between the aggregates, or with the plate", "i"),
        Quantity("formed", ("T",), "", "contacts formed since the start (A22 N_con)", "i", optional=True),
        Quantity("broken", ("T",), "", "contacts broken since the start (A22 N_cut)", "i", optional=True),
        Quantity(RESTING, ("T",), "", "1: no piece can change any more, NaN: not looked at", optional=True, gaps=True),
    ),
    aggregates=2,
)

# Between the plates of a piston, filling, pressures and edges are of the space between them.
COMPRESSION = RunKind(
    "compression",
    (
        Quantity("filling", ("T",), "1", "volume filling factor of the cell (K13 eq 22)"),
        Quantity("pressure", ("T",), "Pa", "by the virial (K13 eq 21), or mean force on the plates over their area"),
        Quantity("kinetic_pressure", ("T",), "Pa", "the part of it that is kinetic, 2 K/(3 V); 0 between plates"),
        Quantity("piston_pressure", ("T",), "Pa", "between plates: that on the moving one", optional=True),
        Quantity("coordination", ("T",), "1", "mean number of contacts of a grain"),
        *(Quantity(f"edge_{axis}", ("T",), "m", f"edge of the cell along {axis}") for axis in "xyz"),
    ),
    aggregates=1,
)

# The kinds that come with the package. A script may have a kind of its own: the analysis then reads what every run has,
# and its series as they are.
RUN_KINDS = {kind.name: kind for kind in (COLLISION, COMPRESSION)}

# Parameters in run.json that are words. A test compares the list with the scripts' own, as below.
PARAMETER_WORDS = tuple(
    "packing file projectileFile sizes sizesFile target boundary stretch material materials layout engine limit "
    "spinAxis projectileSpinAxis".split()
)

# Units of the parameters in run.json ("1": a ratio) that aren't numbers of things or words; those of scripts of one's
# own are theirs. A test compares the list with the scripts' own.
_BY_UNIT = {
    "m/s": "velocity",
    "rad/s": "spin projectileSpin",
    "deg": "impactAngle",
    "m": "grainRadius criticalRolling smallest largest",
    "s": "duration viscoelasticTime springDamping checkpointInterval",
    "t0": "stepFraction impactStepFraction",
    "1/t0": "strainRate",
    "Pa": "young finalPressure",
    "kg/m^3": "density",
    "J/m^2": "surfaceEnergy",
    "grain radii": "radius",
    "of that at rest": "initialOverlap",
    "1": "impact neck filling initialFilling finalFilling stretchFilling sizeRatio sizeFraction sizeSpread "
    "sizeExponent materialFraction poisson tolerance slidingStiffnessFactor "
    "rollingStiffnessFactor mixedSurfaceEnergyFactor linearDamping",
}
PARAMETER_UNITS = {name: unit for unit, names in _BY_UNIT.items() for name in names.split()}

SAME = 1e-9  # relative: two numbers that agree so far are one value of a parameter


def same(one, other):
    """Whether two values of a parameter are the same: numbers that agree to SAME, and anything else that is equal."""
    numbers = isinstance(one, (int, float)) and isinstance(other, (int, float))
    return one == other or (numbers and isclose(one, other, rel_tol=SAME))


def value_text(value):
    """A value of a parameter with the digits that tell it from others, for names of folders and for groups.

    >>> value_text(10**0.5), value_text(3.0), value_text("ice")
    ('3.16227766', '3', 'ice')
    """
    return f"{value:.10g}" if isinstance(value, float) else str(value)
