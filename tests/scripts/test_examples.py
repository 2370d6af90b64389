"""The examples run as written, and what they print is right."""

import os
import re

import numpy as np
import pytest
from running import TOP, call, forked, messages
from yade_server import SERVER

from analysis import open_run, table
from analysis.export.fields import Exported

EXAMPLES = os.path.join(TOP, "yade_scripts", "examples")
AS_ROOT = {f"{mpi}_ALLOW_RUN_AS_ROOT{end}": "1" for mpi in ("OMPI", "PRTE") for end in ("", "_CONFIRM")}


def example(name, *arguments):
    """What an example prints."""
    done = forked(TOP, os.path.join(EXAMPLES, name), *arguments, server=SERVER)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_a_pair_sticks_below_its_velocity_and_parts_above():
    """Restitution (1 - (v_stick/v)^2)^(1/2): what a contact takes doesn't depend on the velocity."""
    text = example("pair.py")
    assert re.findall(r"(\S+) of it: stick", text) == ["0.50", "0.95"]
    parted = {float(v): float(e) for v, e in re.findall(r"(\S+) of it: part, restitution (\S+)", text)}
    assert parted == {v: pytest.approx((1 - v**-2) ** 0.5, abs=2e-3) for v in (1.05, 2.0)}


def test_the_clusters_energy_is_accounted_for():
    found = re.findall(r"^(\w+) +([+-]\S+) K\(0\)$", example("cluster.py"), re.M)
    changes = {name: float(value) for name, value in found}
    assert changes["kinetic"] < -0.1 and changes["rollingDissipation"] > 0.05
    assert abs(changes.pop("sum")) < 1e-3 and abs(sum(changes.values())) < 2e-3


def test_the_shrinking_cell_has_a_rising_pressure():
    text = example("periodic_cell.py")
    filling = [float(value) for value in re.findall(r"^filling (\S+)", text, re.M)]
    pressure = [float(value) for value in re.findall(r"pressure (\S+) Pa", text)]
    assert len(filling) == 8 and filling == sorted(filling) and filling[-1] > 0.57
    assert len(pressure) == 7 and pressure[2:] == sorted(pressure[2:]) and pressure[-1] > 5e6
    assert float(re.search(r"changed by (\S+) of the largest", text).group(1)) < 1e-3


# {example: (numbers of its result line, in which ranges they must be)}
RECORDED = {
    "heap": (r"a cone (\S+) radii high, with a slope of (\S+) degrees", (12, 20), (35, 55)),
    "sheared_cell": (r"sheared by (\S+): .* stress is (\S+) of the pressure", (0.5, 0.6), (0.05, 0.2)),
    "stretching": (r"strain of (\S+), after (\S+) J", (0.4, 1.2), (1e-14, 5e-14)),
    "spin": (r"(\d+) grains broke at (\S+) rad/s", (300, 300), (7e6, 1.2e7)),
}


@pytest.mark.parametrize("name", RECORDED)
def test_recorded_examples_have_their_result_and_a_run_with_a_closed_ledger(name, tmp_path):
    pattern, *ranges = RECORDED[name]
    folder = f"out={tmp_path}/run" if name in ("spin", "sheared_cell") else str(tmp_path / "run")
    found = [float(number) for number in re.search(pattern, example(f"{name}.py", folder)).groups()]
    assert all(low <= number <= high for number, (low, high) in zip(found, ranges)), found
    run = table(tmp_path / "run")
    assert run.ended[0] and run.energy_closure[0] < 2e-3
    for state in open_run(tmp_path / "run").states:  # contacts are short, across a sheared boundary too
        assert np.all(Exported(state, 1.0).distance() < 2.1 * state.radius.max())


def test_the_cooling_cluster_loses_contacts_and_its_energy_is_accounted_for():
    """Contacts that hold less than nothing hold less of it: the cooling does work on the grains."""
    text = example("cooling.py")
    contacts = [int(value) for value in re.findall(r"(\d+) contacts", text)]
    work = [float(value) for value in re.findall(r"(\S+) K\(0\) done", text)]
    assert contacts == sorted(contacts, reverse=True) and contacts[-1] < 0.7 * contacts[0]
    assert work[0] == 0 and work == sorted(work) and work[-1] > 0.05
    assert float(re.search(r"changed by (\S+) K", text).group(1)) < 1e-4


def test_two_workers_have_the_numbers_of_one_process():
    """The blocks collide across the boundary of the domains; but for rounding, as sums have another order."""
    done = call(TOP, "yade", "-n", "-x", os.path.join(EXAMPLES, "machines.py"), "2", **AS_ROOT)
    if done.returncode or " J kinetic" not in done.stdout:
        pytest.skip("YADE's MPI does not run here")  # Debian 13: not for root without /sys
    assert [line for line in messages(done) if "hwloc" not in line] == []  # MPI's, in a system without /sys
    texts = example("machines.py", "0"), done.stdout
    alone, together = (float(re.search(r"(\S+) J kinetic", text).group(1)) for text in texts)
    assert together == pytest.approx(alone, rel=1e-9) and alone < 1024 * 4.2e-18 * 25 / 2 * 0.999
