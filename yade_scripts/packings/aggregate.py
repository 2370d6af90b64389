"""The aggregate that a run's parameters ask for."""

import math
from dataclasses import dataclass, replace

from yade_scripts.materials import GrainParameters
from yade_scripts.packings import grain_sizes
from yade_scripts.packings.bcca import bcca
from yade_scripts.packings.bpca import bpca
from yade_scripts.packings.cut import OF_CONTACTS
from yade_scripts.packings.filling import grain_number
from yade_scripts.packings.from_file import packing_from_file
from yade_scripts.packings.grain_sizes import EQUAL, LOGNORMAL, SIZES, TWO
from yade_scripts.packings.largest_piece import largest_piece
from yade_scripts.packings.lattice import cpe
from yade_scripts.packings.packing import random_stream
from yade_scripts.parameters import NOT_NEGATIVE, POSITIVE, SWITCH, Check, ParameterError, between, one_of, parameter

MOST_GRAINS = 5_000_000
MOST_GROWN = {"bcca": 100_000, "bpca": 2_000_000}  # made in a minute, in minutes
GRAINS_GROWN = 1024
MADE = ("cpe", *MOST_GROWN)
OF_CPE = ("removeLooseGrains", "initialOverlap")
OF_SIZES = {"sizeRatio": TWO, "sizeFraction": TWO, "sizeSpread": LOGNORMAL}


@dataclass(frozen=True)
class AggregateParameters(GrainParameters):
    """The aggregates. Radius and filling of a bcca, bpca or file aggregate follow when it is made."""

    packing: str = parameter(
        "cpe",
        one_of([*MADE, "file"]),
        "how they are made: close-packed and extracted, cluster-cluster or particle-cluster aggregation, or read from file",
    )
    filling: float | None = parameter(
        None,
        Check("> 0 and at most what the lattice holds", lambda x: x > 0),
        "filling factor N (r/R)^3 of a cpe aggregate, N (r/R)^2 of a planar one (0.4); of others the sum of (r/R)^3 or (r/R)^2 is found, "
        "with R from the centre to that of the farthest grain; largest_filling_factor of tables has R = (5/3)^(1/2) R_g",
        "1",
    )
    radius: float | None = parameter(
        None, POSITIVE, "radius of a cpe aggregate (20 if grains is not given either)", "grain radii"
    )
    grains: int | None = parameter(
        None, between(2, MOST_GRAINS), f"grains of an aggregate, instead of radius (bcca, bpca: {GRAINS_GROWN})"
    )
    planar: int = parameter(0, SWITCH, "1: grains confined to a plane")
    file: str | None = parameter(
        None, Check("a packing that make_packing.py wrote", lambda text: text != ""), "packing of packing = file"
    )
    sizes: str = parameter(
        EQUAL,
        one_of(SIZES),
        "radii of the grains of a bcca or bpca aggregate: all of grainRadius, two radii, log-normal",
    )
    sizeRatio: float | None = parameter(
        None, between(0.1, 10.0), "sizes = two: radius of the others over grainRadius", "1"
    )
    sizeFraction: float | None = parameter(
        None, between(0.0, 1.0), "sizes = two: how many of the grains are the others (0.5)", "1"
    )
    sizeSpread: float | None = parameter(
        None,
        Check("> 0 and at most 0.7", lambda x: 0 < x <= 0.7),
        "sizes = lognormal: standard deviation of ln r around ln grainRadius, "
        f"cut off at {grain_sizes.WIDEST:g} of it",
        "1",
    )
    removeLooseGrains: int = parameter(
        0,
        SWITCH,
        "1: grains of a cpe aggregate outside its largest connected piece are left out, which stays where it was: impact is that "
        "of the spheres",
    )
    initialOverlap: float = parameter(
        1.0,
        Check("> 0 and at most 1", lambda x: 0 < x <= 1),
        "overlap of touching grains of a cpe aggregate at the start; below 1 they pull",
        "of that at rest",
    )
    seed: int = parameter(1, NOT_NEGATIVE, "of the random packings")

    def filled_in(self):
        """What follows from the way of packing: radius from grains or grains from radius and filling (cpe)."""
        if self.packing != "file" and self.file is not None:
            raise ParameterError(f"file = {self.file}: given with packing = {self.packing}; must be left out")
        if self.packing != "cpe":
            self._refuse(*OF_CPE)
        sized = {"cpe": self._of_cpe, "file": self._of_file}.get(self.packing, self._grown)()
        return super(AggregateParameters, sized._with_sizes()).filled_in()

    @property
    def is_grown(self):
        """Whether grains come together one by one, so that they may be of unlike size."""
        return self.packing in MOST_GROWN

    def radius_range(self):
        """(smallest, largest) radius [m] that a grain of these sizes may have."""
        return grain_sizes.radius_range(self.sizes, self.grainRadius, self.sizeRatio, self.sizeSpread)

    def _with_sizes(self):
        if self.sizes != EQUAL and not self.is_grown:
            raise ParameterError(f"sizes = {self.sizes}: given with packing = {self.packing}; must be {EQUAL}")
        for name, of in OF_SIZES.items():
            if self.sizes != of and getattr(self, name) is not None:
                raise ParameterError(
                    f"{name} = {getattr(self, name):g}: given with sizes = {self.sizes}; must be left out"
                )
        if self.sizes == TWO and self.sizeFraction is None:
            return self._required("sizeRatio").changed(sizeFraction=0.5)
        return self._required({TWO: "sizeRatio", LOGNORMAL: "sizeSpread"}.get(self.sizes))

    def _required(self, name):
        if name is not None and getattr(self, name) is None:
            raise ParameterError(f"{name}: not given with sizes = {self.sizes}; {self.columns()[name].must}")
        return self

    def _refuse(self, *names):
        for name in names:
            value = getattr(self, name)
            if value != self.columns()[name].default:
                raise ParameterError(
                    f"{name} = {value:g}: given with packing = {self.packing}, on which it has no effect; must be left out"
                )

    def _grown(self):
        for name in ("filling", "radius"):
            if getattr(self, name) is not None:
                raise ParameterError(
                    f"{name} = {getattr(self, name):g}: given with packing = {self.packing}; must be grains only"
                )
        if self.packing == "bpca" and self.planar:
            raise ParameterError("planar = 1: given with packing = bpca, which is made in space; must be 0")
        grains = GRAINS_GROWN if self.grains is None else self.grains
        require_growable(self.packing, "grains", grains)
        return self.changed(grains=grains)

    def _of_file(self):
        if self.file is None:
            raise ParameterError("file: not given with packing = file; must be a packing that make_packing.py wrote")
        self._refuse("filling", "radius", "grains", "seed")
        return self

    def _of_cpe(self):
        dimensions = 2 if self.planar else 3
        filling = 0.4 if self.filling is None else self.filling
        if self.grains is not None:
            if self.radius is not None:
                raise ParameterError("radius and grains: both given; must be one of the two, beside filling")
            return self.changed(filling=filling, radius=(self.grains / filling) ** (1 / dimensions))
        radius = 20.0 if self.radius is None else self.radius
        try:
            grains = grain_number(filling, radius, bool(self.planar))
        except OverflowError:
            grains = math.inf
        if not 2 <= grains <= MOST_GRAINS:
            at_least, at_most = ((n / filling) ** (1 / dimensions) for n in (2, MOST_GRAINS))
            raise ParameterError(
                f"radius = {radius:g}: {grains:g} grains at filling {filling:g}; must be about {at_least:.3g} to "
                f"{at_most:.3g} [grain radii], for 2 to {MOST_GRAINS} grains"
            )
        return self.changed(filling=filling, radius=radius, grains=grains)


def require_growable(packing, name, grains):
    """Raise ParameterError when an aggregate that grows grain by grain would take too long."""
    if grains > MOST_GROWN[packing]:
        raise ParameterError(f"{name} = {grains}: too many for packing = {packing}; must be 2 to {MOST_GROWN[packing]}")


def make(parameters, overlap, index):
    """Aggregate number index of a run, around the origin.

    parameters: AggregateParameters; overlap: of touching grains of grainRadius [m]. What is made says of which material,
    so that a run of other grains does not start with contacts out of rest (from_file.py), and how unlike its grains are. Raises
    PackingError.
    """
    if parameters.packing == "file":
        return packing_from_file(parameters.file, parameters.grainRadius, overlap, bool(parameters.planar), parameters)
    packing = _made(parameters, overlap, index)
    told = OF_CONTACTS if parameters.sizes == EQUAL else (*OF_CONTACTS, "sizes", *OF_SIZES)
    about = {name: getattr(parameters, name) for name in told if getattr(parameters, name) is not None}
    return replace(packing, parameters={**packing.parameters, **about})


def _made(parameters, overlap, index):
    radius, seed, planar = parameters.grainRadius, parameters.seed, bool(parameters.planar)
    if parameters.packing == "cpe":
        overlap *= parameters.initialOverlap
        packing = cpe(parameters.filling, parameters.radius * radius, radius, overlap, seed, index, planar)
        return largest_piece(packing) if parameters.removeLooseGrains else packing
    radii = _radii(parameters, index)
    if parameters.packing == "bpca":
        return bpca(parameters.grains, radius, overlap, seed, index, radii)
    return bcca(parameters.grains, radius, overlap, seed, index, planar, radii)


def _radii(parameters, index):
    """Radii [m] of a grown aggregate, from a stream of their own: with equal grains the packing stays the same."""
    p, stream = parameters, random_stream(parameters.seed, index, 1)
    if p.sizes == TWO and 0 < p.sizeFraction < 1 and round(p.sizeFraction * p.grains) in (0, p.grains):
        raise ParameterError(
            f"sizeFraction = {p.sizeFraction:g}: of {p.grains} grains none, or all; must be 0, 1, or such that some are"
        )
    return grain_sizes.radii(p.sizes, p.grains, p.grainRadius, stream, p.sizeRatio, p.sizeFraction, p.sizeSpread)
