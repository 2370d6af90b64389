"""JKRWadaConstants and JKRWadaBond in YADE are the kernel's lists of constants, with the same numbers."""

from scenes import *


def of_the_plugin():
    functor = Ip2_JKRMat_JKRMat_JKRWadaPhys(
        linearDamping=0.02,
        slidingStiffnessFactor=2,
        rollingStiffnessFactor=3,
        springDamping=1e-12,
        mixedSurfaceEnergyFactor=0.3,
    )
    bonding = Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=0.4)
    return (
        functor.pairConstants(ice(), 1e-7, soft(viscoelasticTime=4e-12), 3e-7),
        bonding.bondConstants(ice(), 1e-7, soft(), 3e-7),
    )


def test_attributes_are_the_kernels_constants_to_the_bit(yade, kernel):
    pair_found, bond_found = yade(of_the_plugin)
    pair = kernel.constants("ice", 1e-7, "viscous", 3e-7, 0.02, 2, 3, 1e-12, 0.3)
    assert set(pair_found) == set(kernel.constant_names) - {"inverseEquilibriumOverlap"}
    assert pair_found == {name: getattr(pair, name) for name in pair_found}
    bond = kernel.bond_constants(0.4, "ice", 1e-7, "viscous", 3e-7)
    assert set(bond_found) == set(kernel.bond_constant_names)
    assert bond_found == {name: getattr(bond, name) for name in bond_found}
