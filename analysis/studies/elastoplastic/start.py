"""What is known of a pair of aggregates before it collides: columns of the table of runs that the packings alone give."""

import numpy as np

from ...measures.contact_zone import DEPTH, WIDTH, bond_direction, loose_fraction, rigid_approach, zone_filling
from ...runs.table import Column

# Pairs of grains, over R/r: 100 at R = 40. Chosen by the six pairs there that collide at 1 to 2 m/s.
OVERLAPPING = 2.5

COLUMNS = (
    Column(
        "zone_filling",
        "",
        f"grains per volume in the two zones that meet, {DEPTH:g} R deep and {WIDTH:g} R in radius about the contact poles, "
        "over that of the whole aggregates; mean of the two",
        gaps=True,
        absent=np.nan,
    ),
    Column(
        "bond_direction",
        "",
        "mean cos^4 of the angle between contacts and collision axis, 1/5 for contacts of all directions",
        gaps=True,
        absent=np.nan,
    ),
    Column(
        "rigid_touch",
        "m",
        f"compression length at which {OVERLAPPING:g} R/r pairs of grains would overlap, if rigid aggregates approached",
        gaps=True,
        absent=np.nan,
    ),
    Column(
        "loose_grains", "", "fraction of grains outside the largest piece of their aggregate", gaps=True, absent=np.nan
    ),
)


def start_values(position, aggregate, contact_pairs, radius, grain_radius):
    """{column: value} of COLUMNS of two aggregates before they touch: position (N,3) [m], aggregate (N,) 0 or 1,
    contact_pairs (M,2), radius of the aggregates and of a grain [m]; their centres stand at -+(R + r) on the x axis."""
    position, aggregate = np.asarray(position, dtype=float), np.asarray(aggregate)
    pairs = np.asarray(contact_pairs, dtype=np.intp).reshape(-1, 2)
    touch = rigid_approach(
        position[aggregate == 0],
        position[aggregate == 1],
        2.0 * grain_radius,
        round(OVERLAPPING * radius / grain_radius),
    )
    found = []
    for number, side in ((0, 1.0), (1, -1.0)):
        own = aggregate == number
        # Rows of this aggregate's grains, counted from 0.
        row = np.cumsum(own) - 1
        inside = row[pairs[own[pairs].all(axis=1)]]
        centre = np.array([-side * (radius + grain_radius), 0.0, 0.0])
        found.append(
            (
                zone_filling(position[own], centre, radius, side),
                bond_direction(position[own], inside),
                touch - 2.0 * grain_radius,  # they start 2 r apart
                loose_fraction(int(own.sum()), inside),
            )
        )
    return dict(zip((column.name for column in COLUMNS), map(float, np.mean(found, axis=0))))
