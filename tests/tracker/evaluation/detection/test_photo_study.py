import io
import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from rich.console import Console

from tracker.containers import Hands, Refusal
from tracker.errors import RecordingError
from tracker.evaluation.detection.photo_labels import LabeledPhoto
from tracker.evaluation.detection.photo_study import judge_photo, photos_as_dict, study_photos

NOWHERE = (np.nan, np.nan)


def hands_at(*wrists, raised=True):
    """Upright hands, 60 px long."""
    shape = np.linspace((0.0, 0.0), (20.0, -40.0), 21)
    shape[12] = (0.0, -60.0)
    count = len(wrists)
    points = np.reshape(wrists, (count, 1, 2)) + shape
    one = np.ones(count)
    return Hands(points, one, one, np.full(count, raised), one)


def labeled(*wrists, path="photo.png"):
    return LabeledPhoto(Path(path), np.reshape(wrists, (-1, 2)).astype(float))


@pytest.mark.parametrize(
    ("labels", "hands", "found", "false"),
    [
        ([(50, 100)], [(60, 110)], [True], [False]),
        ([(50, 100)], [(50, 150)], [False], [True]),
        ([(50, 100)], [], [False], []),
        ([], [(50, 100)], [], [True]),
        ([NOWHERE], [(50, 100), (90, 100)], [True], [False, True]),
        ([NOWHERE, (90, 100)], [(90, 100)], [False, True], [False]),
        ([NOWHERE, (90, 100)], [(90, 100), (300, 100)], [True, True], [False, False]),
        # The nearer label of the first hand is the only one of the second.
        ([(50, 100), (75, 100)], [(55, 100), (30, 100)], [True, True], [False, False]),
    ],
)
def test_labels_and_hands_are_paired(labels, hands, found, false):
    judged = judge_photo(labeled(*labels), hands_at(*hands))
    assert judged.is_found.tolist() == found
    assert judged.is_false.tolist() == false


class Answers:
    """Gives its answers picture by picture, after a reset each; counts the looks at them."""

    work = None

    def __init__(self, *answers):
        self.answers = answers
        self.looks = []

    def find(self, image, hints=None):
        self.looks[-1] += 1
        return self.answers[len(self.looks) - 1]

    def reset(self):
        self.looks.append(0)

    def configure(self, config):
        pass


@pytest.fixture
def photos(tmp_path):
    """Three photos; the labels say a hand at (50, 100), a hand somewhere, and nobody."""
    answer = []
    for number, wrists in enumerate(([(50, 100)], [NOWHERE], [])):
        path = tmp_path / f"{number}.png"
        cv2.imwrite(str(path), np.full((240, 320, 3), number, np.uint8))
        answer.append(labeled(*wrists, path=path))
    return answer


def test_photos_are_judged_alone_and_summed_up(photos):
    detector = Answers(hands_at((52, 100)), hands_at(), hands_at((9, 90), (200, 90)))
    study = study_photos(photos, detector, looks=3)
    assert detector.looks == [3, 3, 3]
    assert [(share.count, share.total) for share in study.shares] == [(1, 2), (2, 3), (1, 1)]
    told = json.loads(json.dumps(photos_as_dict(study), allow_nan=False))
    assert told["photos"][2] == {
        "file": "2.png",
        "raised": 0,
        "found": 0,
        "false": 2,
        "reasons": "",
    }


class Turns(Answers):
    """Gives one answer after the other, look by look."""

    def find(self, image, hints=None):
        self.looks[-1] += 1
        return self.answers[(self.looks[-1] - 1) % len(self.answers)]


def test_a_hand_that_is_raised_now_and_then_is_neither_found_nor_false(photos):
    flickers = Turns(hands_at((52, 100), (200, 90)), hands_at((52, 100), raised=False))
    study = study_photos(photos[:1], flickers, looks=8)
    assert [share.count for share in study.shares] == [0, 0, 0]
    assert study.photos[0].reasons == ("raised",)


def test_two_looks_in_a_row_find_a_hand_and_tell_how_soon(photos):
    late = Turns(*[hands_at()] * 3, *[hands_at((52, 100))] * 2, *[hands_at()] * 5)
    study = study_photos(photos[:1], late, looks=10)
    assert study.photos[0].is_found.tolist() == [True]
    assert study.median_delay_s == pytest.approx(0.4)


def test_two_false_hands_at_different_places_are_none(photos):
    jumps = Turns(hands_at((9, 90)), hands_at((200, 90)))
    study = study_photos(photos[2:], jumps, looks=6)
    assert [share.count for share in study.shares][2] == 0


def test_a_missed_hand_tells_what_spoke_against_it(photos):
    at_head = replace(hands_at((52, 100), raised=False), refusal=[Refusal.AT_HEAD])
    study = study_photos(photos[:1], Answers(at_head))
    assert study.photos[0].reasons == ("at the head",)


def test_figures_are_broken_down_by_what_is_known_of_the_photos(photos):
    photos = [
        replace(photo, traits={"hand": hand, "file": f"{row}"})
        for row, (photo, hand) in enumerate(zip(photos, ("palm", "fist", ""), strict=True))
    ]
    study = study_photos(photos, Answers(hands_at((50, 100)), hands_at(), hands_at()))
    by_hand = study.shares_by["hand"]
    assert [by_hand[hand][0].count for hand in ("palm", "fist")] == [1, 0]
    assert by_hand["-"][2].total == 1


def test_lowered_hands_count_for_nothing(photos):
    lowered = hands_at((52, 100), raised=False)
    study = study_photos(photos, Answers(lowered, lowered, lowered))
    assert [(share.count, share.total) for share in study.shares] == [(0, 2), (0, 0), (0, 1)]


def test_a_wrist_outside_the_photo_is_refused(photos):
    outside = labeled((320, 10), path=photos[0].path)
    with pytest.raises(RecordingError, match="outside the photo, which has 320 x 240 pixels"):
        study_photos([outside], Answers(hands_at()))


def test_a_picture_that_cannot_be_read_is_named(tmp_path):
    (tmp_path / "broken.jpg").write_bytes(b"no picture")
    with pytest.raises(RecordingError, match=r"broken\.jpg"):
        study_photos([labeled(path=tmp_path / "broken.jpg")], Answers(hands_at()))


def test_files_and_a_contact_sheet_show_what_went_wrong(photos, tmp_path):
    from tracker.report.detection.photo_table import photo_tables, write_photos

    wrong = study_photos(photos, Answers(hands_at(), hands_at((9, 90)), hands_at((200, 90))))
    files = write_photos(wrong, tmp_path / "out")
    assert [path.name for path in files] == ["evaluation.json", "photos.csv", "contact_sheet.png"]
    sheet = cv2.imread(str(files[2]))
    missed = (sheet == (0, 183, 245)).all(axis=-1)  # the ring's color, of photo 0 alone
    assert missed[:, :330].any()
    assert not missed[:, 330:].any()
    assert files[1].read_text().splitlines()[1] == "0.png,1,0,0,not found"
    console = Console(width=80, file=io.StringIO())
    console.print(*photo_tables(wrong))
    assert "1 of 2" in console.file.getvalue()


def test_no_contact_sheet_where_nothing_went_wrong(photos, tmp_path):
    from tracker.report.detection.photo_table import photo_tables, write_photos

    right = study_photos(photos[:1], Answers(hands_at((50, 100))))
    assert len(write_photos(right, tmp_path)) == 2
    assert len(photo_tables(right)) == 1
