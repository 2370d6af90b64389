"""DustPy (Stammler & Birnstiel 2022) with the atlas's outcomes instead of one fragmentation velocity.

    from analysis.atlas.adapters.dustpy import use_atlas
    atlas = use_atlas(sim, "outcomes.txt")        # after sim.initialize()
    sim.run()
    atlas.report(sim)                             # which collisions are outside of the atlas's data

Nothing of DustPy is imported. DustPy is in CGS units; the atlas has none, but for the properties of the grains (SI).
Nr: radial cells, Nm: bins of mass. Pairs of bins are counted once, as in DustPy: [smaller, larger], also of equal ones.
"""

import warnings
from math import pi

import numpy as np

from ...theory import MATERIALS, interaction_energies, pair_constants
from ..outcome_table import INSIDE, PROBABILITIES, TOUCHING, OutcomeTable, read_outcomes
from ..query import MOSTLY, radius_of
from ..rules import OF_KIND

CM, GRAM, GRAM_PER_CM3 = 100.0, 1000.0, 1e-3  # of one m, kg, kg/m^3


def use_atlas(
    sim, outcomes, outside="clamp", speeds="maxwell", material="ice", grain_radius=None, fragment_index=False
):
    """Give a DustPy simulation the atlas's probabilities: updaters of sim.dust.p.frag and sim.dust.p.stick. The density
    of the grains is sim.dust.rhos, the filling factor of the aggregates sim.dust.fill.

    Parameters
    ----------
    sim : dustpy.Simulation
        Initialised.
    outcomes : path or OutcomeTable
        outcomes.txt, or another table averaged over impact parameters.
    outside : {"clamp", "dustpy"}
        Beyond the data: the probabilities at the nearest edge of the data, or DustPy's own (sim.dust.v.frag).
    speeds : {"maxwell", "rms"}
        sim.dust.v.rel.tot is the root mean square of Maxwell-distributed speeds, as in DustPy itself, or every speed.
    material : {"ice", "silicate"}
        Of the grains; with the radius it makes E_break.
    grain_radius : float, optional
        [m], not cm; by default 1e-7 of ice, 6e-7 of silicate.
    fragment_index : bool
        Whether sim.dust.coagulation.phi gets the atlas's mean power law of fragments.

    Returns
    -------
    AtlasInDustPy
        A warning says where most collisions at present are outside of the data. ValueError for a wrong argument.
    """
    for name, value, choices in (
        ("outside", outside, ("clamp", "dustpy")),
        ("speeds", speeds, ("maxwell", "rms")),
        ("material", material, MATERIALS),
    ):
        if value not in choices:
            raise ValueError(f"{name} = {value}: must be {' or '.join(choices)}")
    if sim.dust.p.frag is None:
        raise ValueError("use_atlas: the simulation is not initialised; must be called after sim.initialize()")
    radius = radius_of(material, grain_radius)
    table = outcomes if isinstance(outcomes, OutcomeTable) else read_outcomes(outcomes)
    atlas = AtlasInDustPy(sim, table, outside == "dustpy", speeds == "maxwell", MATERIALS[material], radius)
    sim.dust.p.frag.updater = atlas.breaking
    sim.dust.p.stick.updater = atlas.sticking
    if fragment_index:
        sim.dust.coagulation.phi[...] = fragments_of(sim.grid.m, mean_fragment_index(table))
    sim.update()
    rate, share = atlas.outside(sim)
    if (rate * share).sum() > MOSTLY * rate.sum():
        warnings.warn(
            f"use_atlas: {np.average(share, weights=rate):.0%} of the collisions are at present outside of the "
            f"atlas's data, with grain_radius = {radius:g} m; report() says beyond which end",
            stacklevel=2,
        )
    return atlas


def dustpy_outcomes(table):
    """OutcomeTable of DustPy's outcomes: stick, frag; all else bounces, or never touches (DustPy takes spheres).

    Mass transfer sticks with (1 + gain_mass_transfer)/2 and else breaks. So the larger aggregate gains that on average:
    in DustPy it gains the smaller one's mass by sticking, and loses as much by erosion (excavatedMass = 1).
    """
    if missing := [name for name in (*PROBABILITIES, TOUCHING, *OF_KIND) if name not in table.columns]:
        raise ValueError(f"table of outcomes: no column {missing[0]}; must be one that this version makes")
    p = {name: table.column(name) for name in table.columns}
    transfer = p["p_mass_transfer"]
    sticks = (1.0 + p["gain_mass_transfer"]) / 2.0
    stick = p[TOUCHING] * (p["p_sticking"] + sticks * transfer)
    frag = p[TOUCHING] * (p["p_fragmentation"] + p["p_erosion"] + (1.0 - sticks) * transfer)
    return OutcomeTable(table.axes, ("stick", "frag", INSIDE), np.stack([stick, frag, p[INSIDE]], axis=-1))


def mean_fragment_index(table):
    """Index n of dN/dm ~ m^-n of fragments: mean over the nodes inside of the data, by the probability of breaking."""
    breaking = table.column("p_erosion") + table.column("p_fragmentation")
    return np.average(table.column("fragment_index"), weights=breaking * table.column(INSIDE))


def fragments_of(mass, index):
    """DustPy's phi (Nm, Nm): row i has the mass fractions of fragments in each bin of mass [g] up to bin i."""
    phi = np.tril(np.asarray(mass) ** (2.0 - index))
    return phi / phi.sum(axis=1, keepdims=True)


class AtlasInDustPy:
    """The atlas in one simulation, made by use_atlas()."""

    def __init__(self, sim, table, own_outside, maxwell, material, grain_radius):
        self.table = dustpy_outcomes(table)
        if maxwell:
            self.table = self.table.maxwell()
        self.own_frag = sim.dust.p.frag.updater if own_outside else None
        self.break_energy = interaction_energies(pair_constants(material, grain_radius))["break"]  # J
        self.grain_volume = 4.0 / 3.0 * pi * grain_radius**3  # m^3
        self.mass = np.array(sim.grid.m)
        self.smaller, self.larger = np.triu_indices(len(self.mass))
        self.pairs = np.s_[1:-1, self.smaller, self.larger]  # of a field (Nr, Nm, Nm), without the first and last cell
        self._curves_of = self._stick = None

    def breaking(self, sim):
        """sim.dust.p.frag (Nr, Nm, Nm); 0 in the first and last radial cell."""
        found = self._lookup(sim)
        stick, frag = found["stick"], found["frag"]
        if self.own_frag is not None:
            inside, own = found[INSIDE], np.asarray(self.own_frag.beat(sim))[self.pairs]
            stick = inside * stick + (1.0 - inside) * (1.0 - own)
            frag = inside * frag + (1.0 - inside) * own
        self._stick = self._field(np.minimum(stick, 1.0 - frag))  # but for rounding
        return self._field(frag)

    def sticking(self, _):
        """sim.dust.p.stick (Nr, Nm, Nm), which DustPy updates after p.frag."""
        return self._stick

    def outside(self, sim):
        """Present collisions [1/s] of each pair and the part of them outside of the data, both (Nr - 2, pairs)."""
        number = np.asarray(sim.dust.Sigma / sim.grid.m)[1:-1]
        rate = np.asarray(sim.dust.kernel)[self.pairs] * np.asarray(sim.grid.A)[1:-1, None]
        rate *= number[:, self.smaller] * number[:, self.larger]
        return rate, 1.0 - self.table.lookup([], **self._query(sim))[INSIDE]

    def outside_of_bins(self, sim):
        """The part (Nr, Nm) of the collisions of each bin that is outside of the data; NaN without collisions."""
        rate, share = self.outside(sim)
        sums = np.zeros((2, *sim.dust.a.shape))
        for bins in (self.smaller, self.larger):
            np.add.at(sums, (slice(None), slice(1, -1), bins), np.stack([rate * share, rate]))
        return np.divide(sums[0], sums[1], out=np.full(sums[0].shape, np.nan), where=sums[1] > 0.0)

    def report(self, sim):
        """Present parts, {name: float}.

        `collisions` and `mass` (of the dust, by its collisions) outside of the data; of all collisions those beyond an
        end of each axis (`grains above`); and how all end: `stick`, `frag`, `bounce`.
        """
        rate, share = self.outside(sim)
        of_bins, mass = self.outside_of_bins(sim), np.asarray(sim.dust.Sigma * sim.grid.A[:, None])
        parts = {
            "collisions": np.average(share, weights=rate),
            "mass": np.average(np.nan_to_num(of_bins), weights=mass * np.isfinite(of_bins)),
        }
        query = self._query(sim)
        for axis in self.table.axes:
            beyond = axis.beyond(query[axis.name])
            parts[f"{axis.name} below"] = np.average(beyond < 0, weights=rate)
            parts[f"{axis.name} above"] = np.average(beyond > 0, weights=rate)
        for name in ("stick", "frag"):
            parts[name] = np.average(np.asarray(getattr(sim.dust.p, name))[self.pairs], weights=rate)
        parts["bounce"] = 1.0 - parts["stick"] - parts["frag"]
        return {name: float(part) for name, part in parts.items()}

    def _field(self, values):
        """(Nr, Nm, Nm) of (Nr - 2, pairs): symmetric, 0 in the first and last radial cell."""
        full = np.zeros((len(values) + 2, len(self.mass), len(self.mass)))
        full[1:-1, self.smaller, self.larger] = full[1:-1, self.larger, self.smaller] = values
        return full

    def _query(self, sim, speeds=None):
        """{axis of the table: (Nr - 2, pairs)} at speeds [cm/s], by default the simulation's."""
        grain = np.asarray(sim.dust.rhos)[1:-1, self.larger] / GRAM_PER_CM3 * self.grain_volume  # kg
        speeds = np.asarray(sim.dust.v.rel.tot)[self.pairs] if speeds is None else speeds
        filled = np.asarray(sim.dust.fill)[1:-1] * self.mass
        mass = np.broadcast_to(self.mass, filled.shape)
        small, large = mass[:, self.smaller], mass[:, self.larger]
        return {
            "velocity": speeds / CM / np.sqrt(self.break_energy / grain),
            "grains": large / GRAM / grain,
            "mass_ratio": small / large,
            "filling": (filled[:, self.smaller] + filled[:, self.larger]) / (small + large),
        }

    def _lookup(self, sim):
        """{column of the table: (Nr - 2, pairs)}: from curves over the speed where grains and filling are the same at
        every radius; else from the table, which takes 0.3 us a pair and step."""
        dust = np.array([sim.dust.rhos, sim.dust.fill])[:, 1:-1]
        if np.ptp(dust, axis=1).any():
            return self.table.lookup(**self._query(sim))
        if self._curves_of is None or not np.array_equal(dust[:, 0], self._curves_of):
            first = {name: values[0] for name, values in self._query(sim, 1.0).items()}
            self._curves_of, self._curves = dust[:, 0], _Curves(self.table, first)
        return self._curves.at(np.asarray(sim.dust.v.rel.tot)[self.pairs])


class _Curves:
    """Columns of a table against the speed, for pairs of which all else stays: query {axis: (pairs,)}, at 1 cm/s."""

    def __init__(self, table, query):
        self.unit, self.axis = query.pop("velocity"), table.axes[0]
        others = {name: values[:, None] for name, values in query.items()}
        columns = table.lookup(velocity=self.axis.nodes, **others)
        self.names, self.values = tuple(columns), np.stack(list(columns.values()), axis=-1)  # (pairs, nodes, columns)

    def at(self, speeds):
        """{column: (Nr - 2, pairs)} at speeds (Nr - 2, pairs) [cm/s]."""
        speeds = speeds * self.unit
        position, pairs = self.axis.position(speeds), np.arange(len(self.unit))
        below = np.minimum(position.astype(int), len(self.axis.nodes) - 2)
        low, high = self.values[pairs, below], self.values[pairs, below + 1]
        found = low + (position - below)[..., None] * (high - low)
        columns = {name: found[..., k] for k, name in enumerate(self.names)}
        columns[INSIDE][self.axis.beyond(speeds) != 0] = 0.0
        return columns
