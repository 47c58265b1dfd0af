"""What the tests of several rooms share."""

import pytest

from tracker import Config
from tracker.evaluation.detection_episode import CallerScore, FalseRaise
from tracker.evaluation.detection_scenes import FACTORS, Conditions
from tracker.evaluation.detection_study import DetectionStudy, Episode, Minute


@pytest.fixture
def detection_study():
    """By hand: six of six hands found at 1 m, two of six at 3 m; three minutes of nobody."""
    episodes = []
    for number in range(12):
        distance_m = 1.0 if number < 6 else 3.0
        frames = (2, 3, 4, 5, 6, 7, 10, 20, None, None, None, None)[number]
        error = float("nan") if frames is None else 0.01 * (number + 1)
        conditions = Conditions(
            distance_m,
            FACTORS["light"][number % 5],
            FACTORS["blur"][number % 3],
            FACTORS["skin"][number % 5],
            FACTORS["sleeve"][number % 3],
            FACTORS["hand"][number % 2],
            FACTORS["company"][number % 2],
        )
        score = CallerScore(82.0 / distance_m, frames, error, int(number == 11))
        episodes.append(Episode(number, conditions, "low", "sits", score))
    people = (("talk", 1.5), ("phone", 2.5), ("rest", 4.5))
    false = (FalseRaise(3.0, "talk", 1.5), FalseRaise(9.5, "phone", 2.5))
    minutes = (Minute(0, people, false), Minute(1, people, ()), Minute(2, people, false[:1]))
    return DetectionStudy(5, (1.0, 3.0), Config(), tuple(episodes), minutes)
