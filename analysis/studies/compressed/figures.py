"""Where the work goes in both kinds of aggregates."""

from ..curve_figure import CurveFigure

LOST = {"channel": ("slidingDissipation", "rollingDissipation", "twistingDissipation"), "velocity": 10**0.5}
CAPTION = "Dissipated in each way until the largest compression, 3.16 m/s. Bars: standard errors."
FIGURES = (CurveFigure("channels", CAPTION, "channels", "channel", "kind", where=LOST, line="", y_label="% of $K(0)$"),)
