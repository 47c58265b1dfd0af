from dataclasses import replace

import numpy as np
import pytest

from tracker.config import Config
from tracker.gesture import Gesture
from tracker.notes import Note, NoteKind
from tracker.report.history import history as history_module
from tracker.report.history.history import History


@pytest.fixture(scope="module")
def history(results):
    history = History()
    for result in results:
        history.write(result)
    return history


def test_only_confirmed_people_are_remembered(history):
    assert list(history.people) == [1, 2, 4]
    first = history.people[1]
    assert history.seconds(first.first_seen_ns) == pytest.approx(2.0)
    assert history.seconds(first.confirmed_ns) == pytest.approx(2.4)
    assert history.seconds(first.last_seen_ns) == pytest.approx(31.9)


def test_every_raise_is_an_interval_with_its_place(history):
    hands = history.people[1].hands
    spans = [(history.seconds(hand.start_ns), history.seconds(hand.end_ns)) for hand in hands]
    assert np.array(spans) == pytest.approx(np.array([[2.4, 7.8], [24.2, 29.3]]))
    assert hands[0].frames == 54
    assert hands[0].xy_m == pytest.approx([1.5, 0.85], abs=0.1)
    assert hands[0].covariance_m2.shape == (2, 2)


def test_selection_is_an_interval_too(history):
    (span,) = history.people[2].selected
    assert history.seconds(span.start_ns) == pytest.approx(7.8)  # when person 1 lowers the hand


def test_images_notes_and_duration_are_counted(history, results):
    assert history.frames_processed == len(results)
    assert history.duration_s == pytest.approx(31.9)
    assert history.notes == {"no scan within 0.25 s": 4}


def test_what_lasts_at_the_end_stays_open(result_of):
    history = History()
    history.write(result_of(10, (1, 0.0, 0.0, True), selected=1))
    assert history.people[1].hands[0].end_ns is None
    assert history.people[1].selected[0].end_ns is None


def test_a_track_that_dies_raised_ends_its_episode(result_of):
    history = History()
    history.write(result_of(10, (1, 0.0, 0.0, True), selected=1))
    history.write(result_of(20))
    assert history.people[1].hands[0].end_ns == 20
    assert history.people[1].selected[0].end_ns == 20


def test_a_stamp_that_jumps_back_ends_what_lasts_where_it_was(result_of):
    history = History()
    history.write(result_of(10_000_000_000, (1, 0.0, 0.0, True)))
    history.write(result_of(12_000_000_000, (1, 0.0, 0.0, True)))
    history.write(result_of(1_000_000_000, (2, 0.0, 0.0, True)))
    history.write(result_of(2_000_000_000, (2, 0.0, 0.0, True)))
    assert history.people[1].hands[0].end_ns == 12_000_000_000
    assert history.duration_s == pytest.approx(3.0)


def test_a_scan_shared_by_two_images_counts_once(results):
    history = History()
    history.write(results[0])
    history.write(results[0])
    assert history.walls.hits[1].max() == 1.0


def test_memory_is_bounded_over_very_many_people_and_notes(monkeypatch, result_of):
    monkeypatch.setattr(history_module, "PEOPLE_KEPT", 20)
    history = History()
    for number in range(1, 201):
        history.write(
            result_of(
                number, (1, 0.0, 0.0, False), (number + 1, 1.0, 0.0, True),
                notes=(Note(NoteKind.SCAN_TOO_OLD, f"scan is {number} s old"),),
                sensor_pose=np.zeros(3),
            )
        )  # fmt: skip
    assert len(history.people) == 20
    assert 1 in history.people  # still there, so it stays
    assert history.people_dropped == 181
    assert history.notes == {"scan is 1 s old": 200}


def test_places_before_the_first_transform_are_no_places_of_the_fixed_frame(result_of):
    history = History()
    history.write(result_of(10**9, (1, 1.0, 0.4, True), sensor_pose=None))
    note = Note(NoteKind.NEW_FIXED_FRAME, "the first transform was received")
    pose = np.array([10.0, 5.0, 0.0])
    history.write(result_of(2 * 10**9, (2, 11.0, 5.4, True), sensor_pose=pose, notes=(note,)))
    early, late = history.people.values()
    assert early.hands[0].mean_xy_m is None
    assert late.hands[0].mean_xy_m.tolist() == [11.0, 5.4]


def test_what_a_hand_says_is_an_interval_of_each_gesture(result_of):
    history = History()
    said = [Gesture.NONE, Gesture.PALM, Gesture.PALM, Gesture.WAVE, Gesture.NONE, Gesture.PALM]
    for number, gesture in enumerate(said):
        result = result_of(number * 10**9, (3, 1.0, 0.0, True))
        tracks = replace(result.tracks, gesture=[gesture])
        history.write(replace(result, tracks=tracks))
    spans = [
        (span.gesture, span.start_ns // 10**9, span.end_ns and span.end_ns // 10**9)
        for span in history.people[3].said
    ]
    assert spans == [(Gesture.PALM, 1, 3), (Gesture.WAVE, 3, 4), (Gesture.PALM, 5, None)]


def test_an_estimate_is_fresh_while_it_is_recent_and_certain(result_of):
    history = History(Config(pose_max_std_m=0.5, pose_max_age_s=1.0))
    strict = History(Config(pose_max_std_m=0.19))
    for each in (history, strict):
        each.write(result_of(0, (1, 1.0, 0.0, True)))  # 0.2 m along its worst axis
    assert history.people[1].states.rows.tolist() == [[0.0, 0.9, 1.0]]
    assert strict.people[1].states.rows.tolist() == [[0.0, 0.9, 0.0]]
