"""JKRWadaConstants and JKRWadaBond: the kernel's lists of constants, with their numbers, documentation and units."""

import re

import pytest
from scenes import *


def of_the_plugin():
    functor = Ip2_JKRMat_JKRMat_JKRWadaPhys(linearDamping=0.02, slidingStiffnessFactor=2)
    bonding = Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=0.4)
    return (
        functor.pairConstants(ice(), 1e-7, soft(viscoelasticTime=4e-12), 3e-7),
        bonding.bondConstants(ice(), 1e-7, soft(), 3e-7),
    )


def test_attributes_are_the_kernels_constants_to_the_bit(yade, kernel):
    pair_found, bond_found = yade(of_the_plugin)
    pair = kernel.constants("ice", 1e-7, "viscous", 3e-7, 0.02, 2)
    assert set(pair_found) == set(kernel.constant_names) - {"inverseEquilibriumOverlap"}
    assert pair_found == {name: getattr(pair, name) for name in pair_found}
    bond = kernel.bond_constants(0.4, "ice", 1e-7, "viscous", 3e-7)
    assert set(bond_found) == set(kernel.bond_constant_names)
    assert bond_found == {name: getattr(bond, name) for name in bond_found}


@pytest.mark.in_yade
@pytest.mark.parametrize("name, which", [("JKRWadaConstants", 0), ("JKRWadaBond", 1)])
def test_every_constant_is_documented_with_its_unit(name, which):
    cls = globals()[name]
    documented = {key: value.__doc__ for key, value in vars(cls).items() if isinstance(value, property)}
    assert set(documented) == set(of_the_plugin()[which])
    for attribute, text in documented.items():
        assert re.search(r"\[(m|kg|Pa|N|N/m|N m|rad|N s/m\^2|N s/m|s|J)\]", text), (attribute, text)
