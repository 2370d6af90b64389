"""Where the work goes in both kinds of aggregates."""

from ..curve_figure import CurveFigure

LOST = {"channel": ("slidingDissipation", "rollingDissipation", "twistingDissipation")}
CAPTION = "Dissipated in each way until the largest compression. Bars: standard errors."
AXES = ("channel", "kind", "velocity")
FIGURES = (CurveFigure("channels", CAPTION, "channels", *AXES, LOST, line="", y_label="% of $K(0)$"),)
