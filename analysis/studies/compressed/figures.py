"""Where the work goes in both kinds of aggregates."""

from ..curve_figure import CurveFigure

LOST = {"channel": ("slidingDissipation", "rollingDissipation", "twistingDissipation")}
CAPTION = "Dissipated until the largest compression. Bars: standard errors."
FIGURES = (CurveFigure("channels", CAPTION, "channels", "velocity", "kind", "channel", LOST, y_label="% of $K(0)$"),)
