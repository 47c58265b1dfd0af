"""What would a hand detector make of a scene? Raised hands with pixel noise, without a picture."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tracker.containers import BoolArray, FloatArray, Hands
from tracker.simulation.motion import People
from tracker.simulation.projection import Viewpoint
from tracker.simulation.random_rooms.guests import draw_place
from tracker.simulation.rendering.arm import raised_hand_landmarks
from tracker.simulation.rendering.camera_view import is_from_behind, look_of
from tracker.simulation.rendering.look import Look
from tracker.simulation.scene import Scene

#: Half of a person's silhouette at the height of the chest and head.
_HALF_SILHOUETTE_M = 0.22
#: Left and right are told apart so often.
_HANDEDNESS = 0.9
_MEASURE = 1.6  # palm lengths, of a hand that is well up


def show_hands(
    scene: Scene,
    view: Viewpoint,
    people: People,
    in_view: BoolArray,
    rng: np.random.Generator,
    *,
    detection_probability: float,
    clutter_per_frame: float,
    landmark_std_px: float,
) -> Hands:
    """Raised hands that are in the picture and not hidden, as a detector would report them.

    Args:
        scene: Who is there.
        view: The camera.
        people: Where everybody is, and how far hands are up.
        in_view: Shape (P,): whose raised hand falls into the picture, from `hands_in_view`.
        rng: All randomness.
        detection_probability: Of a hand that can be seen.
        clutter_per_frame: Mean number of raised hands that nobody raised, anywhere in the room.
        landmark_std_px: Noise of a hand as a whole; that of each landmark is half of it.
    """
    is_shown = in_view & people.hand_up
    is_shown &= rng.random(len(is_shown)) < detection_probability
    looks = [look_of(person) for person in scene.people]
    shapes, right, sits = [], [], []
    for row in np.flatnonzero(is_shown).tolist():
        shape = raised_hand_landmarks(looks[row], from_behind=is_from_behind(view, people, row))
        if not _is_hidden(shape[0], row, looks, view, people):
            shapes.append(_pixels(shape, people.xy_m[row], view))
            right.append(looks[row].right_handed)
            sits.append(float(scene.people[row].seat_m is not None))
    for place in _clutter(rng, clutter_per_frame):
        shapes.append(_pixels(raised_hand_landmarks(Look()), place, view))
        right.append(True)
        sits.append(np.nan)
    if not shapes:
        return Hands.none()
    count = len(shapes)
    landmarks = np.array(shapes)
    landmarks += landmark_std_px * rng.standard_normal((count, 1, 2))
    landmarks += landmark_std_px / 2 * rng.standard_normal(landmarks.shape)
    is_told = rng.random(count) < _HANDEDNESS
    return Hands(
        landmarks_px=landmarks,
        score=np.full(count, 0.9),
        right=np.where(np.array(right) == is_told, 0.9, 0.1),
        raised=np.ones(count, dtype=bool),
        raise_measure=np.full(count, _MEASURE),
        seated=np.where(is_told, sits, np.nan),  # as often as hips and knees are seen (guess)
    )


def _pixels(shape: FloatArray, xy_m: FloatArray, view: Viewpoint) -> FloatArray:
    """Points of a figure's sheet, shape (K, 2), in the picture; the sheet faces the camera."""
    ahead, left = view.forward_left(xy_m)
    places = np.stack([np.full(len(shape), ahead), left - shape[:, 0]], axis=-1)
    return view.pixels(places, shape[:, 1])


def _is_hidden(
    wrist: FloatArray, row: int, looks: list[Look], view: Viewpoint, people: People
) -> bool:
    """Whether somebody nearer, and tall enough, stands between the camera and a wrist."""
    places = view.forward_left(people.xy_m)
    ahead, left = places[row, 0], places[row, 1] - wrist[0]
    for other, look in enumerate(looks):
        share = places[other, 0] / ahead  # of the line of sight, where it passes the other
        if other == row or not 0.0 < share < 1.0:
            continue
        height_m = view.z_m + share * (wrist[1] - view.z_m)
        beside_m = abs(places[other, 1] - share * left)
        if beside_m < _HALF_SILHOUETTE_M and height_m < look.stature_m - look.sunk_m:
            return True
    return False


def _clutter(rng: np.random.Generator, mean: float) -> Iterator[FloatArray]:
    for _ in range(rng.poisson(mean)):
        yield draw_place(rng)
