"""A small function that is compiled in no time, in a file of its own."""

import importlib
import sys

import pytest

SMALL = """
import os
import sys
import time

from tracker.compiling.loops import step

@step
def doubled(number):
    return {factor} * number

def double(number):
    return doubled(number)

def build(folder, may_compile=True):
    from numba import float64
    from tracker.compiling.compiler import compiled
    return compiled(double, float64(float64), folder, may_compile)

def linger(folder, may_compile=True):
    if len(sys.argv) == 1:  # loads what the compiler's process left
        return double
    (folder / (str(os.getpid()) + ".begun")).touch()
    with (folder / "diary").open("a") as diary:
        diary.write("begin ")
        diary.flush()
        time.sleep(0.3)
        diary.write("end ")

def fail(folder, may_compile=True):
    raise RuntimeError("no compiler today")
"""


@pytest.fixture
def small(tmp_path, monkeypatch):
    """Makes the module, which other processes find as well."""
    pytest.importorskip("numba", reason="numba is not installed")
    names = []

    def module(factor=2.0):
        name = f"small_{tmp_path.name}_{len(names)}"
        (tmp_path / f"{name}.py").write_text(SMALL.format(factor=factor))
        importlib.invalidate_caches()
        names.append(name)
        return importlib.import_module(name)

    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{':'.join(filter(None, sys.path))}")
    yield module
    for name in names:
        sys.modules.pop(name)
