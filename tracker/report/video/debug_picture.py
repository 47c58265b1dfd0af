"""What did the detector see? The picture for people: hands, verdicts, identities."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, Hands, ImageArray, Refusal, Tracks
from tracker.gesture import Gesture
from tracker.perception.pictures import shrink_picture
from tracker.perception.verdict.raise_rules import MEASURE_UNITS

#: Bones between the landmarks: five fingers from the wrist, and the row of finger roots.
FINGERS = (
    (0, 1, 2, 3, 4),
    (0, 5, 6, 7, 8),
    (9, 10, 11, 12),
    (13, 14, 15, 16),
    (0, 17, 18, 19, 20),
)
FINGER_ROOTS = (5, 9, 13, 17)

# Blue, green, red.
RAISED_COLOR = (80, 220, 60)
LOWERED_COLOR = (60, 190, 255)
SELECTED_COLOR = (255, 120, 255)
WARNING_COLOR = (70, 70, 255)
TEXT_COLOR = (255, 255, 255)
BLACK = (0, 0, 0)

_FONT = cv2.FONT_HERSHEY_SIMPLEX


@dataclass(frozen=True, slots=True)
class _Label:
    """Words of one hand, from the most telling line to the shortest that still says it."""

    variants: tuple[str, ...]
    color: tuple[int, int, int]
    is_filled: bool = False


def draw_debug_image(
    image: CameraImage, hands: Hands, tracks: Tracks | None, config: Config
) -> ImageArray:
    """The camera's picture, shrunk by `downscale_factor`, with everything found in it.

    Every hand shows its landmarks and a circle at the wrist; a raised one `HAND RAISED` with its
    measure; the nearest of the others, the largest, why it is not raised; one that belongs to a
    track the person's number, and whether the streak calls the hand raised; and what it says, as
    `wave`, where that is sure. Who is served is framed and stands out. `NO HAND DETECTED` is
    written only where there is none.

    Args:
        image: The picture.
        hands: What was found in it, in pixels of the full image.
        tracks: The customers after this image; `Tracks.hand` leads to rows of `hands`.
        config: `downscale_factor`, `raise_rule` and its threshold.

    Returns:
        Shape (about height / factor, about width / factor, 3), uint8, blue-green-red; a new array.
    """
    canvas = np.array(shrink_picture(image.bgr, config.downscale_factor))  # a copy, to draw on
    height, width = canvas.shape[:2]
    scale = np.array([width / image.width, height / image.height])
    points = np.clip(hands.landmarks_px * scale, -1e4, 1e4)  # within OpenCV's 16-bit coordinates
    owners = _tracks_of_hands(tracks, len(hands))
    pen = max(1, round(width / 400))
    for row in range(len(hands)):
        is_selected = _is_selected(tracks, owners[row])
        color = RAISED_COLOR if hands.raised[row] else LOWERED_COLOR
        _draw_hand(canvas, points[row], color, is_selected, pen)
    nearest = _nearest_not_raised(hands)
    taken: list[tuple[int, int, int, int]] = []
    for row in range(len(hands)):
        lines = _lines_of_hand(hands, row, tracks, owners[row], config)
        if row == nearest:
            lines.append(_reason(Refusal(int(hands.refusal[row]))))
        _write_beside(canvas, points[row], lines, taken)
    if len(hands) == 0:
        _write_notice(canvas, _Label(("NO HAND DETECTED", "NO HAND"), WARNING_COLOR))
    _write_status(canvas, _status(hands, tracks, config))
    return canvas


def _tracks_of_hands(tracks: Tracks | None, count: int) -> list[int | None]:
    owners: list[int | None] = [None] * count
    if tracks is not None:
        for track, hand in enumerate(tracks.hand.tolist()):
            if 0 <= hand < count:
                owners[hand] = track
    return owners


def _is_selected(tracks: Tracks | None, owner: int | None) -> bool:
    if tracks is None or owner is None or tracks.selected_id is None:
        return False
    return int(tracks.id[owner]) == tracks.selected_id


def _draw_hand(
    canvas: ImageArray,
    points: np.ndarray,
    color: tuple[int, int, int],
    is_selected: bool,
    pen: int,
) -> None:
    dots = np.round(points).astype(np.int32)
    bones = [dots[list(chain)] for chain in (*FINGERS, FINGER_ROOTS)]
    cv2.polylines(canvas, bones, False, BLACK, pen + 2, cv2.LINE_AA)
    cv2.polylines(canvas, bones, False, color, pen, cv2.LINE_AA)
    is_small = np.ptp(points, axis=0).max() < 60 * pen  # its bones would vanish behind the dots
    for dot in [] if is_small else dots.tolist():
        cv2.circle(canvas, dot, pen + 1, TEXT_COLOR, -1, cv2.LINE_AA)
    wrist, ring = dots[0].tolist(), 3 * pen + (1 if is_small else 4)
    cv2.circle(canvas, wrist, ring, BLACK, pen + 2, cv2.LINE_AA)
    cv2.circle(canvas, wrist, ring, SELECTED_COLOR if is_selected else color, pen, cv2.LINE_AA)
    if is_selected:
        low, high = dots.min(axis=0) - 4 * pen, dots.max(axis=0) + 4 * pen
        cv2.rectangle(canvas, low.tolist(), high.tolist(), SELECTED_COLOR, pen + 1, cv2.LINE_AA)


def _lines_of_hand(
    hands: Hands, row: int, tracks: Tracks | None, owner: int | None, config: Config
) -> list[_Label]:
    lines = []
    gesture = Gesture(int(hands.gesture[row]))
    word = "" if gesture is Gesture.NONE else gesture.label
    if tracks is not None and owner is not None:
        number = f"#{tracks.id[owner]}"
        state = f"{number} raised" if tracks.raised[owner] else number
        said = f"{state}: {word}" if word else state
        if _is_selected(tracks, owner):
            variants = (f"{state} - served: {word}" if word else f"{state} - served", said, number)
            lines.append(_Label(variants, SELECTED_COLOR, True))
        else:
            lines.append(_Label((said, state, number), TEXT_COLOR))
    elif word:
        lines.append(_Label((word,), TEXT_COLOR))
    if hands.raised[row]:
        measure = f"{hands.raise_measure[row]:.2f}"
        unit = MEASURE_UNITS[config.raise_rule]
        variants = (f"HAND RAISED {measure} {unit}", f"HAND RAISED {measure}", f"RAISED {measure}")
        lines.append(_Label((*variants, measure), RAISED_COLOR))
    return lines


def _nearest_not_raised(hands: Hands) -> int | None:
    """The row of the largest hand that is not raised."""
    if hands.raised.all():
        return None
    return int(np.argmax(np.where(hands.raised, -1.0, hands.length_px)))


def _reason(refusal: Refusal) -> _Label:
    return _Label((f"not raised: {refusal.words}", refusal.words), LOWERED_COLOR)


def _status(hands: Hands, tracks: Tracks | None, config: Config) -> _Label:
    raised = int(hands.raised.sum())
    parts = [f"{len(hands)} hand{'' if len(hands) == 1 else 's'}, {raised} raised"]
    short = [f"{raised}/{len(hands)} raised"]
    if tracks is not None:
        count = int(tracks.confirmed.sum())
        parts.append(f"{count} customer{'' if count == 1 else 's'}")
        if tracks.selected_id is not None:
            parts.append(f"serving #{tracks.selected_id}")
            short.append(f"#{tracks.selected_id}")
    if config.raise_rule == "evidence":
        rule = "raised if surer than 0.5"
    elif config.raise_rule == "palm":
        rule = f"up from {config.palm_raised_threshold:g} palm lengths"
    else:
        rule = f"up from {config.hand_raised_threshold:g} image heights"
    variants = (" | ".join([*parts, rule]), " | ".join(parts), " | ".join(short), short[0])
    return _Label(variants, TEXT_COLOR)


def _write_beside(
    canvas: ImageArray,
    points: np.ndarray,
    lines: list[_Label],
    taken: list[tuple[int, int, int, int]],
) -> None:
    """Write a hand's lines above it, or where there is room, not over another hand's lines."""
    if not lines:
        return
    height, width = canvas.shape[:2]
    font_scale = _font_scale(width)
    texts = [_fitting(line.variants, width, font_scale) for line in lines]
    line_px = _line_height(font_scale)
    block = (max(_text_width(text, font_scale) for text in texts) + 4, line_px * len(lines))
    low, high = points.min(axis=0), points.max(axis=0)
    left = int(np.clip((low[0] + high[0] - block[0]) / 2, 0, max(0, width - block[0])))
    bottom = max(0, height - line_px - block[1])  # the last line of the picture is the status
    wishes = [low[1] - block[1] - 6, high[1] + 10, *range(0, bottom + 1, max(1, line_px // 2))]
    tops = [int(np.clip(wish, 0, bottom)) for wish in wishes]
    free = (top for top in tops if not _hits(taken, left, top, block))
    top = next(free, tops[0])
    taken.append((left, top, left + block[0], top + block[1]))
    for line, text in zip(lines, texts, strict=True):
        _write(canvas, text, left + 2, top, font_scale, line)
        top += line_px


def _hits(
    taken: list[tuple[int, int, int, int]], left: int, top: int, block: tuple[int, int]
) -> bool:
    return any(
        left < x1 and x0 < left + block[0] and top < y1 and y0 < top + block[1]
        for x0, y0, x1, y1 in taken
    )


def _write_notice(canvas: ImageArray, label: _Label) -> None:
    width = canvas.shape[1]
    font_scale = 1.5 * _font_scale(width)
    text = _fitting(label.variants, width, font_scale)
    left = max(0, (width - _text_width(text, font_scale)) // 2)
    _write(canvas, text, left, _line_height(font_scale) // 2, font_scale, label)


def _write_status(canvas: ImageArray, label: _Label) -> None:
    height, width = canvas.shape[:2]
    font_scale = 0.9 * _font_scale(width)
    top = max(0, height - _line_height(font_scale))
    text = _fitting(label.variants, width, font_scale)
    _write(canvas, text, 2, top, font_scale, label)


def _write(
    canvas: ImageArray, text: str, left: int, top: int, font_scale: float, label: _Label
) -> None:
    """One line on a ground of its own; an outline would not fit under OpenCV 5's letters."""
    height, width = canvas.shape[:2]
    bottom = min(height, top + _line_height(font_scale))
    right = min(width, left + _text_width(text, font_scale) + 2)
    ground = canvas[max(0, top) : bottom, max(0, left - 2) : right]
    color = label.color
    if label.is_filled:
        ground[:], color = color, BLACK
    else:
        _darken(ground)
    origin = (left, top + round(0.75 * _line_height(font_scale)))
    cv2.putText(
        canvas, text, origin, _FONT, font_scale, color, _thickness(font_scale), cv2.LINE_AA
    )


def _darken(pixels: ImageArray) -> None:
    pixels[:] = pixels // 4


def _fitting(variants: tuple[str, ...], width: int, font_scale: float) -> str:
    """The longest variant that fits into the picture's width, else the shortest."""
    for text in variants:
        if _text_width(text, font_scale) + 6 <= width:
            return text
    return variants[-1]


def _text_width(text: str, font_scale: float) -> int:
    (width, _), _ = cv2.getTextSize(text, _FONT, font_scale, _thickness(font_scale))
    return int(width)


def _thickness(font_scale: float) -> int:
    return max(1, round(1.3 * font_scale))


def _font_scale(width: int) -> float:
    """Letters of 1/40 of a wide picture, but never smaller than the eye can read."""
    return float(np.clip(width / 900, 0.38, 2.5))


def _line_height(font_scale: float) -> int:
    return max(9, round(34 * font_scale))
