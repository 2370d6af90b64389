"""How much is measured: everything, a shortened version (--quick), or as little as shows that it works (--tiny, for the tests)."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Settings:
    """Lengths in grain radii, times in s, steps of the error in t0."""

    radii: tuple = (20, 25.4, 32, 40, 50.4, 64, 80)  # of aggregates: 6,400 ... 409,600 grains, twice as many each time
    reference: float = 40  # where codes and kinds of grains are compared
    loop_radii: tuple = (20, 40)  # where YADE's own loops, which are slow, and slower instruction sets are measured
    through: tuple = (
        (40, 10.0, 300e-9),
        (20, 60.0, 120e-9),
    )  # radius, speed [m/s], duration: one sticks, one ends in fragments
    parts: int = 10  # of each of these collisions
    rounds: int = 5
    seconds: float = 1.5  # of one measurement
    stretch: float = 0.05  # fraction of a run's small steps that measuring a moment may take
    peer_rounds: int = 3
    peer_steps: int = 100  # at most
    skins: tuple = (0.3, 0.6, 1.0)  # of a peer's lists [grain radii], of which its best counts
    sampled: float = 3.0  # seconds of one thread for the parts of the engine's time
    error_radius: float = 20
    error_duration: float = 130e-9  # maximum compression is at about 100 ns
    error_steps: tuple = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
    error_seeds: tuple = (1, 2, 3)
    gaps: int = 12  # initial gaps of the pair
    compression_grains: int = 256
    compression_rate: float = 1e-5  # 1/t0
    compression_seeds: tuple = (1, 2, 3, 4, 5, 6)

    def text(self):
        """What a measurement of speed depends on, for a table's cell."""
        names = ("rounds", "seconds", "stretch", "peer_rounds", "peer_steps", "skins", "sampled")
        return " ".join(f"{name}={getattr(self, name)}".replace(" ", "") for name in names)


FULL = Settings()
QUICK = replace(
    FULL,
    radii=(20, 40),
    through=((20, 10.0, 100e-9), (20, 60.0, 60e-9)),
    rounds=2,
    seconds=0.5,
    stretch=0.03,
    peer_rounds=1,
    peer_steps=30,
    skins=(0.6,),
    sampled=1.0,
    error_steps=(0.05, 0.1, 0.2, 0.4, 0.5),
    error_seeds=(1,),
    compression_seeds=(1, 2),
)
TINY = replace(
    QUICK,
    radii=(4, 5),
    reference=5,
    loop_radii=(5,),
    through=((5, 60.0, 8e-9),),
    parts=2,
    seconds=0.03,
    peer_steps=20,
    sampled=0.2,
    error_radius=4,
    error_duration=2e-9,
    error_steps=(0.1, 0.2, 0.4, 0.5),
    gaps=2,
    compression_grains=64,
    compression_rate=1e-4,
)
