"""What YADE's own calls do in scenes that JKRWadaEngine moves."""

import functools
import threading

# Of yade.utils: they read O.interactions or O.forces, which the fused engine leaves empty.
OF_CONTACTS = """
    avgNumInteractions bodyNumInteractionsHistogram bodyStressTensors fabricTensor forcesOnCoordPlane forcesOnPlane getBodyIdsContacts
    getStress getStressAndTangent getStressProfile getStressProfile_contact interactionAnglesHistogram intrsOfEachBody maxOverlapRatio
    normalShearStressTensors numIntrsOfEachBody plotDirections plotNumInteractionsHistogram stressTensorOfPeriodicCell sumForces
    sumTorques totalForceInVolume unbalancedForce
""".split()


def _writing_first(yade, function):
    """The function, before which a JKRWadaEngine writes contacts and forces to where YADE keeps them."""

    @functools.wraps(function, assigned=("__doc__", "__name__"))
    def call(*arguments, **named):
        for engine in yade.O.engines:
            if isinstance(engine, yade.wrapper.JKRWadaEngine) and not engine.dead:
                engine.writeInteractions()
        return function(*arguments, **named)

    return call


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


def show_contacts(yade, main):
    """yade.utils' functions of contacts have them with the fused engine too; main: the namespace of YADE's scripts."""
    for name in OF_CONTACTS:
        function = getattr(yade.utils, name, None)
        if function is None:
            continue
        obeying = _writing_first(yade, function)
        for namespace in (vars(yade.utils), vars(yade._utils), main):
            if namespace.get(name) is function:
                namespace[name] = obeying
