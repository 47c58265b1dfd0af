import numpy as np
import pytest

from tracker.evaluation.detection.figures import (
    detection_as_dict,
    false_rate,
    false_rate_by_activity,
    false_rate_by_distance,
    recall_by_factor,
    recall_of,
)


def test_recall_counts_hands_and_takes_medians_of_the_found(detection_study):
    row = recall_of("all", detection_study.episodes)
    assert (row.found, row.total) == (8, 12)
    assert row.share == pytest.approx(8 / 12)
    assert row.median_frames == 5.5
    assert row.landmark_error == pytest.approx(0.045)
    # Wilson's interval of 8 in 12, by hand: z = 1.96.
    assert (row.low, row.high) == (
        pytest.approx(0.3906, abs=1e-4),
        pytest.approx(0.8619, abs=1e-4),
    )


def test_every_factor_shares_out_every_episode(detection_study):
    for rows in recall_by_factor(detection_study).values():
        assert sum(row.total for row in rows) == 12
        assert sum(row.found for row in rows) == 8


def test_levels_stand_in_their_own_order(detection_study):
    by_factor = recall_by_factor(detection_study)
    assert [(row.level, row.found) for row in by_factor["distance"]] == [("1 m", 6), ("3 m", 2)]
    assert [row.level for row in by_factor["size"]] == ["20-28 px", ">= 60 px"]
    assert [row.level for row in by_factor["blur"]] == ["sharp", "soft", "moving"]


def test_nothing_found_is_no_number():
    row = recall_of("none", [])
    assert np.isnan([row.share, row.low, row.median_frames, row.landmark_error]).all()


def test_rates_count_hours_of_the_camera_and_of_people(detection_study):
    minutes = detection_study.minutes
    camera = false_rate(minutes)
    assert (camera.count, camera.hours, camera.per_hour) == (3, 0.05, pytest.approx(60.0))
    told = {row.level: (row.count, row.per_hour) for row in false_rate_by_activity(minutes)}
    assert told == {
        "talk": (2, pytest.approx(40.0)),
        "phone": (1, pytest.approx(20.0)),
        "rest": (0, 0.0),
    }
    told = {row.level: row.count for row in false_rate_by_distance(minutes)}
    assert told == {"1-2 m": 2, "2-3 m": 1, "4-5 m": 0}


def test_false_raises_beside_callers_are_told(detection_study):
    assert detection_as_dict(detection_study)["false_raises_beside_callers"] == 1
