import json
import re
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context

import numpy as np
import pytest

from tracker.config import Config
from tracker.errors import ConfigError, RecordingError
from tracker.evaluation.trials.scenario import SCENARIOS
from tracker.evaluation.tuning.objective import ScenarioObjective
from tracker.evaluation.tuning.result import tuning_as_dict
from tracker.evaluation.tuning.search import tune

pytest.importorskip("optuna", reason="Optuna is not installed")
NAMES = ("acceleration_density", "confirm_detections")


@dataclass(frozen=True)
class Bowl:
    """Least at an acceleration density of 2; the unseen parts lie a little higher."""

    name: str = "bowl"
    stop_above: float = float("inf")

    figure = "cost (m)"
    is_cost = True
    parts = 2

    def seen(self, config):
        if config.acceleration_density > self.stop_above:
            raise KeyboardInterrupt
        cost = np.log(config.acceleration_density / 2.0) ** 2
        yield from (cost, cost + 0.1)

    def unseen(self, config, run=map):
        return np.array(list(run(_Cost(config), range(5))))

    def check(self, names):
        pass

    def describe(self):
        return self.name


@dataclass(frozen=True)
class _Cost:
    config: Config

    def __call__(self, number):
        return 1.0 + 0.01 * number + np.log(self.config.acceleration_density / 2.0) ** 2


@pytest.fixture
def storage(tmp_path):
    return f"sqlite:///{tmp_path / 'tuning.db'}"


def test_the_first_trial_is_the_configuration_that_is_there(storage):
    result = tune(Bowl(), NAMES, Config(), trials=1, storage=storage)
    assert result.best == Config()
    assert result.gain[0] == 0.0


def test_a_search_finds_better_and_its_verdict_is_about_the_unseen(storage):
    result = tune(Bowl(), NAMES[:1], Config(), trials=25, storage=storage)
    assert result.best.acceleration_density == pytest.approx(2.0, rel=0.3)
    cost = _Cost(result.best)
    assert result.unseen_best == pytest.approx([cost(number) for number in range(5)])
    gain, low, high = result.gain
    assert low <= gain <= high
    assert gain == pytest.approx(np.log(0.6 / 2.0) ** 2, rel=0.1)
    assert result.relative_gain == pytest.approx(gain / result.unseen_base.mean())


def test_a_search_goes_on_where_it_was(storage):
    first = tune(Bowl(), NAMES, Config(), trials=3, storage=storage)
    again = tune(Bowl(), NAMES, Config(), trials=5, storage=storage)
    assert (first.trials, again.trials) == (3, 5)
    assert again.value[: len(first.value)].tolist() == first.value.tolist()
    assert tune(Bowl(), NAMES, Config(), trials=5, storage=storage).trials == 5


def test_an_interrupted_search_goes_on(storage):
    with pytest.raises(KeyboardInterrupt):
        tune(Bowl(stop_above=0.7), NAMES, Config(), trials=20, storage=storage)
    after = tune(Bowl(), NAMES, Config(), trials=20, storage=storage)
    assert after.trials == 20
    assert after.best.acceleration_density > 0.7


def test_the_same_seed_tries_the_same(tmp_path):
    one, two, other = (
        tune(Bowl(), NAMES, Config(), trials=4, storage=f"sqlite:///{tmp_path / name}", seed=seed)
        for name, seed in (("a.db", 1), ("b.db", 1), ("c.db", 2))
    )
    assert one.tried == two.tried
    assert one.tried != other.tried


def test_another_search_is_not_mixed_into_the_study(storage):
    tune(Bowl(), NAMES, Config(), trials=1, storage=storage)
    with pytest.raises(ConfigError, match="holds a search with another searched"):
        tune(Bowl(), NAMES[:1], Config(), trials=1, storage=storage)
    with pytest.raises(ConfigError, match="another base"):
        tune(Bowl(), NAMES, Config(range_std_m=0.1), trials=1, storage=storage)


def test_several_processes_share_one_search(storage):
    told = []
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        result = tune(
            SHORT, NAMES, Config(), trials=5, storage=storage, jobs=2, executor=executor,
            progress=lambda done, best: told.append(done),
        )  # fmt: skip
    assert result.trials == told[-1] == 5
    assert len(result.unseen_base) == 2


SHORT = ScenarioObjective(
    "people", replace(SCENARIOS["people"], duration_s=1.0), parts=2, scene_s=1.0, unseen_scenes=2
)


def test_parameters_that_contradict_each_other_end_a_trial_and_not_the_search(storage):
    names = ("confirm_detections", "confirm_window")
    result = tune(Bowl(), names, Config(), trials=15, storage=storage)
    assert result.trials == 15
    assert len(result.value) < 15
    assert result.best.confirm_detections <= result.best.confirm_window


def test_the_numbers_for_machines_are_plain(storage):
    result = tune(Bowl(), NAMES, Config(), trials=3, storage=storage)
    document = json.loads(json.dumps(tuning_as_dict(result)))
    assert document["trials"] == 3
    assert len(document["history"]) == len(result.value) >= 1
    assert set(document["parameters"]) == set(NAMES)


def test_a_missing_optuna_says_how_to_get_it(storage, monkeypatch):
    monkeypatch.setitem(sys.modules, "optuna", None)
    with pytest.raises(ConfigError, match=r"pip install '.\[tune\]'"):
        tune(Bowl(), NAMES, Config(), trials=1, storage=storage)


@pytest.mark.parametrize(
    "address",
    ["nonsense", "foo://bar", "redis://localhost:1/0", "oracle://a@b/c", "sqlite+x:///a.db", ""],
)
def test_a_storage_that_is_none_is_named(address):
    with pytest.raises(ConfigError, match=f"--storage {re.escape(address)}: cannot be used") as it:
        tune(Bowl(), NAMES, Config(), trials=1, storage=address)
    assert "expected an address of a database" in str(it.value)
    assert "\n" not in str(it.value)


@pytest.mark.parametrize(
    ("prepare", "reason"),
    [
        (lambda path: None, "unable to open database file"),
        (lambda path: path.parent.mkdir() or path.write_bytes(b"x" * 5000), "not a database"),
        (lambda path: path.mkdir(parents=True), "unable to open database file"),
    ],
    ids=["no folder", "garbage", "a folder"],
)
def test_a_storage_that_cannot_be_used_is_named_with_the_true_cause(tmp_path, prepare, reason):
    path = tmp_path / "new" / "tuning.db"
    prepare(path)
    with pytest.raises(RecordingError, match=f"cannot be read or written .*{reason}.*--storage"):
        tune(Bowl(), NAMES, Config(), trials=1, storage=f"sqlite:///{path}")


def test_a_disk_that_fills_up_while_searching_is_the_cause(storage, monkeypatch):
    import sqlite3

    from optuna.storages import RDBStorage
    from sqlalchemy.exc import OperationalError

    def fail(*_, **__):
        cause = sqlite3.OperationalError("database or disk is full")
        raise OperationalError("INSERT", {}, cause) from cause

    monkeypatch.setattr(RDBStorage, "set_trial_intermediate_value", fail)
    with pytest.raises(RecordingError, match="database or disk is full"):
        tune(Bowl(), NAMES, Config(), trials=2, storage=storage)


def test_the_verdict_tells_how_far_it_is(storage):
    told = []
    tune(Bowl(), NAMES, Config(), trials=1, storage=storage, judged=told.append)
    assert told[0] == 0
