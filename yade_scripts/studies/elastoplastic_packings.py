"""What the packings of A24's study say before they collide. Needs no plugin, and runs nothing.

    python3 yade_scripts/studies/elastoplastic_packings.py fill RUNS.csv
        makes the packings of all rows again and writes what analysis.studies.elastoplastic.start measures of them into
        the table, where it has no such values (rows of runs that were measured without them)
    python3 yade_scripts/studies/elastoplastic_packings.py predict RUNS.csv FILE
        writes the predicted d_max of the pairs of a set of analysis.studies.elastoplastic.prediction.SETS, by the name of FILE,
        from their packings and the rows of RUNS.csv
    python3 yade_scripts/studies/elastoplastic_packings.py zones RUNS.csv
        prints how d_max at 10^0.5 m/s goes with the filling of zones of other depths and radii

A packing is a function of filling, radius, overlap, seed and index, so that these are the packings of the runs: fill
compares the offset of their centres of mass with the run's d(0), and stops where they differ.
"""

import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
from analysis.measures.compression import compression_length
from analysis.measures.contact_zone import zone_filling
from analysis.runs.table import read_table, table_text
from analysis.runs.write import require_file, write_text
from analysis.studies.elastoplastic import paper, prediction
from analysis.studies.elastoplastic.measure import COLUMNS
from analysis.studies.elastoplastic.start import COLUMNS as START
from analysis.studies.elastoplastic.start import start_values
from analysis.studies.elastoplastic.zone_fit import fit_slope
from yade_scripts.packings import contacts, cpe, moved

_SAME = 1e-9  # of the offset, in grain radii


# Depth and radius [R] of other zones than the one that is used.
ZONES = ((0.25, 0.25), (0.2, 0.2), (0.3, 0.3), (0.15, 0.3), (0.25, 0.35), (0.3, 0.2), (0.1, 0.25))


def packings_of(filling, radius, grain_radius, overlap, seed):
    """The two packings of a seed in their places, as they start; lengths in m."""
    reach = radius + grain_radius
    return [
        moved(cpe(filling, radius, grain_radius, overlap, seed, index), (side * reach, 0.0, 0.0))
        for index, side in ((0, -1), (1, 1))
    ]


def before_contact(filling, radius, grain_radius, overlap, seed):
    """(d(0) + 2 r [m], start.start_values) of the pair of aggregates of a seed; lengths in m."""
    pair = packings_of(filling, radius, grain_radius, overlap, seed)
    position = np.concatenate([packing.position for packing in pair])
    aggregate = np.repeat([0, 1], [packing.grains for packing in pair])
    pairs = np.concatenate([contacts(pair[0]), contacts(pair[1]) + pair[0].grains])
    offset = compression_length(position[:, 0], radius) + 2.0 * grain_radius
    return offset, start_values(position, aggregate, pairs, radius, grain_radius)


def fill(file):
    """Write the columns of start.COLUMNS into a table of runs that lacks them in places; the number of rows filled."""
    table, head = read_table(file, COLUMNS)
    names = [column.name for column in START]
    lacking = table[names].isna().any(axis=1)
    keys = ["filling", "radius", "grain_radius", "overlap", "seed"]
    for key, rows in table[lacking].groupby(keys):
        offset, values = before_contact(*key[:4], int(key[4]))
        if np.any(np.abs(rows.offset - offset) > _SAME * key[2]):
            sys.exit(f"{file}: seed {int(key[4])}: its packings are not those of {rows.run.iloc[0]}")
        table.loc[rows.index, names] = [values[name] for name in names]
    if lacking.any():
        write_text(file, table_text(table, COLUMNS, head))
    return int(lacking.sum())


def predict(runs, file):
    """Write predictions of the pairs of a set, that of the file's name, from a table of runs; theirs, once they are there, are
    never among them."""
    require_file(file, inputs=[runs])
    (chosen,) = (each for each in prediction.SETS if each.file == os.path.basename(file))
    table, _ = read_table(runs, COLUMNS)
    table = prediction.before(table, chosen)
    first, rows, means = table.iloc[0], [], {}
    radius = chosen.radius * first.grain_radius
    for filling in prediction.FILLINGS:
        model = prediction.fit(table, filling, chosen.velocity, chosen.covariate)
        for seed in chosen.seeds:
            offset, values = before_contact(filling, radius, first.grain_radius, first.overlap, seed)
            row = {"filling": filling, "radius": radius, "velocity": model.velocity, "seed": seed, "offset": offset}
            rows.append({**row, **values, **prediction.predict(model, chosen.radius, values[chosen.covariate])})
        x = [row[chosen.covariate] for row in rows if row["filling"] == filling]
        means[filling] = prediction.predict_mean(model, chosen.radius, x)
    prediction.write(file, rows, len(table), means, chosen.covariate)


def zones(runs):
    """Lines (str) with the correlation of d_max and the filling of each of ZONES, about the means of the sizes."""
    table, _ = read_table(runs, COLUMNS)
    table = table[(table.velocity / paper.VELOCITY - 1.0).abs() < 1e-3]
    found = {zone: [] for zone in ZONES}
    for row in table.itertuples():
        first, second = packings_of(row.filling, row.radius, row.grain_radius, row.overlap, row.seed)
        reach = np.array([row.radius + row.grain_radius, 0.0, 0.0])
        for zone, values in found.items():
            pair = ((first, -reach, 1.0), (second, reach, -1.0))
            values.append(np.mean([zone_filling(p.position, at, row.radius, side, *zone) for p, at, side in pair]))
    yield "depth, radius [R]: correlation with d_max by filling factor"
    for zone, values in found.items():
        own = table.assign(zone_filling=values)
        slopes = {filling: fit_slope(own[own.filling == filling]) for filling in sorted(own.filling.unique())}
        text = ", ".join(f"{f:g}: {s.correlation:.2f} +- {s.correlation_error:.2f}" for f, s in slopes.items() if s)
        yield f"{zone[0]:g}, {zone[1]:g}: {text}"


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "fill":
        print(f"{fill(arguments[1])} rows filled")
    elif len(arguments) == 3 and arguments[0] == "predict":
        names = [each.file for each in prediction.SETS]
        if os.path.basename(arguments[2]) not in names:
            sys.exit(f"{arguments[2]}: must be one of {', '.join(names)}")
        predict(*arguments[1:])
    elif len(arguments) == 2 and arguments[0] == "zones":
        for line in zones(arguments[1]):
            print(line)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
