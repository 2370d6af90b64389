"""A22's grid of velocities, offsets and T_vis: numbers that a table rounds are those of the grid.

Without it 50.1 m/s and 10^1.7 m/s would be two velocities to some means and one to others, and a pair of aggregates that
has run at both would count twice."""

from math import log10


def velocity_of_grid(velocity):
    """10^(0.1 i) m/s (A22 section 2.4) where a velocity [m/s] is that to 0.2 %: 50.1 for 10^1.7; 20 for 10^1.3 would be 0.24 %.

    >>> velocity_of_grid(50.1) == 10 ** (0.1 * 17), velocity_of_grid(45.0)
    (True, 45.0)
    """
    nearest = 10 ** (0.1 * round(10 * log10(velocity))) if velocity > 0 else velocity
    return nearest if abs(velocity - nearest) < 2e-3 * nearest else velocity


def offset_of_grid(offset):
    """(k/12)^(1/2) where B_off is that to 0.001, else B_off.

    >>> offset_of_grid(0.2887) == (1 / 12) ** 0.5, offset_of_grid(0.3)
    (True, 0.3)
    """
    nearest = (round(12 * offset**2) / 12) ** 0.5
    return nearest if abs(offset - nearest) < 1e-3 else offset


def time_of_grid(viscous_time):
    """T_vis [s] to a ten-thousandth of a picosecond.

    >>> time_of_grid(6.00000001e-12)
    6e-12
    """
    return round(viscous_time, 16)
