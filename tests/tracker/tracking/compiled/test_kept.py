import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("numba", reason="numba (the extra fast) is not installed")

ROOT = Path(__file__).parents[4]

#: Compiles a small function of a file of its own, and says whether it came from the folder.
PROGRAM = """
import sys
sys.dont_write_bytecode = True
sys.path.append(sys.argv[1])
from tracker.tracking.compiled import kept
import small
double = small.double
print(double(2.0), sum(double.stats.cache_hits.values()), kept.trouble_of(double))
"""
SMALL = """
from numba import float64
from tracker.tracking.compiled.kept import kept

@kept(float64(float64))
def double(number):
    return {factor} * number
"""


@pytest.fixture
def compiled(tmp_path):
    def run(factor=2.0, **environment):
        path = tmp_path / "small.py"
        path.write_text(SMALL.format(factor=factor))
        os.utime(path)  # as an installation does
        ended = subprocess.run(
            [sys.executable, "-c", PROGRAM, str(tmp_path)],
            env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), **environment},
            capture_output=True,
            text=True,
            cwd=ROOT,
        )
        assert ended.returncode == 0, ended.stderr
        value, hits, trouble = ended.stdout.rstrip("\n").split(" ", 2)
        return float(value), int(hits), trouble

    return run


def test_machine_code_outlives_an_installation_and_no_change(compiled):
    assert compiled() == (4.0, 0, "")
    assert compiled() == (4.0, 1, "")
    assert compiled(factor=3.0) == (6.0, 0, "")


def test_what_cannot_be_kept_is_compiled_all_the_same(compiled, tmp_path):
    (tmp_path / "cache").write_text("a file where the folder should be")
    value, hits, trouble = compiled()
    assert (value, hits) == (4.0, 0)
    assert str(tmp_path / "cache") in trouble


def test_what_is_kept_and_broken_is_compiled_anew(compiled, tmp_path):
    compiled()
    for path in (tmp_path / "cache").rglob("*.nb?"):
        path.write_bytes(b"")
    assert compiled() == (4.0, 0, "")


def test_any_source_of_the_tracking_counts(monkeypatch, tmp_path):
    from tracker.tracking.compiled import kept

    shutil.copytree(ROOT / "tracker/tracking", tmp_path / "tracking")
    monkeypatch.setattr(kept, "__file__", str(tmp_path / "tracking/compiled/kept.py"))

    def name():
        kept.folder.cache_clear()
        return kept.folder().name

    before = name()
    for path in (tmp_path / "tracking").rglob("*.py"):
        os.utime(path, (1, 1))
    assert name() == before
    with (tmp_path / "tracking/view.py").open("a") as file:
        file.write("# changed\n")
    assert name() != before
    monkeypatch.undo()
    kept.folder.cache_clear()
