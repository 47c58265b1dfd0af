from pathlib import Path

import platformdirs
import pytest

from tracker.errors import ModelFileError
from tracker.perception.models import ModelStore
from tracker.user_cache import user_cache


def test_a_user_without_a_home_has_no_cache(monkeypatch):
    monkeypatch.delenv("RAISED_HAND_MODELS", raising=False)
    monkeypatch.setattr(platformdirs, "user_cache_path", lambda *_, **__: Path("~/.cache/x"))
    assert user_cache() is None
    with pytest.raises(ModelFileError, match=r"no home folder .*set RAISED_HAND_MODELS"):
        ModelStore()
