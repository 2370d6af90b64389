"""The virtual functions of the plugin's classes stand where those of YADE's classes with the same base do.

Sizes and offsets are asserted when the plugin is compiled (contact_law/yade_interface/layouts.cpp); the order of
virtual functions cannot be.
"""

import ctypes
import re
import subprocess

import pytest

IN_YADE = pytest.mark.in_yade


class Found(ctypes.Structure):
    _fields_ = list(zip(("file", "base", "name", "at"), 2 * (ctypes.c_char_p, ctypes.c_void_p)))


def virtual_functions(class_name):
    """Names of the functions in all tables of a class, without class and arguments; with "-8" and the like for where a
    further table starts."""
    loaded = ctypes.CDLL(None)
    table = (ctypes.c_size_t * 100).in_dll(loaded, f"_ZTVN4yade{len(class_name)}{class_name}E")
    found, symbols = Found(), []
    for slot in range(2, 100):
        if loaded.dladdr(ctypes.c_void_p(table[slot]), ctypes.byref(found)) and found.name:
            symbols.append(found.name.decode())
        elif table[slot] > 2**63:  # the offset to the top of the object
            symbols.append(str(table[slot] - 2**64))
        else:
            break
    lines = subprocess.run("c++filt", input="\n".join(symbols), capture_output=True, text=True, check=True).stdout
    names = []
    for line in lines.splitlines():
        while "<" in line:
            line = re.sub(r"<[^<>]*>", "", line)
        method = re.search(r"(~|\w+)\w*(\[abi:cxx11\])?\(", line)
        names.append(method[1] if method else re.sub(r"typeinfo for .*", "typeinfo", line))
    return names


@IN_YADE
@pytest.mark.parametrize(
    "own, other",
    [
        ("JKRMat", "ElastMat"),
        ("JKRWadaPhys", "NormShearPhys"),
        ("JKRWadaEngine", "ForceResetter"),
        ("Ip2_JKRMat_JKRMat_JKRWadaPhys", "Ip2_FrictMat_FrictMat_FrictPhys"),
        ("Law2_ScGeom_JKRWadaPhys_JKRWada", "Law2_ScGeom_FrictPhys_CundallStrack"),
    ],
)
def test_virtual_functions_stand_where_yade_has_them(own, other):
    functions = virtual_functions(own)
    assert functions == virtual_functions(other) and len(functions) > 13
