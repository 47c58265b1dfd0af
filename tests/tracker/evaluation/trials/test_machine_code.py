import numpy as np
import pytest

from tracker.evaluation.trials import machine_code as module
from tracker.evaluation.trials.machine_code import machine_code
from tracker.tracking.settings import settings_of


def halves_and_gate(values, settings):
    halves = np.empty(len(values))
    for row in range(len(values)):
        halves[row] = settings.ranged_limit / (2.0 * values[row])
    return halves


@pytest.fixture(params=["numba", "Python"])
def runs(request, monkeypatch, tmp_path):
    """The function above, compiled or not, with an empty place for what is compiled."""
    from tracker import Config

    if request.param == "numba" and module.machine() is None:
        pytest.skip("numba is not there")
    if request.param == "Python":
        monkeypatch.setattr(module, "machine", lambda: None)
    monkeypatch.setattr(module, "_folder", lambda: tmp_path)
    module._compiled.cache_clear()
    settings = settings_of(Config())
    yield lambda values: machine_code(halves_and_gate)(values, settings), settings
    module._compiled.cache_clear()


def test_settings_are_known_by_name(runs):
    run, settings = runs
    np.testing.assert_allclose(run(np.array([1.0, 2.0])) * [2.0, 4.0], settings.ranged_limit)


def test_infinities_are_quiet(runs):
    run, _ = runs
    assert np.isinf(run(np.array([0.0, 1.0]))[0])


def test_machine_code_is_kept(tmp_path, runs, request):
    run, _ = runs
    run(np.ones(1))
    assert any(tmp_path.glob("*.nbi")) == ("numba" in request.node.name)
