import pytest

pytest.importorskip("numba", reason="numba (the extra fast) is not installed")

from tracker.tracking.compiled import kept
from tracker.tracking.compiled.kernel import track_frame
from tracker.tracking.ready import compile_tracker


@pytest.fixture
def said(monkeypatch, tmp_path):
    """What is said where the machine code would be in an empty folder."""
    monkeypatch.setattr(kept, "folder", lambda: tmp_path)
    return []


def test_the_compiler_s_minute_is_announced_once(said, tmp_path):
    compile_tracker(said.append)
    assert said == ["Compiling the tracker, once on this machine: about a minute ..."]
    (tmp_path / "kernel.track_frame-kept.py311.1.nbc").touch()
    compile_tracker(said.append)
    assert len(said) == 1


def test_machine_code_that_cannot_be_kept_is_said(said, monkeypatch):
    monkeypatch.setattr(track_frame._cache, "trouble", "/srv: Read-only file system")
    compile_tracker(said.append)
    assert "cannot be kept (/srv: Read-only file system)" in said[-1]
    assert "NUMBA_CACHE_DIR" in said[-1]
