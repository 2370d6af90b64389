"""Sintering of the running scene."""


def sinter(neck):
    """Make every contact of the running scene a sintered bond (Sirono & Ueno 2017), whoever moves the grains.

    neck: the necks' radius over that of the grains (unlike grains: over 2 r1 r2/(r1 + r2)), up to 0.7. Bonds are without strain where the
    grains are now; with the functors from the next O.step on. Existing bonds keep their own neck. All grains shrink by the volume of
    two of the largest necks, as ordinary contacts see them. What the contacts held is booked as disconnection (contact_law/MODEL.md,
    "Sintering a running scene").

    ValueError or RuntimeError, with one line, for a neck out of range, a time step too long for the bonds, a scene without the contact law,
    and while O.run() is under way (but for PyRunners).
    """
    from yade.wrapper import Ip2_JKRMat_JKRMat_JKRWadaPhys, JKRWadaEngine, Omega

    for engine in Omega().engines:
        if engine.dead:
            continue
        if isinstance(engine, JKRWadaEngine):
            return engine.sinter(neck)
        dispatcher = getattr(engine, "physDispatcher", None)
        for functor in dispatcher.functors if dispatcher else ():
            if isinstance(functor, Ip2_JKRMat_JKRMat_JKRWadaPhys):
                return functor.sinter(neck)
    raise RuntimeError("sinter(): O.engines must have a JKRWadaEngine, or an InteractionLoop with this contact law")
