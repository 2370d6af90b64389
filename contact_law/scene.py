"""The running scene: its arrays, its sintering, and YADE's own calls in scenes that JKRWadaEngine moves."""

import functools
import threading
from numbers import Real

import numpy as np

ROWS = {
    "ids": (np.int32, ()),
    "position": (float, (3,)),
    "velocity": (float, (3,)),
    "angular_velocity": (float, (3,)),
    "radius": (float, ()),
    "contact_pairs": (np.int32, (2,)),
    "contact_normal_force": (float, ()),
    "contact_neck": (float, ()),
    "plane_axis": (np.int32, ()),
    "plane_position": (float, ()),
    "plane_contacts": (np.int32, (2,)),
    "plane_contact_normal_force": (float, ()),
    "cell_size": (float, ()),
}
material_changes = 0  # number of calls of set_material()


def snapshot():
    """Everything about the grains and their contacts at one moment.

    Call it from a PyRunner that stands last among O.engines. NewtonIntegrator keeps velocities half a step apart from
    positions and has moved the grains on by then; the arrays are of the moment of the forces, as O.energy is.

    Returns
    -------
    dict
        In SI units. `time` [s]. Of the N grains, in the order of body ids: `ids` (N,), `position` (N, 3) (unwrapped in
        a periodic cell), `velocity` (N, 3), `angular_velocity` (N, 3), `radius` (N,) (before sintering). Of the M
        contacts: `contact_pairs` (M, 2) (row numbers; a periodic cell's are of the nearest images),
        `contact_normal_force` (M,) (elastic and viscous, positive when repulsive), `contact_neck` (M,) (of bonds, the
        neck's radius over that of the grains; others 0), `contact_bonded` (M,) bool. With planes (Walls), in the order
        of body ids: `plane_axis` (P,) (0, 1, 2), `plane_position` (P,) along that axis, `plane_contacts` (K, 2) (row of
        the grain, row of the plane), `plane_contact_normal_force` (K,). In a periodic scene: `cell_size` (3,).

    Raises
    ------
    RuntimeError
        While O.run() is under way (but for PyRunners), and when JKRWadaEngine's grains are not the scene's bodies.
    """
    from yade.wrapper import JKRWadaSnapshot

    raw = JKRWadaSnapshot().read()
    arrays = {
        name: np.frombuffer(raw[name], dtype=kind).reshape(-1, *shape)
        for name, (kind, shape) in ROWS.items()
        if name in raw
    }
    return {"time": raw["time"], **arrays, "contact_bonded": arrays["contact_neck"] > 0}


def sinter(neck):
    """Make every contact of the running scene a sintered bond (Sirono & Ueno 2017), whoever moves the grains.

    Bonds are without strain where the grains are now; with the functors from the next O.step on. Existing bonds keep
    their own neck. All grains shrink by the volume of two of the largest necks, as ordinary contacts have them. What
    the contacts held is booked as disconnection (MODEL.md, "Sintering a running scene").

    Parameters
    ----------
    neck : float
        The necks' radius over that of the grains (unlike grains: over 2 r1 r2/(r1 + r2)), up to 0.7.

    Raises
    ------
    ValueError, RuntimeError
        For a neck out of range, a time step too long for the bonds, a scene without the contact law, and while
        O.run() is under way (but for PyRunners).
    """
    _law("sinter()").sinter(neck)


def set_material(material, **properties):
    """Change a material of the running scene, and every contact of it, whoever moves the grains.

    Contacts have their new constants where the grains are now; with the functors from the next O.step on. What that
    changes of the energy that they hold is booked as constraintWork (MODEL.md, "Materials that change"). Masses stay.

    Parameters
    ----------
    material : JKRMat, int or str
        The object that bodies share, or its index or label in O.materials.
    **properties
        `young`, `poisson`, `surfaceEnergy`, `criticalRolling`, `viscoelasticTime`, as of a JKRMat.

    Raises
    ------
    ValueError, RuntimeError
        For a property out of range, no number or none of these; a time step too long for the new contacts (functors: in
        the next O.step); a scene without the contact law; and while O.run() is under way (but for PyRunners).
    """
    from yade.wrapper import JKRMat, Omega

    global material_changes
    if not isinstance(material, JKRMat):
        material = Omega().materials[material]
    names = ("young", "poisson", "surfaceEnergy", "criticalRolling", "viscoelasticTime")
    wanted = {name: getattr(material, name) for name in ("density", *names)}
    for name, value in properties.items():
        if name not in names:
            raise ValueError(f"set_material(): {name}: must be one of {', '.join(names)}")
        if not isinstance(value, Real):
            raise ValueError(f"set_material(): {name} = {value!r}: must be a number")
        wanted[name] = float(value)
    _law("set_material()").setMaterial(material, JKRMat(**wanted))
    material_changes += 1


def _law(call):
    """The engine or the functor that has the contacts' constants."""
    from yade.wrapper import Ip2_JKRMat_JKRMat_JKRWadaPhys, JKRWadaEngine, Omega

    for engine in Omega().engines:
        if engine.dead:
            continue
        if isinstance(engine, JKRWadaEngine):
            return engine
        dispatcher = getattr(engine, "physDispatcher", None)
        for functor in dispatcher.functors if dispatcher else ():
            if isinstance(functor, Ip2_JKRMat_JKRMat_JKRWadaPhys):
                return functor
    raise RuntimeError(f"{call}: O.engines must have a JKRWadaEngine, or an InteractionLoop with this contact law")


def record(
    folder, every, series=None, states=10, parameters=None, aggregate=None, interval=300, overwrite=False, resume=False
):
    """Write a run folder while the script goes on, as collide.py does: for `python3 -m analysis` and analysis.table().

    It comes after O.bodies and O.engines, and turns O.trackEnergy on. The run ends with the script. One that was
    stopped (Ctrl-C, SIGTERM, kill) goes on with resume=True, the fused engine to the same bits, YADE's own loop to
    rounding: the script builds its scene again, record() puts that of the last checkpoint in its place (with new
    objects: O.bodies[0], O.engines[1]), and the script goes on from O.iter, as by O.run(10000 - O.iter, True).

    Parameters
    ----------
    folder : str
        A new folder.
    every : int
        O.steps between two rows of the history: energies, contacts, and the script's series. With the functors a row
        is of the beginning of a step.
    series : function, optional
        Returns {name: number} for each row, always of the same names.
    states : int
        Rows between two saved states; the first and the last row have one too.
    parameters : dict, optional
        {name: number or text} by which runs are compared: columns of analysis.table().
    aggregate : function, optional
        Of a body: the number of its aggregate, from 0, by which grains are coloured.
    interval : float
        Seconds of wall time between two checkpoints.
    overwrite, resume : bool
        Whether an earlier run in the folder is replaced, or goes on where it has a checkpoint.

    Returns
    -------
    yade_scripts.run.recording.Recording
        end() ends the run before the script does; another record() does so too.

    Raises
    ------
    ValueError, TypeError, yade_scripts.parameters.InputError
        For wrong arguments, and for a folder that holds something else.
    """
    from yade_scripts.run import recorder, recording

    if isinstance(recorder.current, recording.Recording):
        recorder.current.end()
    given = folder, every, series, states, parameters, aggregate, interval, overwrite, resume
    return recording.Recording(*given)


# ---- YADE's own calls ----

# Of yade.utils: they read O.interactions or O.forces, which the fused engine leaves empty.
OF_CONTACTS = """
    avgNumInteractions bodyNumInteractionsHistogram bodyStressTensors fabricTensor forcesOnCoordPlane forcesOnPlane
    getBodyIdsContacts getStress getStressAndTangent getStressProfile getStressProfile_contact
    interactionAnglesHistogram intrsOfEachBody maxOverlapRatio normalShearStressTensors numIntrsOfEachBody
    plotDirections plotNumInteractionsHistogram stressTensorOfPeriodicCell sumForces sumTorques totalForceInVolume
    unbalancedForce
""".split()


def show_contacts(yade, main):
    """yade.utils' functions of contacts have them with the fused engine too; main: the namespace of YADE's scripts."""

    def writing_first(function):
        @functools.wraps(function, assigned=("__doc__", "__name__"))
        def call(*arguments, **named):
            for engine in yade.O.engines:
                if isinstance(engine, yade.wrapper.JKRWadaEngine) and not engine.dead:
                    engine.writeInteractions()
            return function(*arguments, **named)

        return call

    for name in OF_CONTACTS:
        function = getattr(yade.utils, name, None)
        if function is None:
            continue
        replacement = writing_first(function)
        for namespace in (vars(yade.utils), vars(yade._utils), main):
            if namespace.get(name) is function:
                namespace[name] = replacement


def give_way(yade):
    """O.engines = ... leaves no contact behind: an engine that goes gives them to those that come."""
    engines = yade.wrapper.Omega.engines

    def replace(omega, others):
        movers = [engine for engine in engines.fget(omega) if isinstance(engine, yade.wrapper.JKRWadaEngine)]
        if movers and omega.running and threading.current_thread() is threading.main_thread():
            raise RuntimeError(
                "O.engines is set while O.run() is under way: set it after O.pause() or O.wait(), or from a PyRunner"
            )
        engines.fset(omega, others)
        for engine in movers:
            engine.giveWay()

    yade.wrapper.Omega.engines = property(engines.fget, replace, doc=engines.__doc__)


def count_work_once(yade):
    """O.energy.total() leaves out coarser counts, by YADE's own engines, of work that is in the law's channels too."""
    total = yade.wrapper.EnergyTracker.total

    def counted_once(energy):
        values = dict(energy.items())
        coarser = {"velGradWork": "boundaryWork", "gravWork": "externalWork"}
        return total(energy) - sum(values.get(name, 0) for name, own in coarser.items() if values.get(own))

    yade.wrapper.EnergyTracker.total = counted_once


def restore_forces(yade):
    """O.load and the like bring permanent forces back, which YADE does not save and the engine does."""

    def restoring(load):
        @functools.wraps(load, assigned=("__doc__", "__name__"))
        def call(omega, *arguments, **named):
            load(omega, *arguments, **named)
            for engine in omega.engines:
                if isinstance(engine, yade.wrapper.JKRWadaEngine):
                    engine.restoreForces()

        return call

    for name in ("load", "loadTmp", "reload"):
        setattr(yade.wrapper.Omega, name, restoring(getattr(yade.wrapper.Omega, name)))
