"""The collision atlas: rules of outcomes, columns, the model and what it says of queries beyond its runs, the command."""

import numpy as np
import pandas
import pytest
from written_runs import two_pairs

import analysis
from analysis.__main__ import main
from analysis.atlas import grid, rules
from analysis.atlas import query as query_of
from analysis.atlas.barrier import barrier
from analysis.atlas.columns import MEASURED, breaking_velocity
from analysis.atlas.grid import COLUMNS, ERRORS, INTERVALS, PROBABILITIES, outcome_axes, outcome_grid
from analysis.atlas.make import read_runs
from analysis.atlas.neighbours import MARGIN, Neighbours
from analysis.atlas.outcome_table import Axis, OutcomeTable, read_outcomes, write_outcomes
from analysis.atlas.power_law import power_law_index
from analysis.atlas.remains import Remains
from analysis.atlas.rules import KEPT
from analysis.atlas.scores import within
from analysis.atlas.variables import GROWN, STRUCTURES, energy, fit_and_held_out, of_structure, variables
from analysis.runs.table import make_table, read_table, table_text
from analysis.studies.columns import flat, row_of
from analysis.studies.definition import NotMeasured
from analysis.theory import GRAIN_RADIUS, ICE

# mass ratio, largest, second, own -> outcome
RULED = [
    (1.0, 0.91, 0.02, 0.0, "sticking"),  # equal masses: as measures.outcome, from 0.9 on
    (1.0, 0.89, 0.02, 0.0, "mass_transfer"),
    (1.0, 0.5, 0.5, 1.0, "bouncing"),
    (1.0, 0.52, 0.48, 0.5, "mass_transfer"),  # a merged body that broke in two
    (1.0, 0.5, 0.2, 1.0, "erosion"),
    (1.0, 0.2, 0.1, 1.0, "fragmentation"),
    (0.25, 0.97, 0.0, 0.0, "sticking"),
    (0.25, 0.95, 0.0, 0.0, "mass_transfer"),  # three quarters of the projectile stay
    (0.25, 0.8, 0.2, 1.0, "bouncing"),
    (0.25, 0.79, 0.05, 1.0, "erosion"),
    (0.25, 0.39, 0.2, 1.0, "fragmentation"),
]


@pytest.mark.parametrize("mass_ratio, largest, second, own, expected", RULED)
def test_rules(mass_ratio, largest, second, own, expected):
    row = {"mass_ratio": mass_ratio, "largest": largest, "second": second, "own": own}
    assert rules.outcome(row) == expected


def test_one_rule_holds_for_every_run():
    random = np.random.default_rng(1)
    largest = random.uniform(size=5000)
    row = {"mass_ratio": random.uniform(0.01, 1, 5000), "largest": largest, "own": random.uniform(0.5, 1, 5000)}
    row["second"] = random.uniform(size=5000) * np.minimum(largest, 1 - largest)
    assert np.all(sum(getattr(rules, kind)(row).astype(int) for kind in rules.KINDS) == 1)


@pytest.mark.parametrize("index", [0.5, 1.8, 3.0])
def test_index_of_fragments_of_a_power_law(index):
    """Within its error, over forty draws; the error is their scatter."""
    random, sizes = np.random.default_rng(3), np.arange(1, 201)
    weights = sizes**-index / (sizes**-index).sum()
    found = np.array([power_law_index(random.choice(sizes, 50, p=weights), most=200) for _ in range(40)])
    assert found[:, 0].mean() == pytest.approx(index, abs=4 * found[0, 1] / 40**0.5 + 0.03)
    assert found[:, 0].std() == pytest.approx(found[:, 1].mean(), rel=0.4)
    assert np.isnan(power_law_index([1, 1, 1, 1])).all()


def test_columns_of_a_run_and_a_round_trip(tmp_path):
    rows = []
    for name, sticks in (("00003", True), ("00004-held", False)):
        run = analysis.open_run(two_pairs(tmp_path / name, 30.0, 1, sticks=sticks))
        rows.append((run.path, row_of(MEASURED, run)))
    table = make_table(rows)
    assert table.outcome.tolist() == ["sticking", "bouncing"] and table.split.tolist() == ["fit", "held_out"]
    assert table.restitution.tolist() == pytest.approx([0.0, 0.5]) and table.largest.tolist() == [1.0, 0.5]
    assert table.v_break[0] == pytest.approx(3.823, rel=1e-3) and table.slidingDissipation_at_end[0] == 1.0
    file = tmp_path / "runs.csv"
    file.write_text(table_text(table, flat(MEASURED), {"study": "atlas"}))
    again, _ = read_table(file, flat(MEASURED))
    pandas.testing.assert_frame_equal(again[table.columns].drop(columns="folder"), table.drop(columns="folder"))
    with pytest.raises(NotMeasured, match="no run of the atlas"):
        row_of(MEASURED, analysis.open_run(two_pairs(tmp_path / "mine", 3.0, 1)))


@pytest.fixture(scope="module")
def made():
    """A table of made runs whose chance to stick is a known function of velocity: 1/(1 + (v/5 v_break)^3)."""
    random, number = np.random.default_rng(5), 600
    speed, grains = 10 ** random.uniform(-1, 1.4, number), 10 ** random.uniform(1.8, 3, number)
    stuck = random.uniform(size=number) < 1 / (1 + (speed / 5) ** 3)
    filling, impact = random.uniform(0.05, 0.5, number), random.uniform(size=number) ** 0.5
    columns = dict.fromkeys(("filling_target", "filling_projectile", "filling_largest"), filling)
    columns |= {"velocity": speed, "v_break": 1.0, "grains_target": grains, "impact": impact, "split": "fit"}
    columns["mass_ratio"] = 10 ** -random.uniform(0, 1.8, number)
    ends = {
        "outcome": ("sticking", "erosion"),
        "largest": (1.0, 0.5),
        "second": (0.0, 0.1),
        "fragment_index": (np.nan, 2.0),
    }
    return pandas.DataFrame({**columns, **{name: np.where(stuck, *values) for name, values in ends.items()}})


POINT = {"v_break": 1.0, "grains_target": 300.0, "filling_target": 0.2, "filling_projectile": 0.2}


def point(**own):
    """variables() of one point, or of several where a value is a list."""
    return variables(
        pandas.DataFrame(
            {**POINT, "velocity": 5.0, "mass_ratio": 0.2, "impact": 0.5, **own},
            index=[0] if all(np.isscalar(value) for value in own.values()) else None,
        )
    )


def test_model_of_made_runs(made, tmp_path):
    model = pytest.importorskip("analysis.atlas.model")
    pytest.importorskip("sklearn")
    fitted = model.Model(made, members=10)
    p, width = fitted.probabilities(variables(made))
    assert np.abs(p[:, 0] - 1 / (1 + (made.velocity / 5) ** 3)).mean() < 0.05 and p.sum(axis=1) == pytest.approx(1)
    assert 0.005 < width[:, 0].mean() < 0.2
    assert fitted.probabilities(point(velocity=1e-3))[0][0, 0] == 1
    assert fitted.slow.number == (energy(variables(made)) < fitted.slow.energy).sum()
    assert fitted.slow.most == pytest.approx(3 / fitted.slow.number, rel=0.1)  # the rule of three
    file = tmp_path / "outcomes.txt"
    write_outcomes(file, outcome_grid(fitted, GROWN, "0"))
    found = analysis.outcome(5 * 3.8231, 60, [300, 3e6], 0.2, file=file)
    assert sum(found[name] for name in PROBABILITIES) == pytest.approx(1, abs=1e-4)
    assert found["p_sticking"][0] == pytest.approx(0.5, abs=0.2) and found["inside"].tolist() == [1.0, 0.0]
    assert all(found[name][0] > 0 and np.isnan(found[name][1]) for name in (ERRORS[0], ERRORS[3]))
    assert read_outcomes(file).columns == COLUMNS
    file = tmp_path / "outcomes-impact.txt"
    write_outcomes(file, outcome_grid(fitted, GROWN, "0", None))
    of_each = analysis.outcome(5 * 3.8231, 60, 300, 0.2, impact=[0, 0.6, 1], file=file)
    assert of_each["p_sticking"] == pytest.approx(0.5, abs=0.25) and np.ptp(of_each["p_sticking"]) > 0
    node = {
        "velocity": outcome_axes(GROWN, True)[0].nodes[-4],
        "grains": 512,
        "mass_ratio": 1 / 4,
        "filling": 0.2,
        "impact_square": 0.25,
    }
    on_node = {name: float(value) for name, value in read_outcomes(file).lookup(INTERVALS, **node).items()}
    assert on_node.pop("inside") == 1
    ends = fitted.remains.intervals(pandas.DataFrame([node])).iloc[0]
    assert on_node == pytest.approx(ends[[*INTERVALS]].to_dict(), abs=1e-4)


def test_pieces_follow_from_the_probabilities(made):
    """Of runs of one mass ratio that leave all or half: whatever the chances, the means are those of the outcomes."""
    pytest.importorskip("sklearn")
    told = Remains(made.assign(mass_ratio=0.5)).means(
        point(velocity=[0.3, 5.0], mass_ratio=0.5), np.array([[0.9, 0, 0, 0.1, 0], [0.2, 0, 0, 0.8, 0]])
    )
    assert told.largest.tolist() == pytest.approx([0.95, 0.6]) and told.second.tolist() == pytest.approx([0.01, 0.08])
    assert told.loss_erosion.tolist() == pytest.approx(
        [0.5, 0.5]
    )  # of 2/3 of the mass 1/2 is left, of the smaller one's 1/3 a half is lost


def test_runs_that_never_met_or_are_undecided(made):
    """The first are known by their impact parameter; the second, which may have stuck or bounced, are in the errors alone."""
    model = pytest.importorskip("analysis.atlas.model")
    pytest.importorskip("sklearn")
    missed = made.assign(outcome=np.where(made.impact > 0.7, "never met", made.outcome))
    fitted = model.Model(missed, members=0)
    assert fitted.touching(point(impact=[0.3, 0.95])) == pytest.approx([1, 0], abs=0.02)
    assert fitted.touching(point(), upto=1.0) == pytest.approx(0.49, abs=0.03)
    still_open = made[made.velocity.between(3, 8)][::2].assign(outcome="undecided", own=1.0)
    fits = [model.Model(table, members=20) for table in (made, pandas.concat([made, still_open]))]
    (p, width), (same, wider) = (fit.probabilities(point()) for fit in fits)
    bouncing = rules.KINDS.index("bouncing")
    assert same == pytest.approx(p) and width[0, bouncing] == 0 and 0.02 < wider[0, bouncing] < 0.2


def test_what_earlier_runs_foretell_of_later_ones(made):
    """Of 300 runs from the others: told as the known chance says, and counted as they ended; each structure's apart."""
    scores = pytest.importorskip("analysis.atlas.scores")
    pytest.importorskip("sklearn")
    table = made.assign(number=made.index, structure=np.where(made.index % 3, "bcca", "cpe"))
    found = scores.foretold(table, 300).set_index("runs")
    assert found.number.to_dict() == {"all": 300, "bcca": 200, "cpe": 100}
    later = table[300:]
    for name, rows in (("all", later), *later.groupby("structure")):
        stuck, told = map(float, found.sticking[name].strip(")").split(" ("))
        expected = (1 / (1 + (rows.velocity / 5) ** 3)).sum()
        assert stuck == (rows.outcome == "sticking").sum() and told == pytest.approx(expected, abs=0.06 * len(rows))
        assert found.bouncing[name] == "0 (0)" and 0.05 < found.brier[name] < 0.35
    assert scores.foretold(table, 600).empty


def test_intervals_hold_their_part():
    """Of runs that the forest has not seen, where the gain scatters with the velocity."""
    pytest.importorskip("sklearn")
    random, number = np.random.default_rng(7), 1200
    columns = {
        "velocity": 10 ** random.uniform(-1, 1.4, number),
        "mass_ratio": 0.5,
        "impact": random.uniform(size=number),
    }
    table = pandas.DataFrame({**POINT, **columns, "outcome": "erosion", "split": "fit", "fragment_index": 2.0})
    lost = np.abs(random.normal(0.1, 0.02, number)) * table.velocity**0.5
    table = table.assign(largest=2 / 3 - lost, second=lost, filling_largest=0.2 * (1 + lost))
    told = Remains(table[:800]).intervals(variables(table[800:]))
    for name, found in within(told, table[800:]).items():
        assert found == pytest.approx(0.9, abs=0.045), name  # three standard errors of 400


def surface(low, high):
    """OutcomeTable whose p_bounce is above 1/2 between two velocities."""
    axes = (Axis("velocity", "log10", np.geomspace(0.1, 10, 41)), *outcome_axes(GROWN, False)[1:])
    shape = tuple(len(axis.nodes) for axis in axes)
    log = np.log(axes[0].nodes)
    p = 0.5 + 0.2 * np.minimum(log - np.log(low), np.log(high) - log).clip(-2, 2)
    p = np.broadcast_to(p[:, None, None, None], shape)
    columns = {
        "p_bouncing": p,
        "error_bouncing": np.full(shape, 0.1),
        "inside": np.ones(shape),
        "runs": np.full(shape, 5.0),
    }
    return OutcomeTable(axes, tuple(columns), np.stack(list(columns.values()), axis=-1))


def test_surface_of_bouncing():
    for high, last in ((4.0, pytest.approx(4.0, rel=0.02)), (1e3, np.inf)):
        found = barrier(surface(0.5, high)).iloc[0]
        assert found["first"] == pytest.approx((0.5, 0.5 / np.exp(0.5), 0.5 * np.exp(0.5)), rel=0.02)
        assert found["last"][0] == last
    nowhere = barrier(surface(30.0, 40.0)).iloc[0]
    assert nowhere.p < 0.5 and np.isnan([nowhere["first"][0], nowhere["last"][0]]).all()


def test_a_query_beyond_the_runs_is_an_extrapolation(made):
    near, of_half = Neighbours(made), Neighbours(made[::2])
    assert (
        near.beyond(point())[0] < 0
        and near.within(point(), averaged=True)[0] > near.within(point(), averaged=False)[0] > 0
    )
    at = variables(made[1::2])
    assert np.mean(of_half.beyond(at) <= MARGIN) > 0.9  # of 300 runs; corners of their box are beyond
    for grains in (300, 1e6):  # slower than any run, and below one contact's energy
        assert near.beyond(point(velocity=1e-4, grains_target=grains))[0] <= 0, grains
    for beyond in ({"velocity": 1e4}, {"grains_target": 1e6}, {"filling_target": 0.9, "filling_projectile": 0.9}):
        assert near.beyond(point(**beyond))[0] > 4 * MARGIN, beyond


def test_the_gallerys_tables_tell_pieces_of_held_out_runs():
    """Between their nodes too: the intervals of the largest piece hold nine of ten runs that leave several (0.85: three standard errors less), and
    no more mass comes out than there was. Half of the BCCA aggregates are fluffier than a filling of 0.02."""
    _, all_held = fit_and_held_out(read_runs())
    holds = []
    for structure in STRUCTURES:
        held = of_structure(all_held, structure)
        at, several = variables(held), held.pieces > 1
        speed, small = at.velocity * breaking_velocity(ICE, GRAIN_RADIUS["ice"]), at.mass_ratio * at.grains
        pair = (of.to_numpy() for of in (speed, small, at.grains, at.filling))
        told = analysis.outcome(*pair, impact=np.sqrt(at.impact_square).to_numpy(), structure=structure)
        assert np.all(told["largest"] + told["second"] < 1 + 1e-5)
        inside = told["inside"] == 1
        within = (told["largest_low"] <= held.largest) & (held.largest <= told["largest_high"])
        holds.append(within[inside & several])
        fluffy = (at.filling < 0.02) & (at.grains >= 64)
        assert structure != GROWN or inside[fluffy].mean() > 0.9 and fluffy.sum() > 50
    holds = np.concatenate(holds)
    assert holds.mean() > 0.85 and len(holds) > 250
    # one node loses much of a large target, the other of a small one
    between = analysis.outcome(72.0, 112, 190, 0.05, impact=0.076)
    assert between["inside"] == 1 and between["largest"] >= between["second"] and between["largest_low"] >= 0
    assert set(analysis.outcome(72.0, 112, 190, 0.05, columns=["second"])) == {"second", "inside"}


def test_no_aggregate_loses_more_than_an_eroded_one_may_at_the_gallerys_nodes():
    """Half of its mass (rules.KEPT), and of the two largest pieces the second is no larger."""
    files = sorted(grid.FOLDER.glob("outcomes*.txt"))
    assert len(files) == 4
    for table in map(read_outcomes, files):
        of = lambda name: table.values[..., table.columns.index(name)]
        along = [-1 if axis.name == "mass_ratio" else 1 for axis in table.axes]
        ratio = table.axes[along.index(-1)].nodes.reshape(along)
        assert np.all(of("loss_erosion") * ratio <= KEPT + 1e-4)
        assert np.all(of("second") <= np.minimum(of("largest"), 1 - of("largest")) + 1e-4)


def test_command_with_the_gallerys_atlas(capsys, monkeypatch):
    query = "outcome --projectile 200 --target 300 --filling 0.3 --velocity"
    ask = lambda options, velocity=1: main(f"{query} {velocity} {options}".split())
    for options in ("", "--impact 0.3", "--maxwell", "--maxwell --impact 0.3"):
        assert ask(options) == 0
        lines = capsys.readouterr().out.splitlines()
        assert float(lines[1].split()[1]) > 0.8 and lines[1].split()[0] == "sticking"
        assert any("study.py runs/atlas-full-" in line for line in lines) and "EXTRAPOLATION" not in "".join(lines)
        assert ("in 90 %" in "".join(lines)) == (options == "--impact 0.3")
    assert ask("", velocity=300) == 0
    title, beyond, sticking = capsys.readouterr().out.splitlines()[:3]
    assert "of ice, radius 0.1 um, " in title and "EXTRAPOLATION" in beyond and "error is not known" in beyond
    assert sticking.split()[0] == "sticking" and "(" not in sticking
    for radius in (None, 6e-7):  # collide()'s of silicate
        assert ask("--material silicate" + (f" --grain-radius {radius}" if radius else ""), 0.5) == 0
        assert "of silicate, radius 0.6 um, filling 0.3, 0.5 m/s (7.08 v_break)" in capsys.readouterr().out
    of = [analysis.outcome(0.5, 200, 20, 0.1, "silicate", r)["p_sticking"] for r in (None, 6e-7, 1e-7)]
    assert of[0] == of[1] < of[2]
    assert ask("--structure close-packed --impact 0") == 0
    assert capsys.readouterr().out.startswith("close-packed aggregates of 200 and 300 grains of ice")
    dense = [analysis.outcome(5, 200, 500, 0.45, structure=own)["p_bouncing"] for own in STRUCTURES]
    assert dense[1] > dense[0] + 0.1
    with pytest.raises(ValueError, match="file = mine: must be left out with a structure"):
        analysis.outcome(5, 200, 500, 0.4, file="mine", structure=GROWN)
    with pytest.raises(SystemExit, match="0"):
        ask("--help")
    assert "1e-07 of ice and 6e-07 of silicate" in " ".join(capsys.readouterr().out.split())
    assert (
        ask("--material lead") == 2
        and capsys.readouterr().err == "analysis: material = lead: must be ice or silicate\n"
    )
    monkeypatch.setattr(query_of, "read_table", lambda *about: (read_table(*about)[0].head(5),))
    assert ask("") == 2 and "fill no region" in capsys.readouterr().err
    with pytest.raises(SystemExit, match="2"):
        ask("--impact 3")
    assert "argument --impact: 3: must be 0 to 1, or averaged" in capsys.readouterr().err
