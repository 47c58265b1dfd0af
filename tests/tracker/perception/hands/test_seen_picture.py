import numpy as np

from tracker.perception.hands.seen_picture import SeenPicture
from tracker.perception.movement import Movement


def picture(brightness=60, color=0):
    bgr = np.full((480, 640, 3), brightness, np.uint8)
    bgr[..., 2] += color
    return bgr


def test_a_picture_in_color_stays_the_very_same():
    bgr = picture(color=60)
    assert SeenPicture(bgr, Movement()).tinted_bgr is bgr


def test_a_gray_picture_is_tinted_for_the_search_alone():
    seen = SeenPicture(picture(), Movement())
    assert seen.tinted_bgr[0, 0].tolist() != seen.bgr[0, 0].tolist()


def test_what_moved_is_told_to_all_who_ask():
    movement = Movement()
    still = SeenPicture(picture(color=60), movement)
    assert len(still.moved_px) == 0
    bgr = picture(color=60)
    bgr[100:140, 300:340] = 220
    seen = SeenPicture(bgr, movement)
    first, second = seen.moved_px, seen.moved_px
    assert len(first) == len(second) == 1
