"""What estimates depend on: how a table and a figure name it, in one list."""

import re
from dataclasses import dataclass

SI = {"%": 0.01, "ns": 1e-9, "ps": 1e-12, "µs": 1e-6, "Å": 1e-10, "kPa": 1e3, "MPa": 1e6, "1/GPa": 1e-9}  # others: 1


@dataclass(frozen=True)
class Level:
    """symbol (plain text), math (for figures), unit in which it is shown; phrase: how a panel or legend names a value, where '$v$ = 10 m/s' is
    not how one says it; scale: what 1 of what is shown is in SI, where the unit doesn't say it."""

    symbol: str
    math: str
    unit: str = ""
    phrase: str = ""
    scale: float = 1.0

    def of(self, values):
        """SI values as they are shown."""
        return values / (self.scale * SI.get(self.unit, 1.0))

    def head(self, math=False):
        """'T_vis [ps]'; math: for the axis of a figure."""
        return (self.math if math else self.symbol) + (f"{' ' * math} [{self.unit}]" if self.unit else "")

    def text(self, value):
        """A value in that unit, without it; a name in words."""
        if not isinstance(value, (int, float)):
            name = str(value).isidentifier()
            return re.sub("(?<=[a-z])([A-Z])", lambda found: " " + found[1].lower(), value) if name else str(value)
        shown = float(f"{self.of(value):.6g}")
        return f"{shown:.0f}" if shown == round(shown) else f"{shown:.3g}"

    def label(self, value, math=True):
        """'$T_{vis}$ = 6 ps', for legends, panels and heads of columns (math=False); a word stands for itself."""
        if isinstance(value, str):
            return self.text(value)
        if self.phrase:
            return self.phrase.format(self.text(value))
        return f"{self.math if math else self.symbol} = {self.text(value)}" + (f" {self.unit}" if self.unit else "")


_LEVELS = {
    "velocity": Level("v", "$v$", "m/s"),
    "viscoelasticTime": Level("T_vis", "$T_{vis}$", "ps"),
    "grains": Level("grains", "grains of an aggregate", phrase="{} grains"),
    "square": Level("12 B_off^2", "$12 B_{off}^2$", scale=1 / 12),
    "filling": Level("φ", r"$\phi$"),
    "nominal": Level("φ", r"$\phi$"),
    "duration": Level("followed for", "followed for", "µs", phrase="followed for {} µs"),
    "radius": Level("R", "$R$", "r"),
    "neck": Level("β", r"$\beta$"),
    "growth_velocity": Level("V_g", "$V_g$", "m/s"),
    "criticalRolling": Level("ξ_crit", r"$\xi_{crit}$", "Å"),
    "energy_ratio": Level("E_k/E_sint", "$E_k/E_{sint}$"),
    "force_ratio": Level("F_c/F_max", "$F_c/F_{max}$"),
    "strainRate": Level("C_v", "$C_v$"),
    "linearDamping": Level("k_n", "$k_n$"),
    "stepFraction": Level("step", "step", "t0"),
    "start": Level("from φ", r"fitted from $\phi$"),
    "since": Level("from φ", r"from $\phi$"),
    "until": Level("to φ", r"to $\phi$"),
    "finalFilling": Level("φ before", r"$\phi$ before the stretching"),
    "stretched_axes": Level("axes", "axes"),
}


def level(name):
    """Level of that name; a name that is not in the list stands for itself."""
    return _LEVELS.get(name) or Level(name, name)
