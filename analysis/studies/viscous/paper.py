"""The numbers that A22 gives. It states no errors, and has one run of each parameter set."""

from types import MappingProxyType

GRAINS = 50_000  # of each aggregate
CHARACTERISTIC_RADII = (72.29, 72.25)  # grain radii, of target and projectile (section 2.4)
SQUARES = tuple(i / 12 for i in range(13))  # B_off^2
EXPONENTS = tuple(range(13, 21))  # i of v_col = 10^(0.1 i) m/s
VISCOUS_TIMES = (0.0, 1e-12, 3e-12, 6e-12)  # T_vis [s]
DURATION = 6.34e-6  # s: the last time of Fig. 1

# What most figures show: v_col = 50.1 m/s, B_off^2 = 3/12.
VELOCITY, SQUARE = 10**1.7, 3 / 12
LARGEST = MappingProxyType({0.0: 43957, 1e-12: 44927, 3e-12: 46263, 6e-12: 47919})  # N_lar there (section 3.1)
SNAPSHOTS = (0.0, 0.32e-6, 0.63e-6, 1.27e-6)  # s: Fig. 1 (a)-(d)
PAIR_TIMES = (0.32e-6, 0.63e-6)  # s: Figs. 10, 11

V_FRA = 50.0, 60.0  # m/s (section 3.2)
STICKING_RATIO = 10.0  # v_stick of 6 ps over that of 0 ps, "approximately" (section 3.3)
EXPONENT, AMPLITUDE = 1.0, 1.0  # f(N) = c N^-alpha for 6 ps (eqs 35, 36)
PAIR_SPEED = 1.0  # m/s: the largest rms of v_rel stays below it with drag (section 5.1)
HEAD_ON = 20.0, 100.0  # m/s between which f_gro = 1 at B_off = 0 (section 3.2)
