"""The atlas's tables of outcomes in Python and Fortran."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from analysis.atlas.outcome_table import Axis, OutcomeTable, OutcomeTableError, read_outcomes, write_outcomes

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


FINE = Axis("velocity", "log10", np.geomspace(0.01, 100, 400))


def test_maxwell_of_a_threshold_has_its_closed_form():
    """Collisions above a speed between two nodes, to the distance of the nodes."""
    step = np.broadcast_to((FINE.nodes > 3)[:, None, None, None, None], (400, 3, 3, 4, 1)).astype(float)
    rms = OutcomeTable((FINE, *AXES[1:]), ("inside",), step).maxwell()
    with pytest.raises(OutcomeTableError, match="must be one of single speeds"):
        rms.maxwell()
    d = (3 / FINE.nodes) ** 2
    np.testing.assert_allclose(rms.values[:350, 0, 0, 0, 0], ((1.5 * d + 1) * np.exp(-1.5 * d))[:350], atol=0.02)


def test_loss_by_erosion_is_the_mean_over_the_collisions_that_erode():
    """Erosion above one speed takes 3; what the table has below counts for nothing."""
    erodes = FINE.nodes > 3
    columns = np.stack([erodes, np.where(erodes, 3.0, 0.5), np.ones(400)], -1)
    step = np.broadcast_to(columns[:, None, None, None], (400, 3, 3, 4, 3))
    rms = OutcomeTable((FINE, *AXES[1:]), ("p_erosion", "loss_erosion", "inside"), step).maxwell()
    often, loss = np.moveaxis(rms.values[:, 0, 0, 0, :2], -1, 0)
    assert loss[often > 1e-9] == pytest.approx(3.0) and loss[often == 0] == pytest.approx(0.5)


@pytest.mark.parametrize(
    "change, says",
    [
        (("log10 0.1", "log10 0.9"), "increasing"),
        (("4 number of columns", "5 number of columns"), "columns; must be 5"),
        (("inside", "outside"), "must have a column `inside`"),
    ],
)
def test_wrong_tables_are_refused(table, tmp_path, change, says):
    file = tmp_path / "outcomes.txt"
    write_outcomes(file, table)
    file.write_text(file.read_text().replace(*change, 1))
    with pytest.raises(OutcomeTableError, match=f"^{file}: .*{says}"):
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
needs_gfortran = pytest.mark.skipif(not shutil.which("gfortran"), reason="gfortran is not installed")


def compiled(folder, table, program, *flags):
    """The program with the reader, and the table beside it."""
    write_outcomes(folder / "outcomes.txt", table)
    (folder / "ask.f90").write_text(program)
    subprocess.run(["gfortran", *flags, READER, "ask.f90", "-o", "ask"], cwd=folder, check=True)
    return folder / "ask"


@needs_gfortran
@pytest.mark.parametrize("flag", ["-O2", "-fdefault-real-8"])  # mcdust compiles with the second
def test_fortran_answers_as_python_does(table, tmp_path, flag):
    ask = compiled(tmp_path, table, PROGRAM, flag, "-Wall", "-fcheck=all")
    query = queries(2000, 2.0)
    lines = "\n".join(" ".join(map(repr, row)) for row in np.column_stack(list(query.values())).tolist())
    answer = subprocess.run([ask], input=lines, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    theirs = np.array(answer.split(), dtype=float).reshape(-1, 5)
    ours = read_outcomes(tmp_path / "outcomes.txt").lookup(**query)
    values = np.column_stack([*ours.values(), ours["inside"]])
    assert theirs[:, [0, 1, 2, 4]] == pytest.approx(values[:, [0, 1, 2, 4]], rel=1e-12, abs=1e-12)


@needs_gfortran
@pytest.mark.parametrize("query", ["-1 100 0.5 0.2", "nan 100 0.5 0.2"])
def test_fortran_stops_at_a_query_that_is_none(table, tmp_path, query):
    ask = compiled(tmp_path, table, PROGRAM)
    done = subprocess.run([ask], input=f"{query}\n", cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode and "query must be 0 or more" in done.stderr


# What mcdust has of its own around the example of README.md: names and kinds.
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


@needs_gfortran
def test_the_example_for_mcdust_compiles(tmp_path):
    page = (ROOT / "analysis/atlas/adapters/README.md").read_text()
    (tmp_path / "collisions.f90").write_text(MCDUST.format(page.partition("```fortran\n")[2].partition("```")[0]))
    subprocess.run(["gfortran", "-fdefault-real-8", "-c", READER, "collisions.f90"], cwd=tmp_path, check=True)
