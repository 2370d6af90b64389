"""The numbers that S17 gives, with section or figure. Where only a statement is printed, it stands as limits."""

GRAINS = 1024  # of each aggregate (section 4)
RUNS = 5  # a point (section 4)
NECKS = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7)  # beta; 0.123 is an unsintered contact
GROWTH_VELOCITIES = (1, 2, 3, 4, 5, 7.5, 10, 15, 20)  # V_g [m/s] for xi_crit = 2 Angstrom
PERIODS = 20_000  # the last time of Fig. 7, in periods of the stretching vibration
SLOW = 10**0.5  # m/s, printed as 3.2

# (beta, V_c [m/s], least, most): sticking efficiency of BCCA aggregates, sections 5.1 and 5.3.
STICKING_EFFICIENCY = (
    (0.0, 10.0, 0.95, 1.0, "perfect sticking (section 5.1)"),
    (0.0, 30.0, 0.9, 1.0, "close to unity (section 5.1)"),
    (0.0, 50.0, 0.5, 1.0, "growth, more than 0.5 (Fig. 8)"),
    (0.7, SLOW, 0.95, 1.0, "sticking at <= 3.2 m/s (section 5.1)"),
    (0.7, 15.0, None, 0.9, "substantial disruption (Fig. 8)"),
    (0.7, 30.0, 0.0, 0.5, "total rupture (Fig. 7)"),
    (0.2, 30.0, 0.5, 1.0, "almost as unsintered (section 5.1)"),
    (0.4, 30.0, 0.5, 1.0, "growth for beta <= 0.4 (section 5.3)"),
    (0.5, 30.0, 0.0, 0.5, "no growth above beta = 0.5 (section 5.3)"),
)
# V_c [m/s] above which beta = 0.7 has this efficiency, "approximately" (section 5.2, for V_g = 0 and 1 m/s).
BROKEN_ABOVE, BROKEN_EFFICIENCY = 10.0, 0.2
CRITICAL_VELOCITIES = {0.0: 50.0, 0.7: 20.0}  # for growth, m/s, by beta (abstract)
BOUNCES = (2, 5)  # bounced, runs: beta = 0.7, 10 m/s (section 5.4)
# V_g = V_c [m/s], least beta at which only bouncing is seen (None: sticking at all), xi_crit = 2 Angstrom: section 5.3, Fig. 13.
COMPACTED = ((1.0, None), (3.0, 0.3), (5.0, 0.3))
UNSINTERED_COMPACTED = 3.0  # V_g = V_c [m/s] at which "the non-sintered aggregates stick perfectly" (Fig. 9)
# beta = 0.7, Fig. 10 (section 5.2), as (V_g, V_c) [m/s]: those that stick, and those whose "collisional outcome is bouncing". "Above
# 30 m/s fragmentation occurs", and of V_g = 0 and 1 m/s the efficiency above BROKEN_ABOVE is BROKEN_EFFICIENCY.
COMPACTED_STICKING = ((1.0, SLOW),)
COMPACTED_BOUNCING = tuple((growth, velocity) for growth in (3.0, 10.0) for velocity in (SLOW, 10.0))
COMPACTED_BROKEN = ((3.0, 30.0), (10.0, 30.0))

ROLLING_FRACTION = 0.8  # of K(0), unsintered at 10 m/s (Fig. 14)
DISCONNECTION_FRACTION = 0.2  # of K(0), by breaking unsintered necks through stretching, there (Fig. 14)
WEAK_NECK_FRACTION = 0.2  # of "the kinetic energy", by breaking necks of beta = 0.2 through rolling at 10 m/s (Fig. 14)
UNDISSIPATED = (
    0.4  # of K(0): kinetic and elastic energy at beta = 0.5, 10 m/s, at a time that isn't printed (section 5.3)
)
BY_ROLLING = 0.9  # of the broken necks, at least (section 5.3)
FIT = (3.7e-2, 0.97)  # N_cut/N_t = c (E_k/E_sint)^p, without BCCA aggregates of beta = 0.2 (Fig. 15)
CONTACTS_SAID = "approximately two at low V_g and three at high V_g (Fig. 6)"
FEWER_FRAGMENTS = (3.0, 10.0)  # V_g [m/s] of fewer fragments than BCCA's; at 1 almost as many (section 5.3)
FRAGMENT = 0.25  # of the total mass: lighter pieces are fragments (section 5.3)
LOOP_SIZE = 44  # grains in a loop of BCCA aggregates, beta = 0.7, 10 m/s, on average (section 5.4)
LOOP_GRAINS = 22  # N of eq 18 in a BCCA aggregate that has formed loops (section 5.4)
BASE = 100  # L of a BCCA aggregate's chains in grain radii (section 5.4)
