"""The numbers that A22 gives. It states no errors, and has one run of each parameter set."""

from types import MappingProxyType

GRAINS = 50_000  # of each aggregate
CHARACTERISTIC_RADII = (72.29, 72.25)  # grain radii, of target and projectile (section 2.4)
SQUARES = tuple(i / 12 for i in range(13))  # B_off^2
EXPONENTS = tuple(range(13, 21))  # i of v_col = 10^(0.1 i) m/s
VISCOUS_TIMES = (0.0, 1e-12, 3e-12, 6e-12)  # T_vis [s]
DURATION = 6.34e-6  # s: the last time of Fig. 1
# r_c that the aggregates' centres would go at v_col until then, at the slowest of EXPONENTS and 1e-7 m grains: 17.5
RADII_TRAVELLED = 10 ** (0.1 * EXPONENTS[0]) * DURATION / (0.5 * sum(CHARACTERISTIC_RADII) * 1e-7)

# What most figures show: v_col = 50.1 m/s, B_off^2 = 3/12.
VELOCITY, SQUARE = 10**1.7, 3 / 12
LARGEST = MappingProxyType({0.0: 43957, 1e-12: 44927, 3e-12: 46263, 6e-12: 47919})  # N_lar there (section 3.1)
SNAPSHOTS = (0.0, 0.32e-6, 0.63e-6, 1.27e-6)  # s: Fig. 1 (a)-(d)
PAIR_TIMES = (0.32e-6, 0.63e-6)  # s: Figs. 10, 11

V_FRA = 50.0, 60.0  # m/s (section 3.2)
STICKING_RATIO = 10.0  # v_stick of 6 ps over that of 0 ps, "approximately" (section 3.3)
EXPONENT, AMPLITUDE = 1.0, 1.0  # f(N) = c N^-alpha, for arbitrary N at FITTED_TIME and v_col around v_fra (eqs 35, 36)
FITTED_TIME = 6e-12  # s
LARGE = 100  # grains: for N much larger N_cum ~ N, that is alpha = 1, at all T_vis > 0 (section 3.4)
PAIR_SPEED = 1.0  # m/s: the largest rms of v_rel stays below it with drag (section 5.1)
FAST_PAIRS = 1e3 / (2 * GRAINS)  # N_pair,p(> 10 m/s) and N_pair,n(< -10 m/s) over N_tot are less (section 5.1)
# m/s between which f_gro = 1 at B_off = 0 (section 3.2): "20" and 100 of the paper's grid.
HEAD_ON = 10 ** (0.1 * EXPONENTS[0]), 10 ** (0.1 * EXPONENTS[-1])
