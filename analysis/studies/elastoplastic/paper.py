"""The numbers that A24 gives. It states no errors; like ours its points are means over seeds (ten of
each)."""

from math import sqrt
from types import MappingProxyType

VELOCITY = sqrt(10.0)  # 10^0.5 m/s, printed as 3.2 m/s
SEEDS = 10
C1, C2 = 5.66e-2, 0.527  # eq 14, filling 0.4

# By filling: delta_offset [grain radii] (eqs 18, 20), delta_max/R* at VELOCITY (19, 21), yield stress and E* [Pa]
# (34, 35).
OFFSET = MappingProxyType({0.4: 0.271, 0.3: -0.010})
RATIO = MappingProxyType({0.4: 0.113, 0.3: 0.199})
YIELD_STRESS = MappingProxyType({0.4: 2.25e6, 0.3: 0.428e6})
YOUNG = MappingProxyType({0.4: 15.7e6, 0.3: 4.96e6})

# At filling 0.4: where Fig. 10 becomes elastic (section 4.3.2), and section 5.1 (eqs 41, 43).
YOUNG_IF_ELASTIC, LEAST_YIELD_STRESS, ELASTIC_FROM = 14.6e6, 1.67e6, 3.13e6
BULK_MODULUS, POISSON_RATIO = 74.3e6, 0.443


def line(filling):
    """(c1, c2) of d_max = c1 R - c2 r (eq 14): printed for filling 0.4, for others from eqs 18-21 backwards;
    None where the paper has none."""
    if filling == 0.4:
        return C1, C2
    if filling in OFFSET:
        c1 = 0.5 * RATIO[filling]
        return c1, OFFSET[filling] * (2.0 - c1)
    return None
