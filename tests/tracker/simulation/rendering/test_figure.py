from dataclasses import replace

import pytest

from tracker.simulation.activities import ACTIVITIES
from tracker.simulation.rendering.arm import raised_hand_landmarks
from tracker.simulation.rendering.figure import paint_activity, paint_figure
from tracker.simulation.rendering.look import Look

STANDS = Look()


def test_a_figure_is_painted_once_per_height_of_the_arm():
    low, high = paint_figure(STANDS, ((0.0, 0.0), (1.0, 0.0)), px_per_m=300.0)
    for sprite in (low, high):
        color, opacity = sprite.bgra[..., :3], sprite.bgra[..., 3:]
        assert opacity.max() == 255
        assert (color <= opacity).all()  # already multiplied
    skin = high.bgra[..., 3] > 0
    wrist = raised_hand_landmarks(STANDS)[0] * (1.0, -1.0) * high.px_per_m + high.anchor_px
    column, row = wrist.astype(int)
    assert skin[row, column]
    # The head is where a grown person's is, give or take the hair.
    top_m = low.anchor_px[1] / low.px_per_m
    assert top_m == pytest.approx(STANDS.stature_m, abs=0.05)


@pytest.mark.parametrize("what", ACTIVITIES)
def test_an_activity_has_a_picture_of_every_moment(what):
    sprites = paint_activity(STANDS, what, px_per_m=100.0)
    assert len(sprites) == len(ACTIVITIES[what])


def test_a_sleeve_covers_the_arm_in_the_shirt_s_color():
    look = replace(STANDS, shirt=(0, 255, 0), skin=(0, 0, 255))
    covered = {}
    for sleeve in ("bare", "short", "long"):
        (sprite,) = paint_figure(replace(look, sleeve=sleeve), ((1.0, 0.0),), px_per_m=200.0)
        covered[sleeve] = int((sprite.bgra[..., 1] > 100).sum())
    assert covered["bare"] < covered["short"] < covered["long"]


def test_a_broad_person_is_broader():
    slim, broad = (
        paint_figure(replace(STANDS, build=build, sleeve="bare"), ((0.0, 0.0),), px_per_m=200.0)[0]
        for build in (0.8, 1.3)
    )
    row = round(slim.anchor_px[1] - 1.1 * 200.0)  # across the belly, and the arms beside it
    assert (broad.bgra[row, :, 3] > 0).sum() > 1.1 * (slim.bgra[row, :, 3] > 0).sum()
