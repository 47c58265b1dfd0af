import dataclasses
import json
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from tracker import Config
from tracker.containers import Hands
from tracker.errors import ConfigError
from tracker.evaluation.detection import study as detection_study
from tracker.evaluation.detection.study import study_detection

CONFIG = Config(processing_rate=2.0)  # few images


class OneHand:
    """Sees a raised hand in the middle of every picture."""

    work = None

    def __init__(self, config):
        self.config = config

    def find(self, image, hints=None):
        shape = np.random.default_rng(0).uniform(230.0, 250.0, (1, 21, 2))
        one = np.ones(1)
        return Hands(shape, one, one, one.astype(bool), one)

    def reset(self):
        pass

    def configure(self, config):
        pass


@pytest.fixture(autouse=True)
def short_minutes(monkeypatch):
    monkeypatch.setattr(detection_study, "_MINUTE_S", 2.0)


def run(episodes, minutes, **others):
    return study_detection(
        episodes, minutes, 3, CONFIG, distances_m=(2.0, 4.0), open_detector=OneHand, **others
    )


def test_a_study_is_the_same_whoever_runs_it_and_reports_its_progress():
    shares = []
    here = run(6, 2, progress=shares.append)
    with ThreadPoolExecutor(2) as executor:
        there = run(6, 2, executor=executor)
    assert [dataclasses.astuple(item) for item in here.minutes] == [
        dataclasses.astuple(item) for item in there.minutes
    ]
    for one, other in zip(here.episodes, there.episodes, strict=True):
        assert one.conditions == other.conditions
        np.testing.assert_equal(dataclasses.astuple(one.score), dataclasses.astuple(other.score))
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_episodes_are_numbered_and_spread_over_the_distances():
    study = run(4, 0)
    assert [item.number for item in study.episodes] == [0, 1, 2, 3]
    assert [item.conditions.distance_m for item in study.episodes] == [2.0, 2.0, 4.0, 4.0]
    assert study.minutes == ()


def test_who_sees_a_hand_always_invents_one_a_minute():
    study = run(0, 2)
    assert [len(item.false_raises) for item in study.minutes] == [1, 1]
    assert all(len(item.people) == 3 for item in study.minutes)


@pytest.mark.parametrize(
    ("episodes", "minutes", "seed", "distances_m", "words"),
    [
        (0, 0, 1, (1.0,), "0 episodes and 0 minutes"),
        (-1, 2, 1, (1.0,), "-1 episodes"),
        (1, 1, -1, (1.0,), "seed -1"),
        (1, 1, 1, (), "distances are none"),
        (1, 1, 1, (2.0, 0.1), "distances are 2, 0.1"),
    ],
)
def test_impossible_numbers_are_refused(episodes, minutes, seed, distances_m, words):
    with pytest.raises(ConfigError, match=words):
        study_detection(
            episodes, minutes, seed, CONFIG, distances_m=distances_m, open_detector=OneHand
        )


def test_a_study_can_be_told_in_json():
    from tracker.evaluation.detection.figures import detection_as_dict

    told = json.loads(json.dumps(detection_as_dict(run(2, 1)), allow_nan=False))
    assert told["recall"]["total"] == 2
    assert told["false_raises"]["count"] == 1
