from dataclasses import replace

import cv2
import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage, Hands, Refusal, Tracks
from tracker.report.video.debug_picture import draw_debug_image


@pytest.fixture
def written(monkeypatch):
    """Every text that is put into a picture."""
    texts = []
    put_text = cv2.putText

    def note_and_put(canvas, text, *rest):
        texts.append(text)
        return put_text(canvas, text, *rest)

    monkeypatch.setattr(cv2, "putText", note_and_put)
    return texts


def image(width=640, height=480):
    return CameraImage(0, "", np.full((height, width, 3), 100, np.uint8))


def hands(*raised, measure=1.824):
    count = len(raised)
    points = np.random.default_rng(1).uniform(-40, 40, (count, 21, 2))
    points += np.array([[150 + 200 * row, 250] for row in range(count)]).reshape(-1, 1, 2)
    return Hands(points, np.ones(count), np.ones(count), raised, np.full(count, measure))


def tracks(ids, raised, hand, selected_id=None):
    count = len(ids)
    some = np.ones(count)
    return Tracks(
        0, ids, np.zeros((count, 4)), np.zeros((count, 4, 4)), some, some, raised,
        some, some, some, hand, selected_id,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("factor", "shape"), [(1, (480, 640, 3)), (2, (240, 320, 3)), (16, (30, 40, 3))]
)
def test_the_picture_is_shrunk_by_the_factor(factor, shape):
    config = Config(downscale_factor=factor)
    drawn = draw_debug_image(image(), hands(True), None, config)
    assert drawn.shape == shape
    assert drawn.dtype == np.uint8


@pytest.mark.parametrize("factor", [1, 2])
def test_the_camera_image_itself_stays_clean(factor):
    original = image()
    draw_debug_image(original, hands(True), None, Config(downscale_factor=factor))
    assert (original.bgr == 100).all()


def test_a_raised_hand_says_so_with_its_measure_in_palms(written):
    draw_debug_image(image(), hands(True), None, Config(raise_rule="palm"))
    assert "HAND RAISED 1.82 palms" in written
    assert not any("NO HAND" in text for text in written)


def test_the_image_rule_measures_in_image_heights(written):
    config = Config(raise_rule="image")
    draw_debug_image(image(), hands(True, measure=0.31), None, config)
    assert "HAND RAISED 0.31 image heights" in written


def test_a_lowered_hand_is_neither_raised_nor_none(written):
    draw_debug_image(image(), hands(False), None, Config())
    assert not any("HAND RAISED" in text or "NO HAND" in text for text in written)
    assert any(text.startswith("1 hand, 0 raised") for text in written)


def test_no_hand_detected_is_written_when_there_is_none(written):
    draw_debug_image(image(), Hands.none(), Tracks.none(0), Config())
    assert "NO HAND DETECTED" in written


def test_a_wide_picture_says_who_it_is_and_who_is_served(written):
    people = tracks([3, 7, 12], [True, False, True], [1, 0, -1], selected_id=3)
    draw_debug_image(image(), hands(True, True), people, Config(downscale_factor=1))
    assert "#3 raised - served" in written
    assert "#7" in written
    assert not any("#12" in text for text in written)  # that person's hand is not in the picture
    assert any("3 customers" in text and "serving #3" in text for text in written)


def test_a_track_whose_hand_row_is_gone_is_left_out(written):
    draw_debug_image(image(), hands(True), tracks([5], [True], [4]), Config())
    assert not any("#5" in text for text in written)


def test_the_wrist_is_circled():
    found = hands(False)
    drawn = draw_debug_image(image(), found, None, Config(downscale_factor=1))
    x, y = found.wrist_px[0]
    ring = 7  # 3 * 2 + 1 around a small hand, for a pen of 2 px
    angles = np.linspace(0, 2 * np.pi, 32, endpoint=False)
    columns, rows = np.round([x + ring * np.cos(angles), y + ring * np.sin(angles)]).astype(int)
    assert (drawn[rows, columns] != 100).any(axis=-1).mean() > 0.9


def test_labels_of_neighbors_do_not_cover_each_other(monkeypatch):
    places = []
    put_text = cv2.putText

    def note_and_put(canvas, text, origin, *rest):
        places.append((text, origin))
        return put_text(canvas, text, origin, *rest)

    monkeypatch.setattr(cv2, "putText", note_and_put)
    twins = hands(True, True)
    crowded = Hands(twins.landmarks_px[[0, 0]] + 3, twins.score, twins.right, twins.raised,
                    twins.raise_measure)  # fmt: skip
    draw_debug_image(image(), crowded, None, Config())
    rows = [origin[1] for text, origin in places if text.startswith("HAND RAISED")]
    assert abs(rows[0] - rows[1]) >= 9


@pytest.mark.parametrize("size", [(1, 1), (3, 2), (40, 30), (2, 300)])
def test_tiny_pictures_and_hands_outside_are_drawn_without_complaint(size):
    far = hands(True, False)
    far = Hands(far.landmarks_px + 1e7, far.score, far.right, far.raised, far.raise_measure)
    people = tracks([1, 2], [True, False], [0, 1], selected_id=1)
    for found in (far, Hands.none()):
        drawn = draw_debug_image(image(*size), found, people, Config())
        assert 0 not in drawn.shape


def test_the_nearest_hand_that_is_not_raised_says_why(written):
    seen = hands(True, False, False)
    larger = seen.landmarks_px.copy()
    larger[2, 12] = larger[2, 0] - (0.0, 200.0)
    codes = [0, Refusal.NOT_UP, Refusal.AT_HEAD]
    draw_debug_image(image(), replace(seen, landmarks_px=larger, refusal=codes), None, Config())
    assert [text for text in written if "not raised" in text] == ["not raised: at the head"]


def test_hands_that_are_all_raised_need_no_reason(written):
    draw_debug_image(image(), hands(True, True), None, Config())
    assert not any("not raised" in text for text in written)


def test_every_reason_fits_beside_a_hand_of_a_small_picture(written):
    for refusal in Refusal:
        draw_debug_image(image(320, 240), replace(hands(False), refusal=[refusal]), None, Config())
        assert any(text.endswith(refusal.words) for text in written)
