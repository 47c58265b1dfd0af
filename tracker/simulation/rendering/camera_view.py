"""What does the camera see? The room with its people, laid over each other from far to near."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import cv2
import numpy as np

from tracker.containers import BoolArray, FloatArray, ImageArray
from tracker.geometry import normalize_angle
from tracker.simulation.motion import People
from tracker.simulation.projection import NEAR_M, Viewpoint
from tracker.simulation.rendering.arm import raised_hand_landmarks
from tracker.simulation.rendering.canvas import Sprite
from tracker.simulation.rendering.figure import paint_activity, paint_figure
from tracker.simulation.rendering.furniture import ChairPainter, TablePainter
from tracker.simulation.rendering.look import Look
from tracker.simulation.rendering.room import RoomPainter, bgr
from tracker.simulation.scene import Person, Scene

#: Heights of the arm that are painted; the nearest lower one is shown.
RAISED_STEPS = (0.0, 0.25, 0.5, 0.75, 1.0)
#: How far outward a hand that waves is painted; the nearest one is shown.
SWING_STEPS = (-1.0, -0.6, 0.6, 1.0)

_NOISE_MARGIN_PX = 96
_SHARP_FROM_M = 0.55  # nearer figures are enlarged
_SEAT_BEFORE_M = 0.05
_BEHIND_RAD = np.radians(105.0)


class CameraView:
    """Renders one scene; figures are painted once, when first seen.

    Args:
        scene: What is there.
        rng: Pixel noise.
        sharp_from_m: Figures are painted as finely as they are seen from here; nearer ones are
            enlarged. Painting takes a time inversely proportional to its square.
    """

    def __init__(
        self, scene: Scene, rng: np.random.Generator, sharp_from_m: float = _SHARP_FROM_M
    ) -> None:
        self._scene = scene
        self._px_per_m = scene.camera.fx / sharp_from_m
        self._room = RoomPainter(scene)
        self._tables = [TablePainter(table, scene.camera.exposure) for table in scene.tables]
        self._chairs = [ChairPainter(chair, scene.camera.exposure) for chair in scene.chairs]
        self._looks = [look_of(person) for person in scene.people]
        self._figures: dict[tuple[Look, bool, str], list[Pyramid]] = {}
        self._rng = rng
        camera = scene.camera
        # Fresh noise for each pixel of each picture takes longer than all the painting; a window
        # of one larger field, at a random place, looks and detects the same.
        field = (camera.height + _NOISE_MARGIN_PX, camera.width + _NOISE_MARGIN_PX, 3)
        noise = rng.normal(0.0, 1.0, field).astype(np.float32) * np.float32(camera.noise_std)
        noise = np.round(noise)
        self._lighter = np.clip(noise, 0, 255).astype(np.uint8)
        self._darker = np.clip(-noise, 0, 255).astype(np.uint8)

    def render(self, view: Viewpoint, people: People) -> ImageArray:
        """One picture, shape (height, width, 3), BGR."""
        frame = self._room.paint(view)
        brightness = view.camera.exposure * self._scene.backlight
        if brightness != 1.0:
            cv2.convertScaleAbs(frame, dst=frame, alpha=brightness)
        for _, paint in sorted(self._things(frame, view, people), key=lambda thing: -thing[0]):
            paint()
        camera = view.camera
        if camera.motion_px > 1:
            cv2.blur(frame, (camera.motion_px, 1), dst=frame)
        if camera.blur_px > 0.0:
            cv2.GaussianBlur(frame, (0, 0), camera.blur_px, dst=frame)
        if camera.noise_std > 0.0:
            row, column = self._rng.integers(0, _NOISE_MARGIN_PX, 2)
            window = np.s_[row : row + camera.height, column : column + camera.width]
            cv2.add(frame, self._lighter[window], dst=frame)
            cv2.subtract(frame, self._darker[window], dst=frame)
        return frame

    def _things(
        self, frame: ImageArray, view: Viewpoint, people: People
    ) -> list[tuple[float, Callable[[], None]]]:
        """Distance ahead of everything that stands in the room, and what paints it."""
        things: list[tuple[float, Callable[[], None]]] = []
        places = np.array([(table.x_m, table.y_m) for table in self._scene.tables]).reshape(-1, 2)
        for table, place in zip(self._tables, view.forward_left(places), strict=True):
            things.append((float(place[0]), partial(table.paint, frame, view)))
        for chair in self._chairs:
            ahead_m = float(view.forward_left(chair.xy_m)[0])
            # Before somebody who sits on it, whose place is the same.
            things.append((ahead_m + _SEAT_BEFORE_M, partial(chair.paint_seat, frame, view)))
            if chair.back_xy_m is not None:
                ahead_m = float(view.forward_left(chair.back_xy_m)[0])
                things.append((ahead_m, partial(chair.paint_back, frame, view)))
        for figure in self.figures(view, people):
            paint = partial(figure.pyramid.lay_over, frame, figure.anchor_px, figure.px_per_m)
            things.append((figure.ahead_m, paint))
        return things

    def figures(self, view: Viewpoint, people: People) -> Iterator[ShownFigure]:
        """Everybody in front of a camera, as they are shown."""
        for row, look in enumerate(self._looks):
            ahead_left = view.forward_left(people.xy_m[row])
            if ahead_left[0] < max(NEAR_M, 0.3):
                continue
            behind = is_from_behind(view, people, row)
            doing = None if behind else people.doing[row]  # the trunk hides what hands do
            step = _step_of(float(people.raised[row]), float(people.swing[row]))
            what, number = doing or ("", step)
            anchor = view.pixels(ahead_left, 0.0)
            yield ShownFigure(
                row,
                float(ahead_left[0]),
                self._figure(look, behind, what)[number],
                (float(anchor[0]), float(anchor[1])),
                float(view.camera.fx / ahead_left[0]),
            )

    def _figure(self, look: Look, from_behind: bool, what: str) -> list[Pyramid]:
        key = (look, from_behind, what)
        if key not in self._figures:
            sprites = (
                paint_activity(look, what, px_per_m=self._px_per_m)
                if what
                else paint_figure(
                    look, self._steps(look), px_per_m=self._px_per_m, from_behind=from_behind
                )
            )
            exposure = self._scene.camera.exposure
            self._figures[key] = [Pyramid(_exposed(sprite, exposure)) for sprite in sprites]
        return self._figures[key]

    def _steps(self, look: Look) -> tuple[tuple[float, float], ...]:
        """How far up and outward the arm of a figure is painted."""
        waves = any(person.wave_hz and look_of(person) == look for person in self._scene.people)
        swings = SWING_STEPS if waves else ()
        return (*((step, 0.0) for step in RAISED_STEPS), *((1.0, step) for step in swings))


def _step_of(raised: float, swing: float) -> int:
    """Which sprite of a figure is shown."""
    step = int(raised * (len(RAISED_STEPS) - 1))
    if abs(swing) < abs(SWING_STEPS[1]) / 2:
        return step
    return len(RAISED_STEPS) + int(np.argmin(np.abs(np.array(SWING_STEPS) - swing)))


def hands_in_view(scene: Scene, view: Viewpoint, people: People) -> BoolArray:
    """Shape (P,): each one's raised hand, wrist to fingertips, would fall into the picture."""
    answer = np.zeros(len(scene.people), dtype=bool)
    for row in range(len(scene.people)):
        if view.forward_left(people.xy_m[row])[0] >= max(NEAR_M, 0.3):
            answer[row] = view.is_in_picture(raised_hand_pixels(scene, view, people, row))
    return answer


def raised_hand_pixels(scene: Scene, view: Viewpoint, people: People, row: int) -> FloatArray:
    """Shape (21, 2): where a person's landmarks are in the picture once the hand is fully up."""
    ahead, left = view.forward_left(people.xy_m[row])
    behind = is_from_behind(view, people, row)
    swing = float(people.swing[row])
    hand = raised_hand_landmarks(look_of(scene.people[row]), from_behind=behind, swing=swing)
    places = np.stack([np.full(len(hand), ahead), left - hand[:, 0]], axis=-1)
    return view.pixels(places, hand[:, 1])


def is_from_behind(view: Viewpoint, people: People, row: int) -> bool:
    """Whether the camera sees this person's back."""
    to_camera = np.subtract((view.x_m, view.y_m), people.xy_m[row])
    away = normalize_angle(np.arctan2(to_camera[1], to_camera[0]) - people.facing_rad[row])
    return bool(abs(away) > _BEHIND_RAD)


def look_of(person: Person) -> Look:
    """What a scene file says about somebody's looks."""
    look = person.look
    return Look(
        stature_m=look.stature_m,
        seat_m=person.seat_m,
        right_handed=person.hand == "right",
        skin=bgr(look.skin),
        hair=bgr(look.hair),
        hair_style=look.hair_style,
        shirt=bgr(look.shirt),
        trousers=bgr(look.trousers),
        sleeve=look.sleeve,
        build=look.build,
        hand_m=look.hand_m,
        spread=look.spread,
        raise_style=person.raise_style,
        lean_deg=person.lean_deg,
        has_stool=person.stool,
        sign=person.sign,
    )


def _exposed(sprite: Sprite, exposure: float) -> Sprite:
    if exposure == 1.0:
        return sprite
    bgra = sprite.bgra.copy()
    color = bgra[..., :3] * np.float32(exposure)
    bgra[..., :3] = np.minimum(color, bgra[..., 3:])  # no more than white, times the opacity
    return replace(sprite, bgra=bgra)


class Pyramid:
    """A sprite at halved resolutions, so that any smaller size is one cheap warp away."""

    def __init__(self, sprite: Sprite) -> None:
        self._levels = [sprite]
        while min(self._levels[-1].bgra.shape[:2]) > 16:
            last = self._levels[-1]
            smaller = cv2.resize(last.bgra, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
            half = np.asarray(smaller, dtype=np.uint8)
            ratio = half.shape[0] / last.bgra.shape[0]
            anchor = (last.anchor_px[0] * ratio, last.anchor_px[1] * ratio)
            self._levels.append(Sprite(half, anchor, last.px_per_m * ratio))

    def lay_over(self, frame: ImageArray, anchor_px: tuple[float, float], px_per_m: float) -> None:
        """Composite it, its anchor at a place of the frame."""
        placed = self.placed(frame.shape[:2], anchor_px, px_per_m)
        if placed is None:
            return
        window, bgra = placed
        under = frame[window]
        clear = cv2.cvtColor(255 - bgra[..., 3], cv2.COLOR_GRAY2BGR)
        behind = cv2.multiply(under, clear, scale=1 / 255)
        under[:] = cv2.add(behind, bgra[..., :3])

    def placed(
        self, size: tuple[int, int], anchor_px: tuple[float, float], px_per_m: float
    ) -> tuple[tuple[slice, slice], ImageArray] | None:
        """The part of a frame that it covers, and what it shows there; None for none.

        Args:
            size: Rows and columns of the frame.
            anchor_px: Column and row of its anchor.
            px_per_m: How large it is shown.
        """
        level = max(
            (item for item in self._levels if item.px_per_m >= px_per_m),
            key=lambda item: -item.px_per_m,
            default=self._levels[0],
        )
        scale = px_per_m / level.px_per_m
        left = anchor_px[0] - level.anchor_px[0] * scale
        top = anchor_px[1] - level.anchor_px[1] * scale
        height, width = level.bgra.shape[0] * scale, level.bgra.shape[1] * scale
        first_row, last_row = max(int(top), 0), min(int(top + height) + 2, size[0])
        first, last = max(int(left), 0), min(int(left + width) + 2, size[1])
        if last_row <= first_row or last <= first:
            return None
        # Pixel centers: the sprite's pixel (i + 0.5) * scale lands on the frame's.
        shift = 0.5 * scale - 0.5
        placed = cv2.warpAffine(
            level.bgra,
            np.array([[scale, 0.0, left - first + shift], [0.0, scale, top - first_row + shift]]),
            (last - first, last_row - first_row),
            flags=cv2.INTER_LINEAR,
            borderValue=(0, 0, 0, 0),
        )
        return (slice(first_row, last_row), slice(first, last)), np.asarray(placed)


class ShownFigure(NamedTuple):
    """A person as a camera shows them.

    Attributes:
        row: Which of the scene's people.
        ahead_m: Distance ahead of the camera.
        pyramid: What is laid over the picture.
        anchor_px: Column and row of the point between the feet.
        px_per_m: How large it is shown.
    """

    row: int
    ahead_m: float
    pyramid: Pyramid
    anchor_px: tuple[float, float]
    px_per_m: float
