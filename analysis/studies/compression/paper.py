"""The numbers that K13 gives. It states no errors; its lines are means over ten clusters each."""

from math import isclose

SEEDS = 10
EXPONENT = 3.0  # eqs 23, 25
SCALE = 4.74e5  # P0 [Pa] of ice, section 3.1
VALID_TO = 0.1  # the filling factor up to which eq 25 holds
# Where K13 draws the structure (Fig. 11).
STRUCTURE_FILLINGS = (0.003, 0.01, 0.03, 0.1)
DIMENSION = 2.0  # D inside the clusters, section 3.6

# Section 3.1: N, C_v, k_n, xi_crit [m] of the fiducial runs of ice.
FIDUCIAL = {"grains": 16384, "strainRate": 3e-7, "linearDamping": 0.01, "criticalRolling": 0.8e-9}
# Section 3.5: up to this xi_crit [m] rolling dissipates most, and eq 25 holds.
LARGEST_ROLLING = 0.8e-9

# Section 3.7, silicate at this pressure [Pa]: filling factors of K13, of Seizinger et al. (2012), and of the experiments'
# formula of Guettler et al. (2009).
SILICATE_PRESSURE = 300.0
SILICATE_FILLINGS = {"K13": 0.24, "Seizinger et al. (2012)": 0.21, "Guettler et al. (2009)": 0.17}
SILICATE_RADIUS = 0.6e-6  # m


def is_fiducial(parameters):
    """Whether parameters (a mapping with FIDUCIAL's names) are those of K13's fiducial runs."""
    return all(isclose(parameters[name], value, rel_tol=1e-6) for name, value in FIDUCIAL.items())
