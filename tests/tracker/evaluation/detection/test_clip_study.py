from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from tracker.config import Config
from tracker.errors import RecordingError
from tracker.evaluation.detection.clip_study import (
    LabeledClip,
    clips_as_dict,
    judge_clip,
    read_clips,
    study_clips,
)
from tracker.report.detection.photo_table import clip_table


def results(*raised):
    """One image every tenth of a second; each names the track that is raised, or 0 for none."""
    for number, identity in enumerate(raised):
        tracks = SimpleNamespace(id=np.array([identity]), raised=np.array([identity > 0]))
        yield SimpleNamespace(
            stamp_ns=number * 100_000_000, hand_raised=identity > 0, tracks=tracks
        )


def clip(*episodes_s):
    return LabeledClip(Path("clip.mp4"), episodes_s)


def test_raised_images_of_a_call_are_counted_with_its_delay():
    judged = judge_clip(clip((0.2, 0.6)), results(0, 0, 0, 7, 7, 7, 7, 7, 0, 0))
    assert (judged.images_up, judged.images_raised) == (5, 4)
    assert (judged.raises, judged.false_raises, judged.identities) == (1, 0, 1)
    assert judged.delays_s == pytest.approx((0.1,))


def test_a_raise_outside_of_every_call_is_false():
    judged = judge_clip(clip((0.0, 0.1)), results(0, 0, 0, 0, 0, 0, 0, 0, 3, 3))
    assert (judged.images_raised, judged.raises, judged.false_raises) == (0, 1, 1)
    assert np.isnan(judged.delays_s).all()


def test_a_second_hand_in_the_same_time_is_no_second_call():
    both = clip((0.0, 1.0), (0.4, 1.2), (2.0, 3.0))
    assert both.calls_s == ((0.0, 1.2), (2.0, 3.0))


def test_clips_are_summed_up():
    clips = [clip((0.0, 0.5)), clip()]
    study = study_clips(clips, Config(), play=lambda path: results(2, 2, 2, 2, 2, 2))
    assert [(share.count, share.total) for share in study.shares] == [(1, 1), (6, 6)]
    assert study.false_raises == (1, pytest.approx(0.5))
    told = clips_as_dict(study)
    assert told["clips"][1]["false_raises"] == told["false_raises"] == 1
    assert clip_table(study).row_count == 5


def test_labels_name_clips_and_times(tmp_path):
    (tmp_path / "clips").mkdir()
    (tmp_path / "clips/a.mp4").touch()
    table = tmp_path / "clips/episodes.csv"
    table.write_text("clip,start_s,end_s,side\na.mp4,1.0,2.5,left\n", encoding="utf-8")
    (labeled,) = read_clips(tmp_path)
    assert labeled.episodes_s == ((1.0, 2.5),)
    table.write_text("clip,start_s,end_s\na.mp4,,\n", encoding="utf-8")
    assert read_clips(tmp_path)[0].episodes_s == ()
    assert read_clips(tmp_path / "clips") == ()


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("b.mp4,1,2", "line 2: there is no clip 'b.mp4'"),
        ("a.mp4,1,", "line 2: start_s, end_s are '1', ''"),
        ("a.mp4,3,2", "line 2: start_s, end_s are 3, 2"),
    ],
)
def test_what_is_off_is_named_with_its_line(tmp_path, row, words):
    (tmp_path / "clips").mkdir()
    (tmp_path / "clips/a.mp4").touch()
    (tmp_path / "clips/episodes.csv").write_text(f"clip,start_s,end_s\n{row}\n", encoding="utf-8")
    with pytest.raises(RecordingError, match=words):
        read_clips(tmp_path)
