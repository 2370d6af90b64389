"""How much is measured: everything, a shortened version (--quick), or as little as shows that it works (--tiny, for the tests)."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Settings:
    """Lengths in grain radii, times in s, steps of the error in t0."""

    radii: tuple = (20, 25.4, 32, 40, 50.4, 64, 80)  # of aggregates: 6,400 ... 409,600 grains, twice as many each time
    reference: float = 40  # where codes and kinds of grains are compared; slow codes also at the first of the radii
    through: tuple = ((40, 10.0, 300e-9), (20, 60.0, 120e-9))  # radius, speed [m/s], duration: sticking, and fragments
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
    seeds: int = 3  # of the error's collisions
    rung: tuple = (20, 40, (104, 36, 26, 13, 7))  # radius, moments, small steps from one to the next
    met: tuple = (416, 104, 52, 26, 13, 7)  # the same of pairs

    def text(self):
        """What a measurement of speed depends on, for a table's cell."""
        names = ("rounds", "seconds", "stretch", "peer_rounds", "peer_steps", "skins", "sampled")
        return " ".join(f"{name}={getattr(self, name)}".replace(" ", "") for name in names)


FULL = Settings()
QUICK = replace(FULL, radii=(20, 40), through=FULL.through[1:], error_steps=(0.05, 0.1, 0.2, 0.4, 0.5), seeds=1)
QUICK = replace(QUICK, rounds=2, seconds=0.5, stretch=0.03, peer_rounds=1, peer_steps=30, skins=(0.6,), sampled=1.0)
TINY = replace(QUICK, radii=(4, 5), reference=5, through=(), seconds=0.03, peer_steps=20, sampled=0.2)
TINY = replace(TINY, error_radius=4, error_duration=2e-9, error_steps=(0.1, 0.2, 0.4, 0.5))
TINY = replace(TINY, rung=(4, 4, (26, 13, 7)), met=(26, 13, 7))
