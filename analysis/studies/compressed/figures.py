"""How much softer compressed aggregates are, and where the work goes in both kinds."""

from ..curve_figure import CurveFigure

LOST = ("slidingDissipation", "rollingDissipation", "twistingDissipation")
FIGURES = (
    CurveFigure(
        "ratio",
        "Compression from the first touch to d_max, compressed over CPE aggregates. Bars: standard errors.",
        "compression_ratio",
        "velocity",
        "nominal",
        logarithmic="x",
        y_label="compressed over CPE",
        level_line=1.0,
        apart=4.0,
    ),
    CurveFigure(
        "channels",
        "Dissipated in each way until d_max, at a filling factor of 0.4. Bars: standard errors.",
        "channels",
        "velocity",
        "channel",
        "kind",
        {"channel": LOST, "nominal": 0.4},
        logarithmic="x",
        y_label="% of $K(0)$",
    ),
)
