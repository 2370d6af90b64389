"""Packings in files: made from the command line, read back to the bit; a run refuses those of other grains."""

import json
from dataclasses import replace

import numpy as np
import pytest
from of_ice import GRAINS, ICE, OVERLAP, PAIR, RADIUS
from refused import refused
from running import make_packing

from yade_scripts import packings
from yade_scripts.experiments.collision import KIND, CollisionParameters, place, require_stable_with, step_limit
from yade_scripts.materials import pair_constants
from yade_scripts.packings.aggregate import make
from yade_scripts.packings.packing import OF_CONTACTS, packing_from_file
from yade_scripts.parameters import ParameterError


@pytest.fixture
def files(tmp_path):
    names = []
    for index, grains in enumerate((80, 40)):
        names.append(str(tmp_path / f"{index}.npz"))
        packings.save(names[-1], packings.bpca(grains, RADIUS, OVERLAP, 3, index))
    return names


def test_a_run_of_files_is_that_of_their_packings(files):
    """Each file has the size of its aggregate too."""
    of_files, of_bpca = dict(file=files[0], projectileFile=files[1]), dict(grains=80, projectileGrains=40, seed=3)
    found, pair, velocities = place(CollisionParameters.parse(dict(of_files, packing="file", impact=0.3)), OVERLAP)
    made, expected, of_made = place(CollisionParameters.parse(dict(of_bpca, packing="bpca", impact=0.3)), OVERLAP)
    for one, other in zip(pair, expected):
        assert np.abs(one.position - other.position).max() < 1e-9 * RADIUS
    assert np.allclose(velocities, of_made) and found.grains == made.grains == 80
    assert KIND.estimate(CollisionParameters.parse(dict(packing="file", file=files[0], duration=1e-7))).grains == 160
    with np.load(files[0]) as file:
        packing = packings.load(files[0])
        assert float(file["gyration_radius"]) == packings.gyration_radius(packing)
        assert float(file["characteristic_radius"]) == packings.characteristic_radius(packing)


def write(path, position, radius, **parameters):
    np.savez(path, position=position, radius=radius, seed=1, parameters=json.dumps(parameters))
    return str(path)


@pytest.mark.parametrize(
    "position, radius, message",
    [
        (PAIR * (np.nan, 1, 1), [RADIUS] * 2, "'position' holds a value that is not finite"),
        (PAIR * 0.99, [RADIUS] * 2, "must be at most 1.1 of the equilibrium"),
        (PAIR * 6, [6 * RADIUS] * 2, "made of grains with grainRadius = 6e-07, not 1e-07"),
    ],
)
def test_grains_that_no_run_can_start_from_give_one_line(tmp_path, position, radius, message):
    path = write(tmp_path / "a.npz", position, np.array(radius))
    with refused(packings.PackingError, f"{path}: ", message):
        packing_from_file(path, GRAINS, OVERLAP)


def test_grains_of_another_material_are_refused(tmp_path):
    """Of Young's modulus and surface energy in proportion, so that contacts at rest are as of ice, with other
    forces: an energy that nobody put in."""
    material = replace(ICE, young=3.5e9, surfaceEnergy=0.05)
    given = {name: getattr(material, name) for name in OF_CONTACTS}
    path = write(tmp_path / "a.npz", PAIR, np.full(2, RADIUS), overlap=OVERLAP, packing="compressed", **given)
    with refused(packings.PackingError, f"{path}: made of grains with young = 3.5e+09, not 7e+09"):
        packing_from_file(path, GRAINS, OVERLAP)
    assert packing_from_file(path, GRAINS.changed(young=3.5e9, surfaceEnergy=0.05), OVERLAP).grains == 2


def test_the_step_is_stable_for_the_smallest_grain(tmp_path):
    """Whether grains of unlike size are made in the run or read from a file, which may be denser than what grows."""
    path = str(tmp_path / "a.npz")
    sizes = dict(packing="bpca", grains=40, sizes="two", sizeRatio=0.5)
    packings.save(path, make(CollisionParameters.parse(sizes), OVERLAP, 0))

    def require(step, **given):
        parameters = CollisionParameters.parse(dict(stepFraction=step, **given))
        require_stable_with(parameters, pair_constants(parameters), place(parameters, OVERLAP)[1])

    limit = step_limit(CollisionParameters.parse(sizes), pair_constants(GRAINS), (RADIUS / 2, RADIUS))
    assert limit < 0.2
    require(0.99 * limit, **sizes)
    require(0.7 * limit, packing="file", file=path)
    for given in (sizes, dict(packing="file", file=path)):
        with pytest.raises(ParameterError, match="stepFraction = .*: unstable at .* with grains of these sizes"):
            require(1.01 * limit, **given)
    packings.save(path, packings.bpca(40, RADIUS, OVERLAP, 1))
    require(0.3, packing="file", file=path)


def test_the_command_makes_packings_and_says_of_what(tmp_path):
    done = make_packing(tmp_path, "a.npz", "b.npz", "radius=10", "seed=3")
    assert done.returncode == 0, done.stderr
    for index, name in enumerate(["a.npz", "b.npz"]):
        loaded, expected = packings.load(tmp_path / name), packings.cpe(0.4, 10 * RADIUS, RADIUS, OVERLAP, 3, index)
        assert np.array_equal(loaded.position, expected.position) and np.array_equal(loaded.radius, expected.radius)
        assert loaded.seed == 3 and expected.parameters.items() <= loaded.parameters.items()
