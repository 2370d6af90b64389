"""The aggregate that a run's parameters ask for."""

import math
from dataclasses import dataclass

from yade_scripts.materials import GrainParameters
from yade_scripts.packings.bcca import bcca
from yade_scripts.packings.filling import grain_number
from yade_scripts.packings.lattice import cpe
from yade_scripts.parameters import NOT_NEGATIVE, POSITIVE, SWITCH, Check, ParameterError, between, one_of, parameter

MOST_GRAINS = 5_000_000
MOST_BCCA_GRAINS = 100_000  # made in a minute


@dataclass(frozen=True)
class AggregateParameters(GrainParameters):
    """The aggregates. Radius and filling of a bcca aggregate follow when it is made."""

    packing: str = parameter(
        "cpe", one_of(["cpe", "bcca"]), "how they are made: close-packed and extracted, or cluster-cluster aggregation"
    )
    filling: float | None = parameter(
        None,
        Check("> 0 and at most what the lattice holds", lambda x: x > 0),
        "filling factor N (r/R)^3 of a cpe aggregate, N (r/R)^2 of a planar one (0.4)",
        "1",
    )
    radius: float | None = parameter(
        None, POSITIVE, "radius of a cpe aggregate (20 if grains is not given either)", "grain radii"
    )
    grains: int | None = parameter(
        None, between(2, MOST_GRAINS), "grains of an aggregate, instead of radius (bcca: 1024)"
    )
    planar: int = parameter(0, SWITCH, "1: grains confined to a plane")
    seed: int = parameter(1, NOT_NEGATIVE, "of the random packings")

    def filled_in(self):
        """Radius from grains or grains from radius and filling (cpe); for bcca only grains."""
        sized = self._of_bcca() if self.packing == "bcca" else self._of_cpe()
        return super(AggregateParameters, sized).filled_in()

    def _of_bcca(self):
        for name in ("filling", "radius"):
            if getattr(self, name) is not None:
                raise ParameterError(
                    f"{name} = {getattr(self, name):g}: given with packing = bcca; must be grains only"
                )
        grains = 1024 if self.grains is None else self.grains
        if grains > MOST_BCCA_GRAINS:
            raise ParameterError(f"grains = {grains}: too many for packing = bcca; must be 2 to {MOST_BCCA_GRAINS}")
        return self.changed(grains=grains)

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


def make(parameters, overlap, index):
    """Aggregate number index of a run, around the origin.

    parameters: AggregateParameters; overlap: of touching grains [m]. Raises PackingError.
    """
    radius, seed, planar = parameters.grainRadius, parameters.seed, bool(parameters.planar)
    if parameters.packing == "bcca":
        return bcca(parameters.grains, radius, overlap, seed, index, planar)
    return cpe(parameters.filling, parameters.radius * radius, radius, overlap, seed, index, planar)
