"""Where the energy goes: what the channels take until a filling factor and between two of them, and when twisting sets in."""

import numpy as np

from ...report.section import Column, Section
from .measure import ENERGY_FILLINGS, LOST_CHANNELS, TWISTING_SHARES
from .shown import PARAMETERS, mean_with_error, with_error

LEAST_FRACTION = 5e-4  # of all dissipation: less than the tables show tells no largest channel
MODES = ("rolling", "twisting", "sliding")
# K13's normal damping is the channel `drag` of run folders.
LABELS = {"drag": "normal damping"}


def channel_sections(results):
    """Sections of all groups."""
    yield _until(results)
    yield _between(results)
    yield _twisting(results)


def _until(results):
    records = []
    for group in results.groups:
        for filling in ENERGY_FILLINGS:
            lost = {channel: group.energy(channel, filling) for channel in LOST_CHANNELS}
            there = np.isfinite(sum(lost.values()))
            lost = {channel: float(values[there].mean()) if there.any() else 0.0 for channel, values in lost.items()}
            total = sum(lost.values())
            if not total > 0:
                continue
            fractions = {channel: value / total for channel, value in lost.items()}
            modes = {name: fractions[f"{name}Dissipation"] for name in MODES}
            largest = max(modes, key=modes.get)
            largest = largest if modes[largest] >= LEAST_FRACTION else None
            place = {"filling": filling, "runs": int(there.sum())}
            records.append({**group.parameters, **place, **fractions, "largest": largest})
    columns = (
        *PARAMETERS,
        Column("filling", lambda r: f"{r['filling']:g}"),
        Column("runs", lambda r: f"{r['runs']}"),
        *(Column(name, lambda r, name=name: f"{r[f'{name}Dissipation']:.3f}") for name in MODES),
        Column(LABELS["drag"], lambda r: f"{r['drag']:.3f}"),
        Column("connection + disconnection", lambda r: f"{r['connection'] + r['disconnection']:.3f}"),
        Column("largest of the three", lambda r: r["largest"] or "-"),
    )
    intro = (
        "K13 sections 3.4, 3.5: rolling is the largest where xi_crit is 8 Å or less, and twisting sets in above a filling of "
        "0.1; at 16 Å they are comparable, at 32 Å twisting is the largest."
    )
    notes = (
        "Fractions of all that was dissipated until then, boundaries' work that is still stored or moving left out.",
        "What this can't tell: which contacts pay. Dissipation of the first approach, when free clusters are pressed "
        "together, is in the sum.",
    )
    return Section("where the energy goes", columns, tuple(records), intro, notes)


def _between(results):
    records = []
    for group in results.groups:
        for low, high in zip(ENERGY_FILLINGS, ENERGY_FILLINGS[1:]):
            lost = {c: group.energy(c, high) - group.energy(c, low) for c in LOST_CHANNELS}
            total = sum(lost.values())
            there = np.isfinite(total) & (total > 0)
            if group.seeds < 2 or not there.any():
                continue
            shares = {c: mean_with_error(values[there] / total[there]) for c, values in lost.items()}
            making = lost["connection"] + lost["disconnection"]
            shares["contacts"] = mean_with_error(making[there] / total[there])
            records.append({**group.parameters, "from": low, "to": high, "runs": int(there.sum()), **shares})
    columns = (
        *PARAMETERS,
        Column("from filling", lambda r: f"{r['from']:g}"),
        Column("to", lambda r: f"{r['to']:g}"),
        Column("runs", lambda r: f"{r['runs']}"),
        *(Column(name, lambda r, name=name: with_error(*r[f"{name}Dissipation"])) for name in MODES),
        Column(LABELS["drag"], lambda r: with_error(*r["drag"])),
        Column("connection + disconnection", lambda r: with_error(*r["contacts"])),
    )
    notes = ("Fractions of what is dissipated between the two filling factors, with errors from the clusters.",)
    return Section("where the energy goes between two filling factors", columns, tuple(records), notes=notes)


def _twisting(results):
    records = [
        {
            **group.parameters,
            "seeds": group.seeds,
            **{f"{share:g}": group.twisting_from(share).tolist() for share in TWISTING_SHARES},
        }
        for group in results.groups
    ]
    columns = (
        *PARAMETERS,
        Column("runs", lambda r: f"{r['seeds']}"),
        *(Column(f"filling at {share:g}", lambda r, s=share: _fillings(r[f"{s:g}"])) for share in TWISTING_SHARES),
    )
    intro = (
        "The filling factor from which on twisting has dissipated so much of what rolling has, both from the start: mean and "
        "error over the clusters, and in brackets their number and range."
    )
    notes = ("- where no cluster passes it: twisting is above it from the start, or below it to the end.",)
    return Section("where twisting sets in", columns, tuple(records), intro, notes)


def _fillings(values):
    if not values:
        return "-"
    mean = with_error(*mean_with_error(values))
    return f"{mean} ({len(values)}: {min(values):.3f} to {max(values):.3f})"
