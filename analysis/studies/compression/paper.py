"""The numbers that K13 gives. It states no errors; its lines are means over ten clusters each."""

from math import isclose

from ...theory import ICE, SILICATE

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


def _grains(material, radius):
    """By the names of scene.OF_GRAINS."""
    return {
        "grainRadius": radius,
        "young": material.young,
        "poisson": material.poisson,
        "density": material.density,
        "surfaceEnergy": material.surface_energy,
        "criticalRolling": material.critical_rolling,
        "slidingStiffnessFactor": 1.0,
    }


# Table 1 and section 2.1.
GRAINS = {"ice": _grains(ICE, 0.1e-6), "silicate": _grains(SILICATE, 0.6e-6)}

# Section 3.7, silicate at this pressure [Pa]: filling factors of K13, of Seizinger et al. (2012), and of the experiments'
# formula of Guettler et al. (2009).
SILICATE_PRESSURE = 300.0
SILICATE_FILLINGS = {"K13": 0.24, "Seizinger et al. (2012)": 0.21, "Guettler et al. (2009)": 0.17}


def other_grains(parameters):
    """[name] of what differs from K13's grains of that material, parameters: a mapping with material and scene.OF_GRAINS;
    all names for a material that K13 does not have."""
    theirs = GRAINS.get(parameters["material"], {})
    names = next(iter(GRAINS.values()))
    return [n for n in names if n not in theirs or not isclose(parameters[n], theirs[n], rel_tol=1e-6)]


def has_k13s_grains(parameters):
    """Whether parameters (as other_grains() takes them) are of K13's grains of that material, xi_crit included."""
    return not other_grains(parameters)


def has_fiducial_grains(parameters):
    """Whether parameters are of K13's ice with its fiducial damping; number of grains and C_v may differ."""
    same = isclose(parameters["linearDamping"], FIDUCIAL["linearDamping"], rel_tol=1e-6)
    return parameters["material"] == "ice" and has_k13s_grains(parameters) and same
