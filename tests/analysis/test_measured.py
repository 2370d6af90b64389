"""theory.measured: constants are the fits of the gallery's runs, and errors hold for clusters that were left out."""

from dataclasses import replace
from math import hypot

import numpy as np
import pandas
import pytest

from analysis.studies import formulas
from analysis.studies.estimates import beside, estimate, estimates, mean, where
from analysis.studies.gather import gather
from analysis.studies.study import GALLERY, find
from analysis.theory import ICE, SILICATE, aggregates, measured

LAWS = {  # column of the study: (its filling, law)
    "tensile_strength": ("filling", measured.TENSILE),
    "conductivity": ("conducting_filling", measured.CONDUCTIVITY),
}


@pytest.fixture(scope="module")
def clusters():
    study = find("formulas")
    return study.runs(gather(study, [GALLERY / "formulas" / "runs.csv"]).table)


@pytest.fixture(scope="module")
def ice(clusters):
    """With the loosest clusters, to which nothing was fitted."""
    runs = where(clusters, **formulas.ICE)
    return runs[runs.finalFilling <= formulas.FITTED[1]]


def fitted(runs, name, places):
    """Arguments of measured.PowerLaw."""
    own = runs[runs.finalFilling.between(*formulas.FITTED)]
    found = estimates(formulas.power_law(name, places), own)
    return [number for own in found for number in (own.value, own.error)]


@pytest.mark.parametrize("name", LAWS)
def test_constants_are_the_fits_of_the_gallerys_runs(ice, name):
    places, law = LAWS[name]
    found = fitted(ice, name, places)
    assert [law.level, law.level_error, law.exponent, law.exponent_error] == pytest.approx(found, rel=0.02)


@pytest.mark.parametrize("name", LAWS)
def test_errors_hold_clusters_that_were_left_out(ice, name):
    """A fit to the other fillings foretells those of one filling, within three combined errors."""
    places, _ = LAWS[name]
    for filling in ice.finalFilling.unique():
        left_out = ice.finalFilling == filling
        own, fit = ice[left_out], fitted(ice[~left_out], name, places)
        foretold, there = measured.PowerLaw(*fit).times(1.0, own[places].mean()), estimate(mean(name), own)
        assert abs(foretold.value - there.value) < 3 * hypot(foretold.error, there.error), filling


def test_factors_of_the_compression_are_the_runs_means_and_lie_on_lines(ice):
    """Each within three combined errors of the line between its neighbours."""
    points = [(filling, estimate(mean("pressed"), own)) for filling, own in ice.groupby("finalFilling")]
    for (filling, found), *constants in zip(points, *measured.COMPRESSIVE, strict=True):
        assert constants == pytest.approx([filling, found.value, found.error], rel=0.02)
    for (low, one), (filling, found), (high, other) in zip(points, points[1:], points[2:]):
        part = (filling - low) / (high - low)
        line, error = (1 - part) * one.value + part * other.value, hypot((1 - part) * one.error, part * other.error)
        assert abs(line - found.value) < 3 * hypot(error, found.error)


@pytest.mark.parametrize(
    "table, bpca, others",
    [
        (measured.FRAGMENTATION, "critical velocity of BPCA, masses 1/4 to 1", "critical velocity of {}, all masses"),
        (
            measured.STICKING,
            "velocity at which half of BPCA stick, masses 1/4 to 1",
            "velocity at which half of {} stick, all masses",
        ),
    ],
)
def test_velocities_are_the_atlass(table, bpca, others):
    rows = pandas.read_csv(GALLERY / "atlas" / "comparison.csv").set_index("quantity")
    for structure, found in table.items():
        row = rows.loc[(bpca if structure == "bpca" else others.format(structure)) + " [v_break]"]
        assert found == pytest.approx((row.ours, row.error), rel=0.01)


def test_velocities_go_as_that_which_breaks_contacts():
    assert measured.fragmentation_velocity("bcca") == pytest.approx((7.00 * 3.823, 0.294 * 3.823), rel=1e-3)
    assert measured.sticking_velocity("bcca") == pytest.approx((6.35 * 3.823, 0.135 * 3.823), rel=1e-3)
    with pytest.raises(ValueError, match="structure = 'dust': must be one of bpca, bcca, compressed, cpe"):
        measured.sticking_velocity("dust")


def test_factors_of_rolling_are_those_of_the_same_clusters(clusters, ice):
    clusters, middle = where(clusters, finalFilling=0.2, material="ice"), where(ice, finalFilling=0.2)
    for name, table in (("pulled", measured.ROLLING_TENSILE), ("pressed", measured.ROLLING_COMPRESSIVE)):
        rows = {ratio: found for ratio, *found in zip(*table)}
        assert rows.pop(8e-3) == [1.0, 0.0] and len(rows) == 4  # of `ice` itself, and others
        for ratio, (value, error) in rows.items():
            own = clusters[np.isclose(clusters.criticalRolling / clusters.grainRadius, ratio)]
            found = beside(mean(name), own, middle, np.divide)
            assert value == pytest.approx(found.value, rel=0.01) and error == pytest.approx(found.error, rel=0.1)


@pytest.mark.parametrize(
    "kept_out, material",
    [
        (dict(material="silicate"), SILICATE),
        (dict(material="ice", surfaceEnergy=0.02), replace(ICE, surface_energy=0.02)),
        (dict(grainRadius=1e-6, criticalRolling=8e-9), replace(ICE, critical_rolling=8e-9)),
    ],
)
def test_strengths_of_grains_that_were_kept_out(clusters, kept_out, material):
    """Of eight clusters each, within three combined errors; the runs were known when the factors were chosen."""
    own = where(clusters, finalFilling=0.2, **kept_out)
    radius = own.grainRadius.iloc[0]
    scale = aggregates.strength_scale(own.rolling_energy.iloc[0], radius)
    formula = aggregates.compressive_strength_dense(0.2, scale)
    tension = measured.tensile_strength(own.filling.mean(), material.surface_energy, radius, material.critical_rolling)
    pressure = measured.compressive_strength(0.2, material, radius)
    for foretold, values in ((tension, own.tensile_strength), (pressure, own.pressed * formula)):
        found, error = values.mean(), values.sem()
        assert len(own) == 8 and abs(foretold.value - found) < 3 * hypot(foretold.error, error)


def test_strengths_scale_as_their_formulas():
    one, other = measured.tensile_strength(0.2), measured.tensile_strength(0.2, 0.02, 1e-6, 8e-9)
    assert one.value / other.value == pytest.approx(50) and one.error / other.error == pytest.approx(50)
    near, far = measured.conductivity([0.23, 0.4])[1] / measured.conductivity([0.23, 0.4])[0]
    assert near < far and measured.compressive_strength(0.2).error > 0
    own = measured.fragmentation_velocity("bpca", SILICATE)
    assert own == measured.fragmentation_velocity("bpca", SILICATE, 6e-7)
    with pytest.raises(ValueError, match="grain_radius: must be given"):
        measured.conductivity(0.2, replace(ICE, young=1e9))
