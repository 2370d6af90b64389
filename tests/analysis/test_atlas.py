"""The collision atlas: rules of outcomes, columns, the model and the region of its runs, queries, the command."""

from dataclasses import replace

import numpy as np
import pandas
import pytest
from written_runs import two_pairs

import analysis
from analysis.__main__ import main
from analysis.atlas import outcome_table, query, rules, variables
from analysis.atlas.columns import COLUMNS, measure, power_law_index, read_runs
from analysis.atlas.outcome_table import ERRORS, INTERVALS, PROBABILITIES, read_outcomes, write_outcomes
from analysis.atlas.variables import GROWN, MARGIN, STRUCTURES, Region, fit_and_held_out, of_structure
from analysis.runs.table import make_table, table_text
from analysis.theory import GRAIN_RADIUS, ICE, breaking_velocity

# mass ratio, largest, second, own -> outcome
RULED = [
    (1.0, 0.91, 0.02, 0.0, "sticking"),  # equal masses: as measures.outcome, from 0.9 on
    (1.0, 0.89, 0.02, 0.0, "mass_transfer"),
    (1.0, 0.52, 0.48, 0.5, "mass_transfer"),  # a merged body that broke in two
    (1.0, 0.5, 0.2, 1.0, "erosion"),
    (1.0, 0.2, 0.1, 1.0, "fragmentation"),
    (0.25, 0.95, 0.0, 0.0, "mass_transfer"),  # three quarters of the projectile stay
    (0.25, 0.8, 0.2, 1.0, "bouncing"),
    (0.25, 0.79, 0.05, 1.0, "erosion"),
    (0.25, 0.39, 0.2, 1.0, "fragmentation"),
]


def test_rules_of_outcomes():
    *columns, expected = zip(*RULED)
    row = dict(zip(("mass_ratio", "largest", "second", "own"), map(np.array, columns)))
    assert rules.outcome(row).tolist() == list(expected)


def test_index_of_fragments_of_a_power_law():
    """Within its error, over forty draws; the error is their scatter."""
    sizes = np.arange(1, 201)
    for index in (0.5, 1.8, 3.0):
        random, weights = np.random.default_rng(3), sizes**-index / (sizes**-index).sum()
        found = np.array([power_law_index(random.choice(sizes, 50, p=weights), most=200) for _ in range(40)])
        assert found[:, 0].mean() == pytest.approx(index, abs=4 * found[0, 1] / 40**0.5 + 0.03)
        assert found[:, 0].std() == pytest.approx(found[:, 1].mean(), rel=0.4)


def test_columns_of_a_run_and_a_round_trip(tmp_path):
    rows = []
    for name, sticks in (("00003", True), ("00004-held", False)):
        run = analysis.open_run(two_pairs(tmp_path / name, 30.0, 1, sticks=sticks))
        rows.append((run.path, measure(run)))
    table = make_table(rows)
    assert table.outcome.tolist() == ["sticking", "bouncing"] and table.split.tolist() == ["fit", "held_out"]
    assert table.restitution.tolist() == pytest.approx([0.0, 0.5]) and table.largest.tolist() == [1.0, 0.5]
    assert table.v_break[0] == pytest.approx(3.823, rel=1e-3) and table.slidingDissipation_at_end[0] == 1.0
    file = tmp_path / "runs.csv"
    file.write_text(table_text(table, COLUMNS, {"study": "atlas"}))
    again = read_runs(file)
    pandas.testing.assert_frame_equal(again[table.columns].drop(columns="folder"), table.drop(columns="folder"))


@pytest.fixture(scope="module")
def made():
    """A table of made runs whose chance to stick is a known function of velocity: 1/(1 + (v/5 v_break)^3)."""
    random, number = np.random.default_rng(5), 600
    speed, grains = 10 ** random.uniform(-1, 1.4, number), 10 ** random.uniform(1.8, 3, number)
    stuck = random.uniform(size=number) < 1 / (1 + (speed / 5) ** 3)
    filling, impact = random.uniform(0.05, 0.5, number), random.uniform(size=number) ** 0.5
    columns = dict.fromkeys(("filling_target", "filling_projectile", "filling_largest"), filling)
    columns |= {"velocity": speed, "v_break": 1.0, "grains_target": grains, "impact": impact, "split": "fit"}
    columns |= {"mass_ratio": 10 ** -random.uniform(0, 1.8, number), "own": 1.0}
    ends = {"outcome": ("sticking", "erosion"), "largest": (1.0, 0.5), "second": (0.0, 0.1)}
    ends |= {"fragment_index": (np.nan, 2.0)}
    return pandas.DataFrame({**columns, **{name: np.where(stuck, *values) for name, values in ends.items()}})


@pytest.fixture(scope="module")
def model():
    """The module analysis.atlas.model."""
    pytest.importorskip("sklearn")
    return pytest.importorskip("analysis.atlas.model")


def point(**own):
    """variables() of one point, or of several where a value is a list."""
    row = {"v_break": 1.0, "grains_target": 300.0, "filling_target": 0.2, "filling_projectile": 0.2}
    row |= {"velocity": 5.0, "mass_ratio": 0.2, "impact": 0.5, **own}
    several = max(np.size(value) for value in row.values())
    return variables.variables(pandas.DataFrame(row, index=range(several)))


@pytest.fixture(scope="module")
def fitted(made, model):
    """The Model of the made runs."""
    return model.Model(made, members=4)


def test_model_finds_the_known_probability_of_made_runs(made, fitted):
    p, width = fitted.probabilities(variables.variables(made))
    assert np.abs(p[:, 0] - 1 / (1 + (made.velocity / 5) ** 3)).mean() < 0.05 and p.sum(axis=1) == pytest.approx(1)
    assert 0.005 < width[:, 0].mean() < 0.2
    assert fitted.probabilities(point(velocity=1e-3))[0][0, 0] == 1
    assert fitted.slow.most == pytest.approx(3 / fitted.slow.number, rel=0.1)  # the rule of three


def test_tables_made_of_a_model_answer_as_it_does(fitted, tmp_path):
    from analysis.atlas.make import outcome_axes, outcome_grid

    file = tmp_path / "outcomes.txt"
    write_outcomes(file, outcome_grid(fitted, GROWN, True, "0"))
    assert read_outcomes(file).columns == outcome_table.COLUMNS
    found = analysis.outcome(5 * 3.8231, 60, [300, 3e6], 0.2, file=file)
    assert sum(found[name] for name in PROBABILITIES) == pytest.approx(1, abs=1e-4)
    assert found["p_sticking"][0] == pytest.approx(0.5, abs=0.2) and found["inside"].tolist() == [1.0, 0.0]
    assert all(found[name][0] > 0 and np.isnan(found[name][1]) for name in (ERRORS[0], ERRORS[3]))
    file = tmp_path / "outcomes-impact.txt"
    write_outcomes(file, outcome_grid(fitted, GROWN, False, "0"))
    node = {"velocity": outcome_axes(GROWN, True)[0].nodes[-4], "grains": 512, "mass_ratio": 1 / 4, "filling": 0.2}
    node["impact_square"] = 0.25
    on_node = {name: float(value) for name, value in read_outcomes(file).lookup(INTERVALS, **node).items()}
    assert on_node.pop("inside") == 1
    ends = fitted.remains.intervals(pandas.DataFrame([node])).iloc[0]
    assert on_node == pytest.approx(ends[[*INTERVALS]].to_dict(), abs=1e-4)


def test_mean_pieces_follow_from_the_probabilities(made, model):
    """Of runs of one mass ratio that leave all or half: the means are those of the outcomes."""
    p = np.array([[0.9, 0, 0, 0.1, 0], [0.2, 0, 0, 0.8, 0]])
    means = model.Remains(made.assign(mass_ratio=0.5)).means(point(velocity=[0.3, 5.0], mass_ratio=0.5), p)
    assert means.largest.tolist() == pytest.approx([0.95, 0.6]) and means.second.tolist() == pytest.approx([0.01, 0.08])
    # of 2/3 of the mass 1/2 is left, half of the smaller one's 1/3 is lost
    assert means.loss_erosion.tolist() == pytest.approx([0.5, 0.5])


def test_runs_that_never_met_give_the_probability_to_touch(made, model):
    fitted = model.Model(made.assign(outcome=np.where(made.impact > 0.7, "never met", made.outcome)), members=0)
    assert fitted.touching(point(impact=[0.3, 0.95])) == pytest.approx([1, 0], abs=0.02)
    assert fitted.touching(point(), averaged=True) == pytest.approx(0.49, abs=0.03)


def test_undecided_runs_are_in_the_errors_alone(made, model):
    """They may have stuck or bounced."""
    undecided = made[made.velocity.between(3, 8)][::2].assign(outcome="undecided")
    fits = [model.Model(table, members=20) for table in (made, pandas.concat([made, undecided]))]
    (p, width), (same, wider) = (fit.probabilities(point()) for fit in fits)
    bouncing = rules.KINDS.index("bouncing")
    assert same == pytest.approx(p) and width[0, bouncing] == 0 and 0.02 < wider[0, bouncing] < 0.2


def test_a_query_beyond_the_runs_is_an_extrapolation(made):
    region, of_half = Region(made), Region(made[::2])
    assert region.beyond(point())[0] < 0
    at = variables.variables(made[1::2])
    assert np.mean(of_half.beyond(at) <= MARGIN) > 0.9  # of 300 runs; corners of their box are beyond
    for beyond in ({"velocity": 1e4}, {"grains_target": 1e6}, {"filling_target": 0.9, "filling_projectile": 0.9}):
        assert region.beyond(point(**beyond))[0] > 4 * MARGIN, beyond


def test_the_gallerys_intervals_hold_the_largest_piece_of_held_out_runs():
    """Between nodes too: nine of ten of those that leave several (0.85: three standard errors less), and no more mass
    comes out than there was. Half of the BCCA aggregates are fluffier than a filling of 0.02."""
    _, all_held = fit_and_held_out(read_runs(query.RUNS_FILE))
    holds = []
    for structure in STRUCTURES:
        held = of_structure(all_held, structure)
        at, several = variables.variables(held), held.pieces > 1
        speed = at.velocity * breaking_velocity(ICE, GRAIN_RADIUS["ice"])
        grains, how = (at.mass_ratio * at.grains, at.grains), {"impact": np.sqrt(at.impact_square)}
        found = analysis.outcome(speed, *grains, at.filling, structure=structure, **how)
        assert np.all(found["largest"] + found["second"] < 1 + 1e-5)
        inside = found["inside"] == 1
        within = (found["largest_low"] <= held.largest) & (held.largest <= found["largest_high"])
        holds.append(within[inside & several])
        fluffy = (at.filling < 0.02) & (at.grains >= 64)
        assert structure != GROWN or inside[fluffy].mean() > 0.9 and fluffy.sum() > 50
    holds = np.concatenate(holds)
    assert holds.mean() > 0.85 and len(holds) > 250


def test_structure_material_and_radius_of_a_query():
    of = [analysis.outcome(0.5, 200, 20, 0.1, "silicate", radius)["p_sticking"] for radius in (None, 6e-7, 1e-7)]
    assert of[0] == of[1] < of[2]
    dense = [analysis.outcome(5, 200, 500, 0.45, structure=own)["p_bouncing"] for own in STRUCTURES]
    assert dense[1] > dense[0] + 0.1
    with pytest.raises(ValueError, match="material"):
        analysis.outcome(5, 200, 500, 0.4, material="lead")


def test_other_constants_of_grains_act_through_the_breaking_velocity():
    """At a fifth of the surface energy it is 0.26 times as high; the answer names the constants."""
    pair, own = (200, 500, 0.15), {"surface_energy": 0.02, "young": 3e9}
    ratio = breaking_velocity(replace(ICE, **own), 1e-7) / breaking_velocity(ICE, 1e-7)
    assert analysis.outcome(10 * ratio, *pair, **own)["p_sticking"] == pytest.approx(
        analysis.outcome(10, *pair)["p_sticking"], rel=1e-9
    )
    with pytest.raises(ValueError, match="surface_energy"):
        analysis.outcome(10, *pair, surface_energy=-1)


def test_a_table_of_ones_own_runs_has_their_fractions(tmp_path):
    """Of pairs of grains, of which two stick and one bounces, at twice the speed all bounce."""
    for number, (velocity, sticks) in enumerate([(20.0, True), (20.0, True), (20.0, False), (40.0, False)]):
        two_pairs(tmp_path / "runs" / str(number), velocity, number, sticks)
    file = tmp_path / "own.txt"
    analysis.outcome_table(tmp_path / "runs", file)
    table = read_outcomes(file)
    node = {"grains": 2, "mass_ratio": 1, "filling": 0.46}
    for velocity, runs, sticking in ((20.0, 3, 2.2 / 4), (40.0, 1, 0.1)):
        found = table.lookup(velocity=velocity / breaking_velocity(ICE, 1e-7), **node)
        assert found["runs"] == pytest.approx(runs) and found["p_sticking"] == pytest.approx(sticking)
        assert sum(found[name] for name in PROBABILITIES) == pytest.approx(1)
    answer = analysis.outcome([20.0, 40.0], 2, 2, 0.46, grain_radius=1e-7, file=file)
    assert (answer["inside"] == 1).all() and (answer["error_sticking"] > 0.1).all()


def test_command_answers_with_the_nearest_runs(capsys):
    query = "outcome --projectile 200 --target 300 --filling 0.3 --velocity"
    assert main(f"{query} 1 --impact 0.3".split()) == 0
    text = capsys.readouterr().out
    first = text.splitlines()[1].split()
    assert first[0] == "sticking" and float(first[1]) > 0.8
    assert "study.py runs/atlas-full-" in text and "EXTRAPOLATION" not in text and "in 90 %" in text
    assert main(f"{query} 300 --material silicate".split()) == 0
    title, beyond, sticking = capsys.readouterr().out.splitlines()[:3]
    assert "silicate (radius 0.6 um" in title and "EXTRAPOLATION" in beyond and "error is not known" in beyond
    assert sticking.split()[0] == "sticking" and "(" not in sticking
    assert main(f"{query} 1 --material lead".split()) == 2
    assert capsys.readouterr().err == "analysis: material = lead: must be ice or silicate\n"
