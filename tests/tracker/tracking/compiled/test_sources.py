import os
from pathlib import Path

import pytest

pytest.importorskip("numba", reason="numba (the extra fast) is not installed")


def test_kept_machine_code_goes_by_another_name_once_any_source_has_changed(monkeypatch):
    from tracker.tracking.compiled import sources

    def function(): ...

    def named():
        sources._digest.cache_clear()
        function.__qualname__ = "function"
        return sources.named_after_sources(function).__qualname__

    before = named()
    assert before == named()
    stat = Path.stat

    def changed(path, **options):
        state = stat(path, **options)
        if path.name != "view.py":
            return state
        return os.stat_result([*state[:6], state.st_size + 1, *state[7:]])

    monkeypatch.setattr(Path, "stat", changed)
    assert named() != before
    monkeypatch.undo()
    sources._digest.cache_clear()
