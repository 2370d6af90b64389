"""JKRWadaConstants and JKRWadaBond: the kernel's lists of constants, with their numbers, their documentation and units."""

import re

import pytest

SCRIPT = """
import pydoc
from scenes import *
functor = Ip2_JKRMat_JKRMat_JKRWadaPhys(linearDamping=0.02, slidingStiffnessFactor=2)
result["pair"] = functor.pairConstants(ice(), 1e-7, soft(viscoelasticTime=4e-12), 3e-7)
result["bond"] = Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=0.4).bondConstants(ice(), 1e-7, soft(), 3e-7)
for cls in (JKRWadaConstants, JKRWadaBond):
    result[cls.__name__] = {name: getattr(cls, name).__doc__ for name in vars(cls) if isinstance(getattr(cls, name), property)}
"""


def test_attributes_are_the_kernels_constants_to_the_bit(yade, kernel):
    found = yade(SCRIPT)
    soft = (3e9, 0.33, 1300.0, 0.05, 1.1e-9, 4e-12)
    pair = kernel.constants(kernel.ice, 1e-7, soft, 3e-7, 0.02, 2)
    assert set(found["pair"]) == set(kernel.constant_names) - {"inverseEquilibriumOverlap"}
    assert found["pair"] == {name: getattr(pair, name) for name in found["pair"]}
    bond = kernel.bond_constants(0.4, kernel.ice, 1e-7, soft, 3e-7)
    assert set(found["bond"]) == set(kernel.bond_constant_names)
    assert found["bond"] == {name: getattr(bond, name) for name in found["bond"]}


@pytest.mark.parametrize("name,key", [("JKRWadaConstants", "pair"), ("JKRWadaBond", "bond")])
def test_every_constant_is_documented_with_its_unit(yade, name, key):
    found = yade(SCRIPT)
    assert set(found[name]) == set(found[key])
    for attribute, text in found[name].items():
        assert re.search(r"\[(m|kg|Pa|N|N/m|N m|rad|N s/m\^2|N s/m|s|J)\]", text), (attribute, text)
