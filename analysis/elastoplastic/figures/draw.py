"""The list of figures: their files, what they need, their captions."""

import io

from PIL import Image  # what matplotlib itself writes PNGs with

from .bounce import energy_size_figure, energy_velocity_figure, outcome_figure
from .common import main_filling
from .constants import strength_figure
from .motion import andrews_figure, chains_figure, motion_figure
from .offset import offset_figure
from .size import size_figure, time_figure
from .velocity import moduli_figure, velocity_figure

DOTS_PER_INCH = 80  # a gallery of all figures stays below 1.5 MB
COLOURS = 128


def _of_filling(make, filling=None, needs_offset=True):
    """Figure of one filling (None: the main one); None where it has no runs, or no offset."""

    def figure(study):
        results = study.by_filling.get(main_filling(study) if filling is None else filling)
        if results is None or (needs_offset and results.offset is None):
            return None
        return make(study, results)

    return figure


def _others(make):
    """Figure of the second filling, the one that A24 shows in Figs. 6 and 9; None where there is one only."""

    def figure(study):
        others = [f for f in study.by_filling if f != main_filling(study)]
        filling = 0.3 if 0.3 in others else (others[0] if others else None)
        return None if filling is None else _of_filling(make, filling, make is velocity_figure)(study)

    return figure


FIGURES = {
    "fig04_motion": (motion_figure, "A24 Fig. 4: compression length and mutual velocity, all seeds (first in red)."),
    "fig05_size": (_of_filling(size_figure, None, False), "A24 Fig. 5: largest compression against size."),
    "fig06_size": (_others(size_figure), "A24 Fig. 6: the same at the other filling."),
    "fig07_time": (_of_filling(time_figure), "A24 Fig. 7: time to the largest compression against size."),
    "fig08_velocity": (_of_filling(velocity_figure), "A24 Fig. 8: largest compression and its time against velocity."),
    "fig09_velocity": (_others(velocity_figure), "A24 Fig. 9: the same at the other filling."),
    "fig10_moduli": (moduli_figure, "A24 Fig. 10: pairs of yield stress and E* that give one largest compression."),
    "fig11_strength": (strength_figure, "A24 Fig. 11: yield stress and coordination number beside other aggregates."),
    "fig12_andrews": (andrews_figure, "A24 Fig. 12: mutual velocity beside Andrews's model with its return phase."),
    "fig13_forces": (chains_figure, "A24 Fig. 13: contact forces around the largest compression."),
    "outcome": (outcome_figure, "Restitution and sticking probability with 95 % intervals."),
    "energy_velocity": (energy_velocity_figure, "Where the energy goes, against velocity."),
    "energy_size": (energy_size_figure, "Where the energy goes, against size."),
    "start_offset": (offset_figure, "Largest compression against the chance offset of the centres of mass."),
}


def draw(name, study, folder):
    """Draw one of FIGURES as folder/NAME.png; its caption, or None where the runs don't suffice for it (an
    older file of that name is taken away then)."""
    make, caption = FIGURES[name]
    file = folder / f"{name}.png"
    figure = make(study)
    if figure is None:
        file.unlink(missing_ok=True)
        return None
    image = io.BytesIO()
    figure.savefig(image, dpi=DOTS_PER_INCH)
    # Few colours, so that a palette loses nothing that one sees, and is a third of the size.
    Image.open(image).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(file, optimize=True)
    return caption
