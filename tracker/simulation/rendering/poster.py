"""What is on a poster? Lines of text, somebody, or somebody with a raised hand."""

from __future__ import annotations

import numpy as np

from tracker.containers import ImageArray
from tracker.simulation.interior import Poster
from tracker.simulation.rendering.canvas import Color, Sprite
from tracker.simulation.rendering.figure import paint_figure
from tracker.simulation.rendering.look import Look

#: Resolution: a poster is seen from two meters and more.
POSTER_PX_PER_M = 320.0
_BORDER_M = 0.03
_INK = (70, 62, 58)
#: Of the person on a poster is shown what is above this, up to the fingers of a raised hand.
_WAIST_M, _FINGERS_M = 1.0, 1.92


def paint_poster(poster: Poster, paper: Color) -> ImageArray:
    """The poster as it is printed, shape (rows, columns, 3), BGR, `POSTER_PX_PER_M`.

    Args:
        poster: Which.
        paper: Its color.
    """
    rows = max(int(poster.height_m * POSTER_PX_PER_M), 2)
    columns = max(int(poster.width_m * POSTER_PX_PER_M), 2)
    sheet = np.empty((rows, columns, 3), np.uint8)
    sheet[:] = _INK
    border = min(int(_BORDER_M * POSTER_PX_PER_M), rows // 4, columns // 4)
    sheet[border : rows - border, border : columns - border] = paper
    if poster.shows == "menu":
        _print_lines(sheet)
    else:
        px_per_m = (rows - 2 * border) / (_FINGERS_M - _WAIST_M)
        raised = 1.0 if poster.shows == "raised_hand" else 0.0
        (figure,) = paint_figure(Look(), ((raised, 0.0),), px_per_m=px_per_m)
        inside = sheet[border : rows - border, border : columns - border]
        _lay(inside, figure, round(_FINGERS_M * px_per_m))
    return sheet


def _print_lines(sheet: ImageArray) -> None:
    """A heading, and lines of different lengths below it."""
    rows, columns = sheet.shape[:2]
    left, line = columns // 8, max(rows // 24, 2)
    sheet[2 * line : 4 * line, columns // 4 : 3 * columns // 4] = (60, 70, 150)
    for number, top in enumerate(range(6 * line, rows - 3 * line, 2 * line)):
        right = columns - left - (number * 7919 % 5) * columns // 16
        sheet[top : top + line // 2, left:right] = _INK


def _lay(sheet: ImageArray, sprite: Sprite, floor_row: int) -> None:
    """Lay a figure over a sheet, in its middle; what does not fit is cut off.

    Args:
        sheet: Painted on.
        sprite: Of the sheet's resolution.
        floor_row: Where the figure stands, in rows from the sheet's top.
    """
    rows, columns = sheet.shape[:2]
    top = floor_row - round(sprite.anchor_px[1])
    left = columns // 2 - round(sprite.anchor_px[0])
    height, width = sprite.bgra.shape[:2]
    first, last = max(top, 0), min(top + height, rows)
    begin, end = max(left, 0), min(left + width, columns)
    if first >= last or begin >= end:
        return
    part = sprite.bgra[first - top : last - top, begin - left : end - left].astype(np.float32)
    under = sheet[first:last, begin:end]
    under[:] = np.clip(under * (1.0 - part[..., 3:] / 255.0) + part[..., :3], 0.0, 255.0)
