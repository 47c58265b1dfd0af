"""What do the gestures look like? Draws gestures.svg from the hands that the network learnt from.

python docs/images/gestures.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.containers import FloatArray
from tracker.gesture import Gesture
from tracker.simulation.hand_signs import hold_pose
from tracker.simulation.posed_hand import hand_points

CELL, HAND = 150, 92.0
SKIN, LINE, INK = "#f0c8a8", "#8a5a3c", "#2b6f77"
FINGERS = [(0, 1, 2, 3, 4), (5, 6, 7, 8), (9, 10, 11, 12), (13, 14, 15, 16), (17, 18, 19, 20)]
WIDTHS = (17, 15, 15, 14, 12)
PALM = (0, 1, 5, 9, 13, 17)
#: The way to hold the hand, turned so far clockwise in the picture, and the arrows around it.
SHOWN = {
    Gesture.PALM: ("palm", 0.0),
    Gesture.FIST: ("fist", 0.0),
    Gesture.POINT: ("point", 0.0),
    Gesture.VICTORY: ("victory", 0.0),
    Gesture.THUMB_UP: ("thumb", -90.0),
    Gesture.THUMB_DOWN: ("thumb", 90.0),
    Gesture.WAVE: ("palm", 15.0),
    Gesture.STOP: ("palm", 0.0),
    Gesture.COME: ("relaxed", 0.0),
}
WORDS = {
    Gesture.WAVE: "to and fro",
    Gesture.STOP: "held still, not up",
    Gesture.COME: "again and again",
}


def typical(name: str) -> FloatArray:
    """Shape (21, 3): of many hands held in one way the middle one."""
    pose = hold_pose(name, 400, np.random.default_rng(1))
    return hand_points(type(pose)(*(np.median(part, axis=0)[None] for part in pose)))[0]


def hand(name: str, turn_deg: float, opacity: float = 1.0) -> str:
    """A hand around the middle of its cell; what is farther from the viewer comes first."""
    points = typical(name) - [0.0, 0.5, 0.0]
    angle = np.radians(turn_deg)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    if name == "thumb":  # the thumb itself is turned
        thumb = points[4] - points[2]
        angle = np.arctan2(thumb[0], thumb[1]) + (np.pi if turn_deg > 0.0 else 0.0)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    flat = points[:, :2] @ turn.T * HAND * [1.0, -1.0]
    if name == "thumb":
        flat -= (flat.min(axis=0) + flat.max(axis=0)) / 2
    flat += CELL / 2 - np.array([0.0, 8.0])

    def way(rows: tuple[int, ...]) -> str:
        return " ".join(f"{x:.1f},{y:.1f}" for x, y in flat[list(rows)])

    palm = (
        f'<polygon points="{way(PALM)}" fill="{SKIN}" stroke="{LINE}" stroke-width="19"/>'
        f'<polygon points="{way(PALM)}" fill="{SKIN}" stroke="{SKIN}" stroke-width="16"/>'
    )
    strokes = [(-0.001, palm)]
    for rows, width in zip(FINGERS, WIDTHS, strict=True):
        line = f'<polyline fill="none" points="{way(rows)}" stroke='
        text = (
            f'{line}"{LINE}" stroke-width="{width}"/>{line}"{SKIN}" stroke-width="{width - 3}"/>'
        )
        strokes.append((float(points[list(rows[1:]), 2].mean()), text))
    body = "".join(text for _, text in sorted(strokes))
    return f'<g opacity="{opacity}">{body}</g>'


def arrows(gesture: Gesture) -> str:
    """What the hand does meanwhile."""
    if gesture is Gesture.WAVE:
        return f'<path d="M28 34 Q75 6 122 34" {_arrow(2)}/>'
    if gesture is Gesture.COME:
        return f'<path d="M118 24 Q138 50 122 78" {_arrow(2)}/>'
    return ""


def _arrow(ends: int) -> str:
    start = 'marker-start="url(#tip)"' if ends > 1 else ""
    return f'fill="none" stroke="{INK}" stroke-width="3" {start} marker-end="url(#tip)"'


def cell(gesture: Gesture) -> str:
    """One gesture with its word below it."""
    name, turn_deg = SHOWN[gesture]
    ghost = ""
    if gesture is Gesture.WAVE:
        ghost = hand("palm", -20.0, 0.35)
    elif gesture is Gesture.COME:
        ghost = hand("palm", 0.0, 0.35)
    note = WORDS.get(gesture, "")
    small = f'<text x="75" y="168" font-size="11" fill="#777">{note}</text>' if note else ""
    words = f'<text x="75" y="152" font-size="14" fill="{INK}">{gesture.label}</text>{small}'
    return ghost + hand(name, turn_deg) + arrows(gesture) + words


def main() -> None:
    """Five gestures in a row."""
    cells = []
    for number, gesture in enumerate(SHOWN):
        x, y = CELL * (number % 5), 176 * (number // 5)
        cells.append(f'<g transform="translate({x},{y})">{cell(gesture)}</g>')
    tip = (
        '<marker id="tip" markerWidth="4" markerHeight="4" refX="2" refY="2" '
        f'orient="auto-start-reverse"><path d="M0 0 L4 2 L0 4 z" fill="{INK}"/></marker>'
    )
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {5 * CELL} 352" '
        'font-family="sans-serif" text-anchor="middle" stroke-linecap="round" '
        'stroke-linejoin="round"><rect width="100%" height="100%" fill="#fbfaf6"/>'
        f"<defs>{tip}</defs>{''.join(cells)}</svg>\n"
    )
    Path(__file__).with_name("gestures.svg").write_text(svg, encoding="utf-8")


if __name__ == "__main__":
    main()
