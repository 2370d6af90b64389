"""The scenes that are measured, as data: the papers' runs, and the bench's own. Needs no YADE.

A scene is what a run of collide.py or compress.py starts from, and the moments of that run at which codes are measured
(moments.py makes their files).
"""

from dataclasses import dataclass, field

ENGINE, BESIDE_LAMMPS = ("engine",), ("engine", "lammps")
SLOW, PEERS = ("engine-avx2", "engine-portable", "functors", "stock"), ("lammps", "liggghts")
EVERY = ("engine", "functors", "stock", "lammps", "lammps-newest", "liggghts")
FLYING = {"flying": 0.0}


@dataclass(frozen=True)
class Scene:
    """title, in words; kind: collision, compression, materials or radii (starts.py); parameters of the run, as tables have them; moments: {name: time [s]
    or filling factor}, in their order (None: the start); apart: time [s] by which the first moment of a collision is moved
    back along straight lines, for a flight long enough to measure; codes: names of codes.CODES to measure."""

    title: str
    kind: str
    parameters: dict
    moments: dict = field(default_factory=lambda: FLYING)
    apart: float = 0.0
    codes: tuple = BESIDE_LAMMPS


# ---- the papers' ----

A22 = {"packing": "bpca", "grains": 50_000, "impact": "(3/12)**0.5", "velocity": "10**1.7", "stepFraction": 0.2}
A22.update(duration="6.34e-6", viscoelasticTime="0")
OF_A22 = {"flying": 0.0, "compressing": 0.35e-6, "fragments": 0.7e-6, "later": 2e-6}
K13 = {"grains": 16_384, "strainRate": "3e-7", "stepFraction": 0.3, "finalFilling": 0.3}
DENSE = {"phi 0.03": 0.03, "phi 0.3": 0.3}
S17 = {"packing": "bcca", "grains": 1024, "planar": 1, "neck": 0.7, "velocity": 20, "stepFraction": 0.1}
OF_S17 = {"flying": 0.0, "touching": 0.5e-6, "later": 1.5e-6}
CPE = {"packing": "cpe", "filling": 0.4, "stepFraction": 0.1, "velocity": "10**0.5"}
OF_A24 = {"flying": 0.0, "compressed": 0.4e-6, "apart": 0.8e-6}
FAST = {**CPE, "radius": 20, "velocity": 60, "duration": "120e-9"}
OF_FAST, OF_CPE = {"flying": 0.0, "compressing": 30e-9, "fragments": 110e-9}, {"flying": 0.0, "compressed": 0.2e-6}
WITH_DRAG, SLOWLY = {**A22, "viscoelasticTime": "6e-12"}, {**A22, "velocity": 0.5}
PAPERS = {
    "a22": Scene("A22: two BPCA of 50,000 at 50.1 m/s, B_off 0.5", "collision", A22, OF_A22, 0.5e-6),
    "a22-drag": Scene("A22: the same, T_vis 6 ps", "collision", WITH_DRAG, OF_A22, 0.5e-6),
    "a22-slow": Scene("A22: the same grains at 0.5 m/s, T_vis 0", "collision", SLOWLY, FLYING, 0.5e-6),
    "k13": Scene("K13: BCCA of 16,384, C_v 3e-7", "compression", K13, {"phi 0.001": 0.001, **DENSE}),
    "k13-1024": Scene("K13: BCCA of 1,024, C_v 3e-7", "compression", {**K13, "grains": 1024}, {"start": None, **DENSE}),
    "s17": Scene("S17: 2 x 1,024 planar BCCA, beta 0.7, 20 m/s", "collision", S17, OF_S17, 0.3e-6),
    "a24": Scene("A24: two CPE, R 80, 3.16 m/s", "collision", {**CPE, "radius": 80}, OF_A24, 0.1e-6),
    "cpe-fast": Scene("two CPE, R 20, 60 m/s", "collision", FAST, OF_FAST, 0.2e-6),
    "cpe": Scene("two CPE, R 40, 3.16 m/s", "collision", {**CPE, "radius": 40}, OF_CPE, 0.1e-6),
}


# ---- the bench's ----


def bench(settings):
    """{name: Scene}: two CPE of each size, unlike grains, and moments through a collision."""
    found, reference = {}, settings.reference
    for radius in settings.radii:
        codes = ENGINE + SLOW * (radius in (settings.radii[0], reference)) + PEERS * (radius == reference)
        found[sized(radius)] = _two_cpe(f"two CPE, R {radius:g}", "collision", radius, codes)
    found["materials"] = _two_cpe(f"two materials, R {reference:g}", "materials", reference, ENGINE)
    found["radii"] = _two_cpe(f"two sizes of grain, 1 : 0.41, R {reference:g}", "radii", reference, ENGINE)
    for radius, speed, duration in settings.through:
        given = {**CPE, "radius": radius, "velocity": speed, "duration": duration}
        times = {f"{1e9 * duration * k / 5:.3g} ns": duration * k / 5 for k in range(1, 6)}
        title = f"two CPE, R {radius:g}, through {speed:g} m/s"
        found[f"through-{speed:g}"] = Scene(title, "collision", given, {**FLYING, **times}, 0.2e-6, ENGINE)
    return found


def beside_peers(settings):
    """The collision that all codes are measured on for the page of throughput."""
    given, moments = {**CPE, "radius": settings.rung[0]}, {**FLYING, "compressed": 0.1e-6}
    return Scene(f"two CPE, R {settings.rung[0]:g}, 3.16 m/s", "collision", given, moments, 1e-6, EVERY)


def sized(radius):
    """Name of the scene of two CPE of this radius [grain radii]."""
    return f"cpe-{radius:g}"


def _two_cpe(title, kind, radius, codes):
    # a flight that is enough to measure, and so short that a peer's bins are not mostly empty
    flight = max(0.1e-6, 1e-6 * min(1.0, (20 / radius) ** 3))
    return Scene(title, kind, {**CPE, "radius": radius}, apart=flight, codes=codes)


def all_scenes(settings):
    return {**bench(settings), **PAPERS, "peers": beside_peers(settings)}
