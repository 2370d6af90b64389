"""Broken necks against the energy: fits of N_cut/N_t = amplitude (E_k/E_sint)^exponent to several selections of runs (S17
Fig. 15)."""

from dataclasses import dataclass

import numpy as np

from ...statistics import pair_weights, resampling_error, stretch

HIGH = 0.1  # E_k/E_sint above which eight necks or more break in a run of 2,048 grains by S17's line
# The runs that a fit is of: {name: (least beta of BCCA aggregates, least E_k/E_sint)}. S17 fits BCCA aggregates of beta = 0.7 and
# compacted ones of that beta, at all energies.
SELECTIONS = {
    "as in S17: beta = 0.7": (0.65, 0.0),
    f"beta = 0.7, E_k/E_sint > {HIGH:g}": (0.65, HIGH),
    "beta >= 0.3": (0.25, 0.0),
    f"beta >= 0.3, E_k/E_sint > {HIGH:g}": (0.25, HIGH),
}
OWN = next(iter(SELECTIONS))  # S17's


@dataclass(frozen=True)
class Law:
    """A fitted power law: amplitude and exponent, with their standard errors (None: too few seeds)."""

    amplitude: float
    exponent: float
    amplitude_error: float = None
    exponent_error: float = None

    def at(self, ratios):
        """N_cut/N_t at E_k/E_sint (n,)."""
        return self.amplitude * np.asarray(ratios, dtype=float) ** self.exponent


@dataclass(frozen=True)
class Fit:
    """Both fits of one selection: means (least squares of the logarithms of the points' means, which leaves out points
    without a broken neck), counts (maximum likelihood of Poisson counts, of all runs); runs, points, empty (points without a
    broken neck), seeds (their number), lowest and highest E_k/E_sint."""

    means: Law
    counts: Law
    runs: int
    points: int
    empty: int
    seeds: int
    lowest: float
    highest: float


def fit_all(table, point):
    """{name: Fit} of SELECTIONS of a table of sintered runs (see fit), without those that allow none, or hold the runs of an earlier one."""
    found, held = {}, []
    for name, (least_neck, least_ratio) in SELECTIONS.items():
        runs = table[(table.neck > least_neck) & (table.energy_ratio > least_ratio)]
        one = fit(runs, point) if list(runs.index) not in held else None
        if one is not None:
            found[name] = one
            held.append(list(runs.index))
    return found


def fit(table, point):
    """Fit of a table of runs with broken, grains, energy_ratio, packing_seed, and the columns `point` that tell points apart.
    None where fewer than two energies have broken necks. Errors are from resampling seeds, each with all its runs."""
    if not len(table):
        return None
    group = table.groupby(list(point)).ngroup().to_numpy()
    broken, grains = table.broken.to_numpy(dtype=float), table.grains.to_numpy(dtype=float)
    x, seeds = np.log(table.energy_ratio.to_numpy()), table.packing_seed.to_numpy()
    whole = np.array([broken[group == name].sum() for name in range(group.max() + 1)])
    energies = np.round(x[np.isin(group, np.flatnonzero(whole))], 3)
    if len(np.unique(energies)) < 2:
        return None
    number = len(np.unique(seeds))
    weights = np.vstack([np.ones((1, len(x))), pair_weights(seeds)])
    laws = (_of_means(x, broken / grains, group, weights), _of_counts(x, broken, grains, weights))
    return Fit(
        *(_law(*law, number) for law in laws),
        len(table),
        len(whole),
        int((whole == 0).sum()),
        number,
        *(float(f(table.energy_ratio)) for f in (min, max)),
    )


def _law(height, slope, seeds):
    """Law from ln amplitude and exponent (1 + B,): the first those of the runs, the others of resamples."""
    errors = (None, None)
    if seeds > 2:
        errors = (resampling_error(values[1:]) * stretch(seeds, 2) for values in (np.exp(height), slope))
    return Law(float(np.exp(height[0])), float(slope[0]), *errors)


def _of_means(x, y, group, weights):
    """(height, slope) (B,) of the line through the logarithms of the points' weighted means, those of 0 left out."""
    names = [name for name in np.unique(group) if y[group == name].any()]
    where = np.array([x[group == name][0] for name in names])
    mean = np.stack([(weights[:, group == n] @ y[group == n]) / weights[:, group == n].sum(axis=1) for n in names])
    slope, height = np.polyfit(where, np.log(mean), 1)
    return height, slope


def _of_counts(x, broken, grains, weights, rounds=60):
    """(height, slope) (B,) of ln <broken/grains> for Poisson counts. With the best height for each slope, the likelihood is
    largest where the mean of x over the broken necks is that over all grains weighted with exp(slope x); Newton's method."""
    wanted = (weights @ (broken * x)) / (weights @ broken)
    slope = np.ones(len(weights))
    for _ in range(rounds):
        share = weights * grains * np.exp(slope[:, None] * (x - x.max()))
        share /= share.sum(axis=1, keepdims=True)
        mean = share @ x
        slope += np.clip((wanted - mean) / (share @ x**2 - mean**2), -0.5, 0.5)
    height = np.log((weights @ broken) / (weights * grains * np.exp(slope[:, None] * x)).sum(axis=1))
    return height, slope
