"""What two materials and two radii make of a contact (A22 eqs 1, 3, 6, 7, 14-26; K13 eq 2).

Unlike grains: 1/R = 1/r1 + 1/r2, 1/E* = sum (1 - nu^2)/E, 1/G* = sum (2 - nu)/G, 1/G' = sum 1/G; the surface energy
is the geometric mean, the critical rolling displacement and the viscous coefficient T_vis/nu^2 are arithmetic means;
zeta_crit = (G'/G*) a0/(16 pi), which is (2 - nu) a0/(16 pi) for equal materials; the time unit is that of two equal
grains of the same reduced radius and reduced mass (r = 2 R, m = 2 m*)."""

from dataclasses import dataclass
from functools import lru_cache
from math import pi, sqrt


@dataclass(frozen=True)
class Material:
    """Young's modulus [Pa], Poisson's ratio, density [kg/m^3], surface energy [J/m^2], xi_crit [m], T_vis [s]."""

    young: float
    poisson: float
    density: float
    surface_energy: float
    critical_rolling: float
    viscoelastic_time: float = 0.0

    @property
    def shear(self):
        """G = E/(2 (1 + nu)) [Pa]."""
        return self.young / (2.0 * (1.0 + self.poisson))

    @property
    def viscous_coefficient(self):
        """T_vis/nu^2 [s] of A22 eq 7."""
        return self.viscoelastic_time / self.poisson**2 if self.viscoelastic_time else 0.0


ICE = Material(young=7e9, poisson=0.25, density=1000.0, surface_energy=0.1, critical_rolling=0.8e-9)  # A22 Table 1
SILICATE = Material(young=54e9, poisson=0.17, density=2650.0, surface_energy=0.02, critical_rolling=2e-9)  # K13
MATERIALS = {"ice": ICE, "silicate": SILICATE}
# m, of the papers; a run and the atlas take it where none is given
GRAIN_RADIUS = {"ice": 0.1e-6, "silicate": 0.6e-6}
GRAIN_RADII = 1e-9, 1e-3  # m, from the smallest soot monomers to chondrules


@dataclass(frozen=True)
class PairConstants:
    """Constants of a contact, SI. Field by field the names of the plugin's pairConstants(), written with
    underscores."""

    reduced_radius: float  # R [m]
    reduced_mass: float  # m* [kg]
    reduced_young: float  # E* [Pa], A22 after eq 1
    reduced_shear: float  # G* [Pa], A22 after eq 18
    equilibrium_contact_radius: float  # a0 [m], A22 eq 1
    equilibrium_overlap: float  # delta0 [m], A22 after eq 2
    pull_off_overlap: float  # delta_c > 0 [m], A22 eq 3
    pull_off_force: float  # F_c [N], A22 eq 6
    rolling_stiffness: float  # k_r [N/m], A22 eq 14
    sliding_stiffness: float  # k_s [N/m], A22 eq 18
    twisting_stiffness: float  # k_t [N m], A22 eq 23
    critical_sliding: float  # zeta_crit [m], A22 eq 19
    critical_rolling: float  # xi_crit [m]
    critical_twisting: float  # phi_crit, A22 eq 24
    drag_per_contact_radius: float  # 2 T_vis E*/nu^2 [N s/m^2], A22 eq 7
    linear_drag: float  # k_n m0/t0 [N s/m], K13 eq 4
    time_unit: float  # t0 [s], K13 eq 2 with E*
    spring_damping: float = 0.0  # c of the springs' damping [s]


def time_unit(density, radius, reduced_young, surface_energy):
    """t0 [s] = 0.95 rho^(1/2) r^(7/6) E*^(-1/3) gamma^(-1/6): K13 eq 2, with E* where E is printed (density [kg/m^3],
    radius [m], E* [Pa], surface energy [J/m^2])."""
    return 0.95 * density**0.5 * radius ** (7.0 / 6.0) / (reduced_young ** (1.0 / 3.0) * surface_energy ** (1.0 / 6.0))


def mixed_surface_energy(material1, material2, factor=1.0):
    """gamma [J/m^2] of a contact: the geometric mean of two Material, times a factor where they are unlike."""
    mean = sqrt(material1.surface_energy * material2.surface_energy)
    return mean if material1 == material2 else factor * mean


def pair_constants(
    material1,
    radius1,
    material2=None,
    radius2=None,
    linear_damping=0.0,
    sliding_factor=1.0,
    rolling_factor=1.0,
    spring_damping=0.0,
    mixed_factor=1.0,
):
    """Constants of the contact of two grains, or of a grain and a plane.

    Parameters
    ----------
    material1, material2 : Material
        The second one equals the first if left out.
    radius1, radius2 : float [m]
        The second one is infinite for a plane, and equals the first if left out.
    linear_damping : float
        K13's k_n.
    sliding_factor : float
        k_s over 8 a0 G*; 2 as in S17's eqs 11 and 12.
    rolling_factor : float
        k_r over 4 F_c/R.
    spring_damping : float [s]
        c of the springs' damping.
    mixed_factor : float
        gamma of two unlike materials over the geometric mean of theirs.

    Returns
    -------
    PairConstants
    """
    material2 = material1 if material2 is None else material2
    radius2 = radius1 if radius2 is None else radius2
    both = (material1, material2)
    R = 1.0 / (1.0 / radius1 + 1.0 / radius2)
    masses = [4.0 / 3.0 * pi * m.density * r**3 for m, r in zip(both, (radius1, radius2))]
    reduced_mass = 1.0 / sum(1.0 / m for m in masses)
    young = 1.0 / sum((1.0 - m.poisson**2) / m.young for m in both)
    sliding_shear = 1.0 / sum((2.0 - m.poisson) / m.shear for m in both)
    twisting_shear = 1.0 / sum(1.0 / m.shear for m in both)
    gamma = mixed_surface_energy(material1, material2, mixed_factor)

    a0 = (9.0 * pi * gamma * R * R / young) ** (1.0 / 3.0)
    delta0 = a0 * a0 / (3.0 * R)
    pull_off_force = 3.0 * pi * gamma * R
    density = 2.0 * reduced_mass / (4.0 / 3.0 * pi * (2.0 * R) ** 3)
    t0 = time_unit(density, 2.0 * R, young, gamma)
    return PairConstants(
        reduced_radius=R,
        reduced_mass=reduced_mass,
        reduced_young=young,
        reduced_shear=sliding_shear,
        equilibrium_contact_radius=a0,
        equilibrium_overlap=delta0,
        pull_off_overlap=(9.0 / 16.0) ** (1.0 / 3.0) * delta0,
        pull_off_force=pull_off_force,
        rolling_stiffness=rolling_factor * 4.0 * pull_off_force / R,
        sliding_stiffness=sliding_factor * 8.0 * a0 * sliding_shear,
        twisting_stiffness=16.0 / 3.0 * twisting_shear * a0**3,
        critical_sliding=twisting_shear / sliding_shear * a0 / (16.0 * pi),
        critical_rolling=0.5 * sum(m.critical_rolling for m in both),
        critical_twisting=1.0 / (16.0 * pi),
        drag_per_contact_radius=young * sum(m.viscous_coefficient for m in both),
        linear_drag=linear_damping * 2.0 * reduced_mass / t0,
        time_unit=t0,
        spring_damping=spring_damping,
    )


def interaction_energies(pair):
    """The energies of A22 Table 2 [J] as a dict.

    unit F_c delta_c (eqs 3, 6), break (12), roll_critical (15), roll (16), slide_critical (20), slide (21: the
    product; the printed number is pi times it), twist_critical (25), twist (26)."""
    unit = pair.pull_off_force * pair.pull_off_overlap
    rolling, sliding, twisting = pair.rolling_stiffness, pair.sliding_stiffness, pair.twisting_stiffness
    quarter_turn = pi * pair.reduced_radius
    return {
        "unit": unit,
        "break": (4.0 / 45.0 + 0.8 * 6.0 ** (1.0 / 3.0)) * unit,
        "roll_critical": 0.5 * rolling * pair.critical_rolling**2,
        "roll": rolling * pair.critical_rolling * quarter_turn,
        "slide_critical": 0.5 * sliding * pair.critical_sliding**2,
        "slide": sliding * pair.critical_sliding * quarter_turn,
        "twist_critical": 0.5 * twisting * pair.critical_twisting**2,
        "twist": twisting * pair.critical_twisting * pi / 2.0,
    }


@lru_cache
def breaking_velocity(material, radius):
    """v_break = (E_break/m0)^(1/2) [m/s] of grains of a Material and a radius [m], with m0 the mass of one and
    E_break of A22 eq 12."""
    constants = pair_constants(material, radius)
    return (interaction_energies(constants)["break"] / (2 * constants.reduced_mass)) ** 0.5
