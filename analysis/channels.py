"""Names of the energy channels [J], in the order used everywhere. Their sum is constant in time."""

STORED = ("kinetic", "normal", "sliding", "rolling", "twisting")
DISSIPATED = (
    "slidingDissipation",
    "rollingDissipation",
    "twistingDissipation",
    "connection",
    "disconnection",
    "drag",
    "bondBreaking",
)
CHANNELS = STORED + DISSIPATED

LABELS = {
    "kinetic": "kinetic",
    "normal": "normal (JKR potential)",
    "sliding": "sliding, stored",
    "rolling": "rolling, stored",
    "twisting": "twisting, stored",
    "slidingDissipation": "sliding dissipation",
    "rollingDissipation": "rolling dissipation",
    "twistingDissipation": "twisting dissipation",
    "connection": "connection",
    "disconnection": "disconnection",
    "drag": "drag",
    "bondBreaking": "bond breaking",
}
