"""Where the work goes in both kinds of aggregates."""

from ..curve_figure import CurveFigure

SHOWN = ("slidingDissipation", "rollingDissipation", "twistingDissipation")
CAPTION = "Dissipated until the largest compression. Bars: standard errors."
FIGURES = (
    CurveFigure(
        "channels", CAPTION, "channels", "velocity", "kind", "channel", {"channel": SHOWN}, y_label="% of $K(0)$"
    ),
)
