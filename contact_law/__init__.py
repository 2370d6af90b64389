"""Loads the plugin into the running YADE.

``import contact_law`` at the top of a script that ``yade`` runs makes JKRMat and the other classes known, as if they
were YADE's own: in ``yade.wrapper``, in ``yade``, in the script's namespace, and as attributes of this package. With
``YADE_PREFIX`` set to the overlay in build/, YADE has loaded them already, and the import only finds them.

``contact_law.commit`` is the git commit the plugin was built from, or "unknown"; ``contact_law.channels`` are the
energy channels that it books, (name, "stored", "lost" or "work") each.
"""

import ctypes
import os
import sys

from .scene import count_work_once, give_way, record, restore_forces, set_material, show_contacts, sinter, snapshot

CLASSES = [
    "JKRMat",
    "JKRWadaConstants",
    "JKRWadaBond",
    "JKRWadaPhys",
    "Ip2_JKRMat_JKRMat_JKRWadaPhys",
    "Law2_ScGeom_JKRWadaPhys_JKRWada",
    "JKRWadaEngine",
    "JKRWadaSnapshot",
]
__all__ = [*CLASSES, "snapshot", "set_material", "sinter", "record"]

TOP = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
with open(os.path.join(TOP, "analysis/VERSION")) as _file:
    __version__ = _file.read().strip()
if TOP not in sys.path:  # with YADE_PREFIX; record() needs the other packages
    sys.path.append(TOP)
LIBRARY = os.path.join(TOP, f"build/lib/{os.uname().machine}-linux-gnu/yade-double/libcontact_law.so")


def _running_yade():
    """YADE's package, if this Python is a running YADE; ImportError otherwise."""
    yade = sys.modules.get("yade")
    if not hasattr(yade, "wrapper"):
        raise ImportError("contact_law works inside YADE only: run the script with 'yade -n -x SCRIPT.py'")
    return yade


def _load(yade):
    """Open the library and take its classes to YADE; ImportError with one line if that cannot be."""
    if not os.path.exists(LIBRARY):
        raise ImportError(f"contact_law isn't built: {LIBRARY} is missing; run 'make' in {TOP}")
    with open(os.path.join(TOP, "build/yade.list")) as file:
        described = file.read().split()
    running = " ".join([yade.config.version, *yade.config.features]).split()
    if running != described:  # before anything of the library is touched
        other = " ".join(sorted(set(running) ^ set(described)))
        raise ImportError(
            f"contact_law: refusing to load: this is YADE {yade.config.version}, not {described[0]}, for which it was "
            f"compiled (they differ in {other}); run make again with this one"
        )
    try:
        # PyDLL keeps Python's lock, which the library needs. Like YADE's own libraries, it shares its symbols.
        library = ctypes.PyDLL(LIBRARY, mode=os.RTLD_NOW | os.RTLD_GLOBAL)
    except OSError as error:
        raise ImportError(f"contact_law: cannot open the plugin: {error}; run 'make' again on this machine") from None
    library.contact_law_load.restype = ctypes.c_char_p
    refusal = library.contact_law_load(" ".join(CLASSES).encode()).decode()
    if refusal or not hasattr(yade.wrapper, "JKRMat"):
        raise ImportError(f"contact_law: refusing to load: {refusal or 'it was compiled for another YADE'}")


def _rebuild_dispatchers(yade):
    """Make the engines that choose functors by class anew.

    Their tables are as long as the list of classes was when they were made; a new class would lie past the end, and
    YADE would abort. The functors stay the same objects.
    """
    dispatchers = ("InteractionLoop", "IPhysDispatcher", "LawDispatcher")

    def renewed(engine):
        name = type(engine).__name__
        if name not in dispatchers:
            return engine
        if name == "InteractionLoop":
            arguments = [engine.geomDispatcher.functors, engine.physDispatcher.functors, engine.lawDispatcher.functors]
        else:
            arguments = [engine.functors]
        new = type(engine)(*arguments)
        given = ("geomDispatcher", "physDispatcher", "lawDispatcher", "functors")
        new.updateAttrs({name: value for name, value in engine.dict().items() if name not in given})
        return new

    if any(type(engine).__name__ in dispatchers for engine in yade.O.engines):
        yade.O.engines = [renewed(engine) for engine in yade.O.engines]
    yade.utils.defaultEngines = [renewed(engine) for engine in yade.utils.defaultEngines]


def _publish(yade):
    """The classes by their names: here, in yade, and where YADE's scripts run."""
    classes = {name: getattr(yade.wrapper, name) for name in CLASSES}
    for namespace in (globals(), vars(yade), vars(sys.modules["__main__"])):
        namespace.update(classes)
    yade.__all__ += [name for name in CLASSES if name not in yade.__all__]


def _text(function):
    """What a function of the plugin that YADE has loaded returns."""
    found = getattr(ctypes.PyDLL(None), function)
    found.restype = ctypes.c_char_p
    return found().decode()


def _start():
    """Everything that importing does. Returns the commit and the energy channels."""
    yade = _running_yade()
    if not hasattr(yade.wrapper, "JKRMat"):
        _load(yade)
        _rebuild_dispatchers(yade)
    _publish(yade)
    give_way(yade)
    count_work_once(yade)
    restore_forces(yade)
    show_contacts(yade, vars(sys.modules["__main__"]))
    words = _text("contact_law_channels").split()
    return _text("contact_law_commit"), tuple(zip(words[::2], words[1::2]))


commit, channels = _start()
