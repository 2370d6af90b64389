"""The atlas's tables of outcomes in Python, in Fortran and in DustPy."""

import shutil
import subprocess
from math import pi
from pathlib import Path

import numpy as np
import pytest

from analysis.atlas.adapters.dustpy import use_atlas
from analysis.atlas.outcome_table import PROBABILITIES, Axis, OutcomeTable, read_outcomes, write_outcomes
from analysis.theory import ICE, interaction_energies, pair_constants

ROOT = Path(__file__).parents[2]
READER = ROOT / "analysis/atlas/adapters/dust_outcomes.f90"
AXES = (
    Axis("velocity", "log10", np.geomspace(0.1, 30, 9)),
    Axis("grains", "log10", np.array([60.0, 500.0, 4000.0])),
    Axis("mass_ratio", "log10", np.array([0.02, 0.2, 1.0])),
    Axis("filling", "linear", np.array([0.03, 0.1, 0.3, 0.55])),
)


@pytest.fixture
def table():
    """Of random values; `product` is linear in every scaled coordinate."""
    v, n, q, f = np.meshgrid(*(axis.nodes for axis in AXES), indexing="ij")
    linear = (1 + np.log10(v)) * np.log10(n) * (2 + np.log10(q)) * (1 - f)
    values = np.stack([np.random.default_rng(1).random(v.shape), linear, (v > 3).astype(float), (n < 1000) * 1.0], -1)
    return OutcomeTable(AXES, ("p_sticking", "product", "threshold", "inside"), values, ("of a test",))


def queries(number, margin):
    """{axis: values} up to a factor `margin` beyond the edges."""
    draw = np.random.default_rng(2).uniform
    return {a.name: np.exp(draw(*np.log([a.nodes[0] / margin, a.nodes[-1] * margin]), number)) for a in AXES}


def test_lookup_is_multilinear_and_beyond_the_edges_constant(table, tmp_path):
    write_outcomes(tmp_path / "outcomes.txt", table)
    read = read_outcomes(tmp_path / "outcomes.txt")
    assert read.columns == table.columns and read.comments == table.comments
    within = queries(1000, 1.0)
    v, n, q, f = within.values()
    found = table.lookup(**within)
    linear = (1 + np.log10(v)) * np.log10(n) * (2 + np.log10(q)) * (1 - f)
    np.testing.assert_allclose(found["product"], linear, rtol=1e-12)
    assert np.all((found["inside"] == 1) == (n <= 500))
    far = queries(1000, 3.0)
    edge = {axis.name: np.clip(far[axis.name], *axis.nodes[[0, -1]]) for axis in AXES}
    beyond = table.lookup(**far)
    np.testing.assert_array_equal(beyond["p_sticking"], table.lookup(**edge)["p_sticking"])
    assert 0 < np.mean(beyond["inside"] == 0) < 1


def test_maxwell_of_a_threshold_has_its_closed_form_and_loss_is_that_of_the_collisions_that_erode():
    """Erosion above a speed between two nodes, to the distance of the nodes, takes 3; what the table has below counts
    for nothing."""
    speeds = np.geomspace(0.01, 100, 400)
    erodes = speeds > 3
    columns = np.stack([erodes, np.where(erodes, 3.0, 0.5), np.ones(400)], -1)
    step = np.broadcast_to(columns[:, None, None, None], (400, 3, 3, 4, 3))
    fine = (Axis("velocity", "log10", speeds), *AXES[1:])
    rms = OutcomeTable(fine, ("p_erosion", "loss_erosion", "inside"), step).maxwell()
    often, loss = np.moveaxis(rms.values[:, 0, 0, 0, :2], -1, 0)
    d = (3 / speeds) ** 2
    np.testing.assert_allclose(often[:350], ((1.5 * d + 1) * np.exp(-1.5 * d))[:350], atol=0.02)
    assert loss[often > 1e-9] == pytest.approx(3.0) and loss[often == 0] == pytest.approx(0.5)


def test_wrong_tables_are_refused(table, tmp_path):
    file = tmp_path / "outcomes.txt"
    write_outcomes(file, table)
    file.write_text(file.read_text().replace("log10 0.1", "log10 0.9", 1))
    with pytest.raises(ValueError, match=f"^{file}: .*increasing"):
        read_outcomes(file)


PROGRAM = """program ask
   use dust_outcomes
   use iso_fortran_env, only: real64
   real(real64) :: query(4), values(4), inside
   integer :: status
   call read_outcomes('outcomes.txt')
   do
      read(*, *, iostat=status) query
      if (status /= 0) exit
      call look_up(query, values, inside)
      write(*, '(5es25.16)') values, inside
   end do
end program
"""
# What mcdust has of its own around the example of the adapters' README.md: names and kinds.
MCDUST = """module collisions
   use dust_outcomes, only: dp, look_up, column
   type :: swarm
      real :: mass
   end type
   real :: erosion_mass_ratio
contains
   subroutine collision(nri, nrk, swarms, relvels, accelncol)
      integer, intent(in) :: nri, nrk
      type(swarm) :: swarms(:)
      real :: relvels(:,:), accelncol(:,:)
{}
   end subroutine
end module
"""


@pytest.mark.skipif(not shutil.which("gfortran"), reason="gfortran is not installed")
def test_fortran_answers_as_python_does_and_the_example_for_mcdust_compiles(table, tmp_path):
    """With mcdust's flag; a query that is none ends the program."""
    write_outcomes(tmp_path / "outcomes.txt", table)
    page = (ROOT / "analysis/atlas/adapters/README.md").read_text()
    (tmp_path / "collisions.f90").write_text(MCDUST.format(page.partition("```fortran\n")[2].partition("```")[0]))
    (tmp_path / "ask.f90").write_text(PROGRAM)
    fortran = ["gfortran", "-fdefault-real-8", "-fcheck=all", READER]
    subprocess.run([*fortran, "-c", "collisions.f90"], cwd=tmp_path, check=True)
    subprocess.run([*fortran, "ask.f90", "-o", "ask"], cwd=tmp_path, check=True)
    ask = lambda lines: subprocess.run([tmp_path / "ask"], input=lines, cwd=tmp_path, capture_output=True, text=True)
    query = queries(2000, 2.0)
    lines = "\n".join(" ".join(map(repr, row)) for row in np.column_stack(list(query.values())).tolist())
    theirs = np.array(ask(lines).stdout.split(), dtype=float).reshape(-1, 5)
    ours = read_outcomes(tmp_path / "outcomes.txt").lookup(**query)
    values = np.column_stack([*ours.values(), ours["inside"]])
    assert theirs[:, [0, 1, 2, 4]] == pytest.approx(values[:, [0, 1, 2, 4]], rel=1e-12, abs=1e-12)
    for wrong in ("-1 100 0.5 0.2\n", "nan 100 0.5 0.2\n"):
        assert "query must be 0 or more" in ask(wrong).stderr


# ---- DustPy, with tables of which the answer is known (make test-dustpy) ----


BREAK = interaction_energies(pair_constants(ICE, 1e-7))["break"]


@pytest.fixture
def sim():
    """Five radial cells of ice grains with a filling of 0.3, masses of two grains to a milligram."""
    dustpy = pytest.importorskip("dustpy", reason="DustPy is not installed; make test-dustpy has it")
    sim = dustpy.Simulation(verbosity=0)
    sim.ini.grid.Nr, sim.ini.grid.rmin, sim.ini.grid.rmax = 5, 5 * dustpy.constants.au, 60 * dustpy.constants.au
    sim.ini.grid.mmin, sim.ini.grid.mmax, sim.ini.dust.rhoMonomer = 1e-14, 1e-3, 1.0
    sim.initialize()
    sim.writer = None
    sim.dust.fill[...] = 0.3
    sim.update()
    return sim


def table_of(probabilities, speeds=20, inside=1.0, touching=1.0):
    """OutcomeTable of probabilities(v, n, q, f) of PROBABILITIES; v is over v_break."""
    axes = (Axis("velocity", "log10", 0.01 * 1e4 ** np.linspace(0, 1, speeds) ** 1.5), *AXES[1:])
    grid = np.meshgrid(*(axis.nodes for axis in axes), indexing="ij")
    columns = dict(zip(PROBABILITIES, probabilities(*grid)))
    columns |= {"p_touching": touching, "gain_mass_transfer": 0.4, "loss_erosion": 1.0, "largest_fragmentation": 0.3}
    columns |= {"fragment_index": 2.0, "inside": inside}
    values = np.stack(np.broadcast_arrays(*columns.values(), grid[0])[:-1], -1)
    return OutcomeTable(axes, tuple(columns), values)


def smooth(v, n, q, f):
    breaks = v / (v + 10) * (1 - 0.3 * q)
    bounces = (1 - breaks) * f * np.log10(n) / 8
    return 1 - breaks - bounces, bounces, 0.5 * breaks, 0.3 * breaks, 0.2 * breaks


def test_probabilities_are_those_of_the_table_at_each_radius_s_filling(sim):
    sim.dust.fill[...] = np.linspace(0.1, 0.4, 5)[:, None]
    sim.update()
    table = table_of(smooth, touching=0.8)
    use_atlas(sim, table, speeds="rms")
    frag, stick = np.asarray(sim.dust.p.frag), np.asarray(sim.dust.p.stick)
    grain = 4 / 3 * pi * 1e-21 * 1000  # kg
    mass = np.asarray(sim.grid.m) * 1e-3
    larger, smaller = np.maximum.outer(mass, mass), np.minimum.outer(mass, mass)
    for r in range(1, 4):
        speed, filling = np.asarray(sim.dust.v.rel.tot)[r] / 100, float(np.asarray(sim.dust.fill)[r, 0])
        query = {"grains": larger / grain, "mass_ratio": smaller / larger, "filling": filling}
        found = table.lookup(velocity=speed / np.sqrt(BREAK / grain), **query)
        transfer = found["p_mass_transfer"]
        np.testing.assert_allclose(stick[r], 0.8 * (found["p_sticking"] + 0.7 * transfer), atol=1e-9)
        np.testing.assert_allclose(1 - stick[r] - frag[r], 0.8 * found["p_bouncing"] + 0.2, atol=1e-9)
    for p in (frag, stick):
        assert not p[[0, -1]].any() and np.array_equal(p, p.swapaxes(1, 2)) and p.min() >= 0
    assert (frag + stick).max() <= 1


def test_mass_is_conserved(sim):
    """Where nothing drifts and diffuses, each radial cell keeps its mass."""
    use_atlas(sim, table_of(smooth), fragment_index=True)
    for field in (sim.dust.v.rad, sim.dust.D):
        field[...] = 0.0
        field.updater = None
    before = np.asarray(sim.dust.Sigma)[1:-1].copy()
    sim.t.snapshots = np.array([100.0]) * 3.15576e7  # years
    sim.run()
    after = np.asarray(sim.dust.Sigma)[1:-1]
    assert np.abs((after - before) / before.sum(axis=1, keepdims=True)).max() > 1e-3
    np.testing.assert_allclose(after.sum(axis=1), before.sum(axis=1), rtol=1e-10)
