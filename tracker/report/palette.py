"""Colors: each person has the same color in every picture."""

from __future__ import annotations

#: Told apart by most color-blind eyes, and none of them near the gold of `LIT`.
PERSON_COLORS = (
    "#2f6db5", "#c8553d", "#2a9072", "#8a56a6", "#5c7a29", "#b8457f", "#1f93a8", "#7a5a42",
)  # fmt: skip

LIT = "#f5b700"  # the customer who is served
INK = "#26292e"
FADED = "#8b9097"
WALL = "#5d646d"
PAPER = "#fdfdfb"
ROBOT = "#3c4048"


def person_color(track_id: int) -> str:
    """Color of a person as `#rrggbb`; ids start at 1 and colors come round again."""
    return PERSON_COLORS[(track_id - 1) % len(PERSON_COLORS)]


def as_bgr(color: str) -> tuple[int, int, int]:
    """The same color in OpenCV's order."""
    return int(color[5:7], 16), int(color[3:5], 16), int(color[1:3], 16)
