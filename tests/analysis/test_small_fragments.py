"""How much of what drag changes is the mass of small fragments, from made tables of runs."""

import numpy as np
import pandas
import pytest

from analysis.studies.viscous.results import make_results, small_mass
from analysis.studies.viscous.small_fragments import drag_section, small_section

DRAG = 6e-12
LARGE_PIECES = 0.1  # <f_gro> that drag adds where it changes the large pieces too


def table(sizes=(500, 2000), seeds=(1, 2, 3), scatter=0.0):
    """Runs in which N^-1/2 of an aggregate's mass is thrown off in single grains without drag, and none with it; both lose
    a piece of 11 grains, which is not small."""
    rows = []
    for grains in sizes:
        for seed in seeds:
            noise = scatter * np.random.default_rng((grains, seed)).normal()
            for viscous_time in (0.0, DRAG):
                for square in (0.0, 0.5, 1.0):
                    small = 0 if viscous_time else round(grains**0.5)
                    growth = 0.2 + noise - 0.5 * small / grains + (LARGE_PIECES if viscous_time else 0.0)
                    row = {"grains": grains, "seed": seed, "velocity": 79.4, "impact": square**0.5, "growth": growth}
                    row |= {"viscoelasticTime": viscous_time, "sticking_velocity": 6.0}
                    row["fragments"] = f"1x{grains} 1x11" + (f" {small}x1" if small else "")
                    rows.append(row)
    return pandas.DataFrame(rows)


def test_small_mass():
    made = pandas.DataFrame({"fragments": ["1x100 1x11 2x10 5x1", "1x200"], "grains": [100, 100]})
    assert small_mass(made).tolist() == [0.25, 0.0]


def test_drag_splits_into_small_fragments_and_the_rest():
    section = drag_section(make_results(table()))
    assert [row["grains"] for row in section.records] == [500, 2000]
    for row in section.records:
        half = 0.5 * round(row["grains"] ** 0.5) / row["grains"]
        assert row["small"][0] == pytest.approx(half) and row["remnants"][0] == pytest.approx(LARGE_PIECES)
        assert row["growth"][0] == pytest.approx(half + LARGE_PIECES)


def test_what_differs_from_pair_to_pair_drops_out():
    scattered = make_results(table(scatter=0.3))
    (row, _) = drag_section(scattered).records
    assert scattered.growth[500, 0.0].error[0] > 0.05 and row["growth"][1] == pytest.approx(0.0, abs=1e-12)


def test_the_cross_section_of_merging():
    """Without drag they merge at B_off = 0 alone, with it up to B_off^2 = 1/2, of offsets 0, 1/2 and 1."""
    made = table(sizes=(500,))
    reach = np.where(made.viscoelasticTime > 0, 0.6, 0.1)
    made["growth"] = np.where(made.impact**2 < reach, 0.9, 0.0)
    (row,) = drag_section(make_results(made)).records
    assert row["merging"] == pytest.approx((0.5, 0.0))  # 1/4 and 3/4 of pi b_max^2


def test_exponent_of_the_size():
    rows = small_section(make_results(table())).records
    known = [row for row in rows if row["exponent"] is not None]
    assert len(known) == 1 and (known[0]["grains"], known[0]["T_vis"]) == (2000, 0.0)
    # grains are whole: 22 and 45 of them
    expected = np.log((22 / 500) / (45 / 2000)) / np.log(4)
    assert known[0]["exponent"][0] == pytest.approx(expected) and expected == pytest.approx(0.5, abs=0.02)


def test_one_size_and_one_viscous_time_have_no_sections():
    alone = table(sizes=(500,))
    assert small_section(make_results(alone)) is None
    assert drag_section(make_results(alone[alone.viscoelasticTime == 0])) is None
