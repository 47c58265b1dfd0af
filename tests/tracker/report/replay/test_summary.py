import io
import json
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from tracker.containers import Hands, Refusal
from tracker.errors import RecordingError
from tracker.evaluation.metrics.raised_hands.episodes import EpisodeEvaluation
from tracker.gesture import Gesture
from tracker.notes import Note, NoteKind
from tracker.report.history.history import History
from tracker.report.replay.summary import summarize, summary_table, write_summary


@pytest.fixture
def history(result_of):
    """Person 1 is up from 1 s to 3 s and again from 5 s on, served from 2 s to 3 s."""
    history = History()
    history.start_ns = 10 * 10**9
    for second, is_up in (
        (11, True),
        (12, True),
        (13, False),
        (14, False),
        (15, True),
        (16, True),
    ):
        selected = 1 if second == 12 else None
        people = ((1, 0.1 * second, 2.0, is_up),)
        history.write(
            result_of(
                second * 10**9,
                *people,
                selected=selected,
                notes=(Note(NoteKind.NO_SCAN, "no scan"),),
            )
        )
    return history


def test_the_summary_tells_who_when_and_where(history):
    summary = summarize(history, frames_seen=18)
    assert summary["frames"] == {"seen": 18, "processed": 6, "hand_raised": 4}
    assert summary["notes"] == {"no scan": 6}
    assert summary["duration_s"] == 5.0
    assert summary["start_stamp_ns"] == 10 * 10**9
    (person,) = summary["people"]
    assert (person["id"], person["first_seen_s"], person["last_seen_s"]) == (1, 1.0, 6.0)
    first, second = person["episodes"]
    assert (first["raised_at_s"], first["lowered_at_s"], first["frames"]) == (1.0, 3.0, 2)
    assert first["xy_m"] == pytest.approx([1.15, 2.0])
    assert first["std_m"] == pytest.approx(0.2)
    assert (second["raised_at_s"], second["lowered_at_s"]) == (5.0, None)
    assert person["xy_m"] == pytest.approx([1.35, 2.0])
    assert person["selected"] == [{"from_s": 2.0, "to_s": 3.0}]


def test_the_summary_survives_json(history, tmp_path, results):
    for result in results:
        history.write(result)
    summary = summarize(history, evaluation=EpisodeEvaluation().report())
    write_summary(summary, tmp_path / "summary.json")
    assert json.loads((tmp_path / "summary.json").read_text()) == summary
    assert [path.name for path in tmp_path.iterdir()] == ["summary.json"]


def test_an_empty_recording_has_a_summary():
    summary = summarize(History())
    assert summary["people"] == []
    assert summary["start_stamp_ns"] is None
    assert json.dumps(summary, allow_nan=False)


def test_a_person_who_never_raised_a_hand_has_no_place(result_of):
    history = History()
    history.write(result_of(0, (1, 1.0, 1.0, False)))
    assert summarize(history)["people"][0]["xy_m"] is None


def test_a_place_that_is_no_folder_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordingError, match="file: cannot be written"):
        write_summary({}, tmp_path / "file" / "summary.json")


def test_the_table_has_a_line_per_raised_hand(history):
    console = Console(width=100, file=io.StringIO())
    console.print(summary_table(history))
    lines = [line for line in console.file.getvalue().splitlines() if "#1" in line]
    assert len(lines) == 2
    assert "1.0 s" in lines[0]
    assert "0.40 m" in lines[0]  # two standard deviations of 0.2 m
    assert "+" in lines[1]  # still up at the end


def test_hands_that_were_not_raised_are_counted_by_their_reason(result_of):
    history = History()
    for second, codes in enumerate(([Refusal.AT_HEAD, Refusal.AT_HEAD], [Refusal.LEANS, 0], [0])):
        count = len(codes)
        one = np.ones(count)
        raised = [code == 0 for code in codes]
        hands = Hands(np.zeros((count, 21, 2)), one, one, raised, one, refusal=codes)
        history.write(replace(result_of(second * 10**9), hands=hands))
    history.write(replace(result_of(3 * 10**9), hands=hands[[]]))
    assert summarize(history)["hands_not_raised"] == {"at_head": 1, "leans": 1}


def test_a_hand_without_a_known_place_has_a_bearing_and_no_place(result_of):
    history = History()
    for second in range(3):
        result = result_of(second * 10**9, (1, 2.0, 2.0, True), sensor_pose=np.array([1.0, 1, 0]))
        unsure = np.zeros((1, 4, 4))
        unsure[0, :2, :2] = 0.5 + 0.02 * np.array([[1.0, -1.0], [-1.0, 1.0]])  # along the ray
        history.write(replace(result, tracks=replace(result.tracks, covariance=unsure)))
    (person,) = summarize(history)["people"]
    (episode,) = person["episodes"]
    assert person["xy_m"] is episode["xy_m"] is None
    assert episode["bearing_deg"] == 45.0
    assert episode["bearing_std_deg"] == pytest.approx(
        np.degrees(np.arctan(0.2 / 2**0.5)), abs=1e-3
    )
    assert len(history.people[1].path.rows) == 0


def test_what_a_person_said_is_told_by_its_word(result_of):
    history = History()
    for number, gesture in enumerate([Gesture.THUMB_UP, Gesture.NONE]):
        result = result_of(number * 10**9, (3, 1.0, 0.0, True))
        history.write(replace(result, tracks=replace(result.tracks, gesture=[gesture])))
    (person,) = summarize(history)["people"]
    assert person["gestures"] == [{"gesture": "thumb_up", "from_s": 0.0, "to_s": 1.0}]
