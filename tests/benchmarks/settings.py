"""How much make bench measures: everything, a shortened version (--quick), or as little as shows that it works (--tiny, for its tests)."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Settings:
    """Lengths in grain radii, times in s; steps of the error in t0."""

    radii: tuple = (20, 25.4, 32, 40, 50.4, 64, 80)  # 6,400 ... 409,600 grains, twice as many each time
    reference: float = 40  # where codes and kinds of grains are compared
    loop_radii: tuple = (20, 40)  # of YADE's own loops, which are slow
    instruction_radii: tuple = (20, 40)
    rounds: int = 3
    seconds: float = 1.5  # of one measurement of the engine
    loop_seconds: float = 4.0  # of one of YADE's loops
    peer_steps: int = 200
    collisions: tuple = (
        (40, 10.0, 300e-9),
        (20, 60.0, 120e-9),
    )  # size, speed [m/s], duration of those whose parts are measured; one sticks, one ends in fragments
    collision_parts: int = 10
    error_radius: float = 20
    error_duration: float = 130e-9  # maximum compression is at about 100 ns
    error_steps: tuple = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
    error_seeds: tuple = (1, 2, 3)
    fit: tuple = (0.02, 0.2)  # steps between which the order of convergence is fitted
    gaps: int = 12  # initial gaps of the pair


FULL = Settings()
QUICK = replace(
    FULL,
    radii=(20, 40),
    rounds=2,
    seconds=0.7,
    loop_seconds=2.0,
    peer_steps=60,
    collisions=((20, 10.0, 100e-9), (20, 60.0, 60e-9)),
    error_steps=(0.05, 0.1, 0.2, 0.4, 0.5),
    error_seeds=(1,),
    fit=(0.1, 0.4),
)
TINY = replace(
    FULL,
    radii=(4, 5),
    reference=5,
    loop_radii=(5,),
    instruction_radii=(5,),
    rounds=1,
    seconds=0.05,
    loop_seconds=0.05,
    peer_steps=20,
    collisions=((5, 60.0, 8e-9),),
    collision_parts=2,
    error_radius=4,
    error_duration=2e-9,
    error_steps=(0.1, 0.2, 0.4, 0.5),
    error_seeds=(1,),
    fit=(0.1, 0.4),
    gaps=2,
)
