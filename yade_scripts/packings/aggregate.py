"""The aggregate that a run's parameters describe."""

import warnings
from dataclasses import dataclass, replace

import numpy as np

from yade_scripts.materials import (
    GRAINS,
    HALVES,
    MIXED,
    PAIR,
    GrainParameters,
    derived_materials,
    equilibrium_overlap,
    overlaps,
)
from yade_scripts.packings.ballistic import bcca, bpca
from yade_scripts.packings.lattice import cpe, grain_number
from yade_scripts.packings.packing import (
    OF_CONTACTS,
    PackingError,
    brought_to_rest,
    centred,
    largest_piece,
    packing_from_file,
    random_stream,
)
from yade_scripts.parameters import NOT_NEGATIVE, POSITIVE, SWITCH, Check, ParameterError, between, one_of, parameter

MOST_GRAINS = 5_000_000
MOST_GROWN = {"bcca": 100_000, "bpca": 2_000_000}  # made in a minute, in minutes
GRAINS_GROWN = 1024
MADE = ("cpe", *MOST_GROWN)
EQUAL, TWO, LOGNORMAL, POWER, FILE = SIZES = ("equal", "two", "lognormal", "powerlaw", "file")
OF_SIZES = {"sizeRatio": TWO, "sizeFraction": TWO, "sizeSpread": LOGNORMAL}
OF_SIZES |= {"sizeExponent": POWER, "smallest": POWER, "largest": POWER, "sizesFile": FILE}
NAMED_PACKING = Check("a packing that make_packing.py wrote", lambda text: text != "")
UP_TO_ONE = Check("> 0 and at most 1", lambda x: 0 < x <= 1)
WIDEST = 2.5  # standard deviations of ln r at which a log-normal distribution is cut off on both sides


@dataclass(frozen=True)
class AggregateParameters(GrainParameters):
    """The aggregates. Radius and filling of a bcca, bpca or file aggregate follow when it is made."""

    packing: str = parameter(
        "cpe",
        one_of([*MADE, "file"]),
        "how they are made: close-packed and extracted, cluster-cluster or particle-cluster aggregation, from file",
    )
    filling: float | None = parameter(
        None,
        Check("> 0 and at most what the lattice holds", lambda x: x > 0),
        "filling factor N (r/R)^3 of a cpe aggregate, N (r/R)^2 of a planar one (0.4); of others it is found, with R "
        "from the centre to that of the farthest grain (largest_filling_factor of tables: R = (5/3)^(1/2) R_g)",
        "1",
    )
    radius: float | None = parameter(None, POSITIVE, "radius of a cpe aggregate (20, without grains)", "grain radii")
    grains: int | None = parameter(
        None,
        between(1, MOST_GRAINS),
        f"grains of an aggregate, instead of radius (bcca, bpca: {GRAINS_GROWN}; 1: a single grain)",
    )
    planar: int = parameter(0, SWITCH, "1: grains confined to a plane")
    file: str | None = parameter(None, NAMED_PACKING, "packing of packing = file")
    sizes: str = parameter(
        EQUAL,
        one_of(SIZES),
        "radii of grains of bcca and bpca: all grainRadius, two, log-normal, a power law, or drawn from a file",
    )
    sizeRatio: float | None = parameter(None, between(0.1, 10.0), "sizes = two: radius of the others/grainRadius", "1")
    sizeFraction: float | None = parameter(None, between(0.0, 1.0), "sizes = two: fraction of the others (0.5)", "1")
    sizeSpread: float | None = parameter(
        None,
        Check("> 0 and at most 0.7", lambda x: 0 < x <= 0.7),
        f"sizes = lognormal: standard deviation of ln r around ln grainRadius, cut off at {WIDEST:g} of it",
        "1",
    )
    sizeExponent: float | None = parameter(None, between(-10.0, 10.0), "sizes = powerlaw: n of dN/dr ~ r^n", "1")
    smallest: float | None = parameter(None, POSITIVE, "sizes = powerlaw: smallest radius", "m", usual=GRAINS)
    largest: float | None = parameter(None, POSITIVE, "sizes = powerlaw: largest radius", "m", usual=GRAINS)
    sizesFile: str | None = parameter(
        None,
        Check("a text file with a radius [m] a line", lambda text: text != ""),
        "sizes = file: radii, each grain's drawn from them; as many as grains: each once",
    )
    removeLooseGrains: int = parameter(0, SWITCH, "1: of a cpe aggregate only the largest connected piece is kept")
    initialOverlap: float = parameter(
        1.0, UP_TO_ONE, "of grains of a cpe aggregate at the start; below 1 they pull", "of that at rest"
    )
    atRest: int = parameter(
        1, SWITCH, "1: contacts are brought to rest first; 0: it is as made (cpe: at rest by itself)", before=0
    )
    seed: int = parameter(1, NOT_NEGATIVE, "of the random packings")

    ONLY_WITH = [
        *((name, "packing", ["cpe"]) for name in ("filling", "radius", "removeLooseGrains", "initialOverlap")),
        ("grains", "packing", MADE),
        ("file", "packing", ["file"]),
        ("planar", "packing", ["cpe", "bcca", "file"]),
        ("sizes", "packing", MOST_GROWN),
        *((name, "sizes", [kind]) for name, kind in OF_SIZES.items()),
    ]

    def filled_in(self):
        """What follows from the way of packing: radius from grains or grains from radius and filling (cpe)."""
        found = self.changed(sizeFraction=0.5) if self.sizes == TWO and self.sizeFraction is None else self
        if self.packing == "file" and self.file is None:
            raise ParameterError(f"file: not given with packing = file; {self.columns()['file'].must}")
        for name, of in OF_SIZES.items():
            if self.sizes == of and getattr(found, name) is None:
                raise ParameterError(f"{name}: not given with sizes = {of}; {self.columns()[name].must}")
        if self.sizes == POWER and not self.smallest < self.largest:
            raise ParameterError(f"smallest = {self.smallest:g}: must be below largest = {self.largest:g}")
        if self.packing == "cpe":
            if len(self.material_names) > 1 and self.layout != PAIR:
                must = f"must be bcca, bpca or file, or layout = {PAIR}"
                raise ParameterError(f"packing = cpe: a lattice of two materials cannot be at rest; {must}")
            found = found.changed(atRest=0)._of_cpe()
        elif self.is_grown:
            found = found.changed(grains=GRAINS_GROWN if self.grains is None else self.grains)
            require_growable(self.packing, "grains", found.grains)
        return super(AggregateParameters, found).filled_in()

    @property
    def is_grown(self):
        """Whether grains come together one by one, so that they may be of unlike size."""
        return self.packing in MOST_GROWN

    def _of_cpe(self):
        dimensions = 2 if self.planar else 3
        filling = 0.4 if self.filling is None else self.filling
        if self.grains is not None:
            if self.grains < 2:
                raise ParameterError(f"grains = {self.grains}: given with packing = cpe; must be 2 or more")
            if self.radius is not None:
                raise ParameterError("radius and grains: both given; must be one of the two, beside filling")
            return self.changed(filling=filling, radius=(self.grains / filling) ** (1 / dimensions))
        radius = 20.0 if self.radius is None else self.radius
        least, most = ((n / filling) ** (1 / dimensions) for n in (2, MOST_GRAINS))
        grains = grain_number(filling, min(radius, 2 * most), bool(self.planar))
        if not 2 <= grains <= MOST_GRAINS:
            must = f"must be about {least:.3g} to {most:.3g} [grain radii], for 2 to {MOST_GRAINS} grains"
            raise ParameterError(f"radius = {radius:g}: too small or large at filling {filling:g}; {must}")
        return self.changed(filling=filling, radius=radius, grains=grains)


def require_growable(packing, name, grains):
    """Raise ParameterError when an aggregate that grows grain by grain would take too long."""
    if grains > MOST_GROWN[packing]:
        raise ParameterError(f"{name} = {grains}: too many for packing = {packing}; must be 2 to {MOST_GROWN[packing]}")


def make(parameters, overlap, index):
    """Aggregate number index of a run, around the origin; overlap: of touching grains of grainRadius [m]. Its
    parameters name the material, so that no run of others starts with contacts out of rest. Raises PackingError."""
    if parameters.layout != PAIR:
        return with_materials_at_rest(_as_made(parameters, overlap, index), parameters, overlap, index)
    side = 1 if index or getattr(parameters, "target", None) == "wall" else 0
    own = parameters.of_each()[side]
    overlap = equilibrium_overlap(own)
    packing = with_materials_at_rest(_as_made(own, overlap, index), own, overlap)
    return _of_materials(packing, parameters, np.full(packing.grains, side))


def with_materials_at_rest(packing, parameters, overlap, index=0):
    """The packing with the run's materials and its contacts at rest, as far as parameters ask for either; the others as
    of make(). Raises PackingError."""
    each = parameters.of_each()
    if len(each) > 1:
        overlap = overlaps(each)
        if packing.kind is None:
            packing = _of_materials(packing, parameters, _mixed(packing, parameters, index))
        elif not (parameters.materialFraction is parameters.layout is None):
            must = "must be left out, as its grains have their materials"
            raise PackingError(f"{parameters.file}: given with materialFraction or layout; {must}")
    elif packing.parameters["packing"] == "cpe":  # a lattice, at rest or meant to be as it is
        return packing
    if not parameters.atRest:
        return packing
    rested = brought_to_rest(packing, parameters.grainRadius, overlap)
    moved = rested.parameters["largestMotion"] > 0
    return replace(rested, position=centred(rested.position, rested.radius, rested.density)) if moved else rested


def _mixed(packing, parameters, index):
    """(N,) which material each grain of a packing is of, as `layout` has it."""
    if parameters.materialFraction is None:
        raise PackingError(f"{parameters.file}: doesn't say of what its grains are; materialFraction must be given")
    kind, second = np.zeros(packing.grains, dtype=int), round(parameters.materialFraction * packing.grains)
    if parameters.layout == MIXED:
        order = random_stream(parameters.seed, index, 2).permutation(packing.grains)
    else:
        place = packing.position[:, 0] if parameters.layout == HALVES else np.linalg.norm(packing.position, axis=1)
        order = np.argsort(place, kind="stable")
    kind[order[packing.grains - second :]] = 1
    return kind


def _of_materials(packing, parameters, kind):
    about = {**packing.parameters, "materials": derived_materials(parameters.of_each())["materials"]}
    return replace(packing, kind=kind.astype(np.int32), parameters=about)


def _as_made(parameters, overlap, index):
    p, planar = parameters, bool(parameters.planar)
    if p.packing == "file":
        return packing_from_file(p.file, p, overlap, planar)
    if p.packing == "cpe":
        apart = overlap * p.initialOverlap
        packing = cpe(p.filling, p.radius * p.grainRadius, p.grainRadius, apart, p.seed, index, planar)
        packing = largest_piece(packing) if p.removeLooseGrains else packing
    elif p.packing == "bpca":
        packing = bpca(p.grains, p.grainRadius, overlap, p.seed, index, radii(p, index))
    else:
        packing = bcca(p.grains, p.grainRadius, overlap, p.seed, index, planar, radii(p, index))
    names = OF_CONTACTS if p.sizes == EQUAL else (*OF_CONTACTS, "sizes", *OF_SIZES)
    about = {name: getattr(p, name) for name in names if getattr(p, name) is not None}
    return replace(packing, parameters={**packing.parameters, **about})


def radii(parameters, index):
    """Radii (grains,) [m] of a grown aggregate in random order, from a stream of their own."""
    p, stream = parameters, random_stream(parameters.seed, index, 1)
    if p.sizes == LOGNORMAL:
        deviations = stream.normal(size=p.grains)
        while (outside := np.abs(deviations) > WIDEST).any():
            deviations[outside] = stream.normal(size=np.count_nonzero(outside))
        return p.grainRadius * np.exp(p.sizeSpread * deviations)
    if p.sizes == POWER:
        uniform, power = stream.random(p.grains), p.sizeExponent + 1.0
        if power == 0.0:
            return p.smallest * (p.largest / p.smallest) ** uniform
        return (p.smallest**power + uniform * (p.largest**power - p.smallest**power)) ** (1.0 / power)
    if p.sizes == FILE:
        given = _radii_in(p.sizesFile)
        return stream.permutation(given) if len(given) == p.grains else stream.choice(given, p.grains)
    found = np.full(p.grains, float(p.grainRadius))
    if p.sizes == EQUAL:
        return found
    others = round(p.sizeFraction * p.grains)
    if 0 < p.sizeFraction < 1 and others in (0, p.grains):
        must = "must be 0, 1, or such that some are"
        raise ParameterError(f"sizeFraction = {p.sizeFraction:g}: of {p.grains} grains none, or all; {must}")
    found[:others] *= p.sizeRatio
    return stream.permutation(found)


def _radii_in(file):
    """Radii (K,) [m] of a text file; ParameterError."""
    must = "must be a text file with a radius [m] a line"
    try:
        with warnings.catch_warnings(action="error"):  # of an empty file
            radii = np.loadtxt(file, ndmin=1)
    except (OSError, ValueError, UserWarning) as error:
        raise ParameterError(f"sizesFile = {file}: {' '.join(str(error).split())}; {must}") from None
    if radii.ndim > 1 or not np.all((radii >= GRAINS.low) & (radii <= GRAINS.high)):
        raise ParameterError(f"sizesFile = {file}: not radii of {GRAINS.low:g} to {GRAINS.high:g} m; {must}")
    return radii
