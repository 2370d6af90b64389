"""The numbers that K13 gives. It states no errors; its lines are means over ten clusters each."""

from math import isclose

from ..grains import other_grains

SEEDS = 10
EXPONENT = 3.0  # eqs 23, 25
SCALE = 4.74e5  # P0 [Pa] of ice, section 3.1
VALID_TO = 0.1  # the filling factor up to which eq 25 holds
# Where K13 draws the structure (Fig. 11).
STRUCTURE_FILLINGS = (0.003, 0.01, 0.03, 0.1)
DIMENSION = 2.0  # D inside the clusters, section 3.6

# Section 3.1: N, C_v, k_n of the fiducial runs of ice.
FIDUCIAL = {"grains": 16384, "strainRate": 3e-7, "linearDamping": 0.01}
# Section 3.5: up to this xi_crit [m] rolling dissipates most, and eq 25 holds.
LARGEST_ROLLING = 0.8e-9

# Section 3.7, silicate at this pressure [Pa]: filling factors of K13, of Seizinger et al. (2012), and of the experiments'
# formula of Guettler et al. (2009).
SILICATE_PRESSURE = 300.0
SILICATE_FILLINGS = {"K13": 0.24, "Seizinger et al. (2012)": 0.21, "Guettler et al. (2009)": 0.17}


def has_k13s_grains(parameters):
    """Whether parameters (as grains.other_grains() takes them) are of K13's grains of that material, xi_crit included."""
    return not other_grains(parameters)


def has_fiducial_grains(parameters):
    """Whether parameters are of K13's ice with its fiducial damping; number of grains and C_v may differ."""
    same = isclose(parameters["linearDamping"], FIDUCIAL["linearDamping"], rel_tol=1e-6)
    return parameters["material"] == "ice" and has_k13s_grains(parameters) and same
