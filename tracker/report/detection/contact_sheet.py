"""Contact sheet of the photos with missed hands and false raises."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from tracker.containers import ImageArray
from tracker.evaluation.detection.photo_study import JudgedPhoto, PhotoStudy
from tracker.recording.pictures import read_photo
from tracker.report.palette import INK, LIT, PAPER, PERSON_COLORS, as_bgr
from tracker.report.video.debug_picture import FINGERS

_TILE_PX, _CAPTION_PX, _GAP_PX = 320, 26, 8
_COLUMNS = 4
#: More would make a picture that nobody opens.
_TILES = 80
_MISSED, _FALSE = as_bgr(LIT), as_bgr(PERSON_COLORS[1])


def draw_contact_sheet(study: PhotoStudy, path: str | Path) -> bool:
    """Draw the photos in which something was missed (a ring) or invented (a hand's skeleton).

    Args:
        study: What was found.
        path: The .png file, replaced if it exists.

    Returns:
        Whether there was anything to draw; else no file is written.

    Raises:
        OSError: The file cannot be written.
        RecordingError: A photo can no longer be read.
    """
    wrong = [item for item in study.photos if not item.is_found.all() or item.is_false.any()]
    if not wrong:
        return False
    tiles = [_tile(item) for item in wrong[:_TILES]]
    columns = min(_COLUMNS, len(tiles))
    rows = -(-len(tiles) // columns)
    step = np.array([_TILE_PX + _CAPTION_PX + _GAP_PX, _TILE_PX + _GAP_PX])
    height, width = step * (rows, columns) + _GAP_PX
    sheet: ImageArray = np.full((height, width, 3), as_bgr(PAPER), np.uint8)
    for number, tile in enumerate(tiles):
        top, left = step * divmod(number, columns) + _GAP_PX
        sheet[top : top + tile.shape[0], left : left + tile.shape[1]] = tile
    _, encoded = cv2.imencode(".png", sheet)
    Path(path).write_bytes(encoded.tobytes())
    return True


def _tile(item: JudgedPhoto) -> ImageArray:
    photo = read_photo(item.photo.path)
    scale = _TILE_PX / max(photo.shape[:2])
    small = cv2.resize(photo, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    for wrist in item.photo.wrists_px[~item.is_found]:
        if np.isfinite(wrist).all():
            column, row = np.round(wrist * scale).astype(int).tolist()
            cv2.circle(small, (column, row), 16, _MISSED, 3, cv2.LINE_AA)
    for hand in item.hands.landmarks_px[item.is_false]:
        for finger in FINGERS:
            bones = [np.round(hand[list(finger)] * scale).astype(np.int32)]
            cv2.polylines(small, bones, False, _FALSE, 2, cv2.LINE_AA)
    tile: ImageArray = np.full((_TILE_PX + _CAPTION_PX, _TILE_PX, 3), as_bgr(PAPER), np.uint8)
    tile[: small.shape[0], : small.shape[1]] = small
    missed, false = int((~item.is_found).sum()), int(item.is_false.sum())
    why = ", ".join(dict.fromkeys(filter(None, item.reasons)))
    words = [f"{missed} missed ({why})"] * bool(missed) + [f"{false} false"] * bool(false)
    text = f"{item.photo.path.name[:20]}: {', '.join(words)}"
    place = (2, small.shape[0] + 18)
    cv2.putText(tile, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.4, as_bgr(INK), 1, cv2.LINE_AA)
    return tile
