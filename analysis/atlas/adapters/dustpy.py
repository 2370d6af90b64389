"""DustPy (Stammler & Birnstiel 2022) with the atlas's outcomes instead of one fragmentation velocity.

    from analysis.atlas.adapters.dustpy import use_atlas
    atlas = use_atlas(sim, "outcomes.txt")        # after sim.initialize()
    sim.run()
    atlas.report(sim)                             # what is outside of the atlas's data

Needs DustPy's simulation only: nothing of it is imported. DustPy is in CGS, the atlas without units but for the grains'."""

import warnings
from math import pi

import numpy as np

from ...arguments import FLAG, PATH, Kind, number, one_of, takes
from ...theory import GRAIN_RADIUS, MATERIALS, interaction_energies, pair_constants
from ..grid import MOSTLY, PROBABILITIES, RADIUS, TOUCHING
from ..outcome_table import INSIDE, OutcomeTable, OutcomeTableError, read_outcomes
from ..rules import OF_KIND

PER_NODE = 4  # speeds between two nodes of the table at which a pair's probabilities are kept
CM, GRAM, GRAM_PER_CM3 = 100.0, 1000.0, 1e-3  # of one m, kg, kg/m^3


@takes(
    outcomes=Kind("a path, or an OutcomeTable", lambda value: isinstance(value, OutcomeTable) or PATH.is_right(value)),
    outside=one_of("clamp", "dustpy"),
    speeds=one_of("maxwell", "rms"),
    material=one_of(*MATERIALS),
    grain_radius=number(RADIUS),
    fragment_index=FLAG,
)
def use_atlas(
    sim, outcomes, outside="clamp", speeds="maxwell", material="ice", grain_radius=None, fragment_index=False
):
    """Give an initialised dustpy.Simulation the atlas's probabilities: updaters of sim.dust.p.frag and sim.dust.p.stick. Returns
    the AtlasInDustPy, which reports.

    outcomes: a file (outcomes.txt) or an OutcomeTable. outside: beyond the data "clamp" takes the probabilities at the nearest
    edge of the data, "dustpy" DustPy's own (sim.dust.v.frag). speeds: sim.dust.v.rel.tot is the rms of "maxwell" distributed
    collisions, as DustPy itself has it, or every collision's ("rms"). material ("ice" or "silicate") and grain_radius of the
    grains, in m, not cm (None: 1e-7 of ice, 6e-7 of silicate), make E_break; their density is sim.dust.rhos, the filling factor of
    the aggregates sim.dust.fill. fragment_index: also gives sim.dust.coagulation.phi the atlas's mean power law of fragments.

    Warns where most collisions at present are outside of the data, as of grains of another size than meant. ValueError for what is
    none of these, or a simulation that is not initialised; OutcomeTableError for a wrong table.
    """
    if sim.dust.p.frag is None:
        raise ValueError("use_atlas: the simulation is not initialised; must be called after sim.initialize()")
    table = outcomes if isinstance(outcomes, OutcomeTable) else read_outcomes(outcomes)
    radius = GRAIN_RADIUS[material] if grain_radius is None else grain_radius
    atlas = AtlasInDustPy(sim, table, outside == "dustpy", speeds == "maxwell", MATERIALS[material], radius)
    sim.dust.p.frag.updater = atlas.breaking
    sim.dust.p.stick.updater = atlas.sticking
    if fragment_index:
        sim.dust.coagulation.phi[...] = fragments_of(sim.grid.m, mean_fragment_index(table))
    sim.update()
    rate, share = atlas.outside(sim)
    if (rate * share).sum() > MOSTLY * rate.sum():
        said = f"{np.average(share, weights=rate):.0%} of the collisions are at present outside of the atlas's data"
        warnings.warn(
            f"use_atlas: {said}, with grain_radius = {radius:g} m; report() says beyond which end", stacklevel=3
        )
    return atlas


def dustpy_outcomes(table):
    """OutcomeTable of what DustPy knows: stick, frag; the rest bounces, or never touches (DustPy's cross-section is that of the spheres). Mass transfer
    sticks with (1 + gain_mass_transfer)/2 and else breaks: the larger aggregate then gains that on average, as in DustPy it gains the smaller one's
    mass where they stick, and loses as much where it is eroded (excavatedMass = 1)."""
    p = _columns(table)
    transfer = p["p_mass_transfer"]
    sticks = (1.0 + p["gain_mass_transfer"]) / 2.0
    stick = p[TOUCHING] * (p["p_sticking"] + sticks * transfer)
    frag = p[TOUCHING] * (p["p_fragmentation"] + p["p_erosion"] + (1.0 - sticks) * transfer)
    return OutcomeTable(table.axes, ("stick", "frag", INSIDE), np.stack([stick, frag, p[INSIDE]], axis=-1))


def mean_fragment_index(table):
    """Power-law index of the fragments' masses (dN/dm ~ m^-index): mean over the nodes inside of the data, by what breaks there."""
    p = _columns(table)
    return np.average(p["fragment_index"], weights=(p["p_erosion"] + p["p_fragmentation"]) * p[INSIDE])


def _columns(table):
    if missing := [name for name in (*PROBABILITIES, TOUCHING, *OF_KIND) if name not in table.columns]:
        raise OutcomeTableError(f"table of outcomes: no column {missing[0]}; must be one that this version makes")
    return {name: table.values[..., k] for k, name in enumerate(table.columns)}


def fragments_of(mass, index):
    """(Nm, Nm) DustPy's phi: row i has the mass fractions of the fragments in each bin of mass [g], up to bin i; rows add up to 1."""
    phi = np.tril(np.asarray(mass) ** (2.0 - index))
    return phi / phi.sum(axis=1, keepdims=True)


class AtlasInDustPy:
    """The atlas in one simulation; made by use_atlas(). Pairs are counted once, as DustPy does: [smaller, larger], also of equals."""

    def __init__(self, sim, table, own_outside, maxwell, material, grain_radius):
        self.table = dustpy_outcomes(table)
        if maxwell:
            self.table = self.table.maxwell()
        self.own_frag = sim.dust.p.frag.updater if own_outside else None
        self.break_energy = interaction_energies(pair_constants(material, grain_radius))["break"]  # J
        self.grain_volume = 4.0 / 3.0 * pi * grain_radius**3  # m^3
        self.mass = np.array(sim.grid.m)
        self.smaller, self.larger = np.triu_indices(len(self.mass))
        self._pair = np.zeros((len(self.mass), len(self.mass)), dtype=int)  # which pair stands where in (Nm, Nm)
        for order in ((self.smaller, self.larger), (self.larger, self.smaller)):
            self._pair[order] = np.arange(len(self.smaller))
        self._curves_of = self._stick = None

    def breaking(self, sim):
        """(Nr, Nm, Nm) sim.dust.p.frag; 0 in the first and last radial cell."""
        found = self._probabilities(sim)
        if self.own_frag is not None:
            own = found["own"] * np.asarray(self.own_frag.beat(sim))[1:-1, self.smaller, self.larger]
            found["frag"] += own
            found["stick"] -= own
        self._stick = self._of_pairs(np.minimum(found["stick"], 1.0 - found["frag"]))  # but for rounding
        return self._of_pairs(found["frag"])

    def sticking(self, _):
        """(Nr, Nm, Nm) sim.dust.p.stick, for which DustPy asks after p.frag."""
        return self._stick

    def outside(self, sim):
        """(rate, share) (Nr - 2, pairs): collisions of the disk [1/s] at present, and the part of them outside of the data."""
        number = np.asarray(sim.dust.Sigma / sim.grid.m)[1:-1]
        rate = np.asarray(sim.dust.kernel)[1:-1, self.smaller, self.larger] * np.asarray(sim.grid.A)[1:-1, None]
        rate *= number[:, self.smaller] * number[:, self.larger]
        return rate, 1.0 - self.table.lookup([], **self._query(sim))[INSIDE]

    def outside_of_bins(self, sim):
        """(Nr, Nm): of the collisions of each mass bin the part outside of the data, NaN where there are none."""
        rate, share = self.outside(sim)
        sums = np.zeros((2, *sim.dust.a.shape))
        for bins in (self.smaller, self.larger):
            np.add.at(sums, (slice(None), slice(1, -1), bins), np.stack([rate * share, rate]))
        return np.divide(sums[0], sums[1], out=np.full(sums[0].shape, np.nan), where=sums[1] > 0.0)

    def report(self, sim):
        """{what: part} at present. `collisions` and `mass` (of the dust, by its collisions) outside of the data; of all collisions
        those beyond an end of each axis, as in `grains above`; and how all end: `stick`, `frag`, `bounce`."""
        rate, share = self.outside(sim)
        of_bins, mass = self.outside_of_bins(sim), np.asarray(sim.dust.Sigma * sim.grid.A[:, None])
        said = {"collisions": np.average(share, weights=rate)}
        said["mass"] = np.average(np.nan_to_num(of_bins), weights=mass * np.isfinite(of_bins))
        query = self._query(sim)
        for axis in self.table.axes:
            beyond = axis.beyond(query[axis.name])
            said[f"{axis.name} below"] = np.average(beyond < 0, weights=rate)
            said[f"{axis.name} above"] = np.average(beyond > 0, weights=rate)
        for name in ("stick", "frag"):
            field = np.asarray(getattr(sim.dust.p, name))[1:-1, self.smaller, self.larger]
            said[name] = np.average(field, weights=rate)
        said["bounce"] = 1.0 - said["stick"] - said["frag"]
        return {name: float(part) for name, part in said.items()}

    def _of_pairs(self, values):
        """(Nr, Nm, Nm) of (Nr - 2, pairs): symmetric, 0 in the first and last radial cell."""
        full = np.zeros((len(values) + 2, *self._pair.shape))
        full[1:-1] = values.take(self._pair, axis=1)
        return full

    def _speeds(self, sim):
        return np.asarray(sim.dust.v.rel.tot)[1:-1, self.smaller, self.larger]

    def _query(self, sim, speeds=None):
        """{axis: (Nr - 2, pairs)} of the table, at speeds [cm/s] (the simulation's); filling is the mean by mass of both, the grains are those of the larger aggregate."""
        grain = np.asarray(sim.dust.rhos)[1:-1, self.larger] / GRAM_PER_CM3 * self.grain_volume  # kg
        filled = np.asarray(sim.dust.fill)[1:-1] * self.mass
        mass = np.broadcast_to(self.mass, filled.shape)
        small, large = mass[:, self.smaller], mass[:, self.larger]
        return {
            "velocity": (self._speeds(sim) if speeds is None else speeds) / CM / np.sqrt(self.break_energy / grain),
            "grains": large / GRAM / grain,
            "mass_ratio": small / large,
            "filling": (filled[:, self.smaller] + filled[:, self.larger]) / (small + large),
        }

    def _probabilities(self, sim):
        """{stick, frag and maybe own: (Nr - 2, pairs)}: from curves over the speed, one for each pair, where the density of the grains
        and the filling are the same at every radius; else from the table, which takes 0.3 us a pair and step."""
        dust = np.array([sim.dust.rhos, sim.dust.fill])[:, 1:-1]
        if np.ptp(dust, axis=1).any():
            return self._found(**self._query(sim))
        speeds = self._speeds(sim)
        if self._curves_of is None or not np.array_equal(dust[:, 0], self._curves_of):
            first = {name: values[0] for name, values in self._query(sim, 1.0).items()}
            unit = first.pop("velocity")
            self._curves_of, self._curves = dust[:, 0], _Curves(self._found, self.table.axes[0], first, unit)
        return self._curves.at(speeds)

    def _found(self, **query):
        """{stick, frag} of the table; where DustPy decides outside of the data, of them what the atlas decides, and `own`, the part
        that is DustPy's, in which what it does not break sticks."""
        found = self.table.lookup(**query)
        inside = found.pop(INSIDE)
        if self.own_frag is None:
            return found
        own = 1.0 - inside
        return {"stick": inside * found["stick"] + own, "frag": inside * found["frag"], "own": own}


class _Curves:
    """Columns of each pair as lines over the logarithm of the speed, PER_NODE between each two nodes of the table's first axis."""

    def __init__(self, found, axis, query, unit):
        """found(velocity=, **query): {column: array}. query: {another axis: (pairs,)}; unit: the table's velocity over that in cm/s."""
        first, last = axis.nodes[[0, -1]]
        steps = len(axis.nodes) - 1
        self.knots = np.interp(np.arange(PER_NODE * steps + 1) / PER_NODE, np.arange(steps + 1), np.log(axis.nodes))
        inner = np.clip(np.exp(self.knots), first, last)  # but for rounding
        speeds = np.concatenate([[0.5 * first], inner, [2.0 * last]])
        columns = found(velocity=speeds, **{name: values[:, None] for name, values in query.items()})
        self.names, values = tuple(columns), np.stack(list(columns.values()), axis=-1)  # (pairs, speeds, columns)
        starts, rise = np.delete(values, -2, axis=1), np.diff(values, axis=1)
        rise[:, [0, -1]] = 0.0  # beyond the ends all is as there
        self.lines = np.concatenate([starts, rise], axis=-1).reshape(-1, 2 * len(columns))
        self.first = np.arange(len(unit), dtype=np.int32) * starts.shape[1]
        self.unit = np.log(unit)

    def at(self, speeds):
        """{column: (Nr - 2, pairs)} at speeds (Nr - 2, pairs) [cm/s]."""
        with np.errstate(divide="ignore"):
            position = np.log(speeds)
        position += self.unit
        position = np.interp(position, self.knots, np.arange(1, len(self.knots) + 1), left=0.0)
        line = position.astype(np.int32)
        position -= line
        line += self.first
        lines = self.lines.take(line, axis=0, mode="clip")
        return {name: lines[..., k] + position * lines[..., k + len(self.names)] for k, name in enumerate(self.names)}
