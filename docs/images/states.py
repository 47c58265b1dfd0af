"""What are the three states of a customer? Draws states.svg from a run of the tracker.

python docs/images/states.py
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from tracker import Config, Measurements, PersonTracker
from tracker.containers import View
from tracker.report.palette import FADED, INK, LIT, PAPER, PERSON_COLORS

RATE_HZ, END_S = 10, 12.0
HAND_UP_S, MISSED_S, LEAVES_S = (1.0, 4.0), (2.5, 2.6), 7.0
SENSOR = np.zeros(3)


def main() -> None:
    """Somebody raises a hand, lowers it, is still seen by the laser, and leaves."""
    tracker, config = PersonTracker(Config()), Config()
    rng = np.random.default_rng(4)
    times_s = np.arange(round(END_S * RATE_HZ)) / RATE_HZ
    is_up = (times_s >= HAND_UP_S[0]) & (times_s < HAND_UP_S[1])
    is_detected = is_up & ~((times_s >= MISSED_S[0]) & (times_s < MISSED_S[1]))
    raised, fresh = np.zeros((2, len(times_s)), dtype=bool)
    existence = np.full(len(times_s), np.nan)
    for frame, time_s in enumerate(times_s):
        rows = [True] * int(is_detected[frame]) + [False] * int(time_s < LEAVES_S)
        noise = rng.standard_normal((2, len(rows)))
        seen = Measurements.polar(
            0.2 + 0.02 * noise[0], 3.0 + 0.08 * noise[1], 0.02, 0.08, raised=rows
        )
        tracks = tracker.step(
            round(time_s * 1e9), seen, view=View(SENSOR, 1.2), scan_view=View(SENSOR, 4.0)
        )
        for row in np.flatnonzero(tracks.confirmed):
            raised[frame], existence[frame] = tracks.raised[row], tracks.existence[row]
            std_m = np.sqrt(np.linalg.eigvalsh(tracks.covariance[row, :2, :2])[-1])
            is_young = tracks.unseen_s[row] <= config.pose_max_age_s
            fresh[frame] = is_young and std_m <= config.pose_max_std_m
    draw(times_s, is_detected, raised, existence, fresh)


def draw(
    times_s: np.ndarray,
    is_detected: np.ndarray,
    raised: np.ndarray,
    existence: np.ndarray,
    fresh: np.ndarray,
) -> None:
    """One lane for each state, over time."""
    mpl.rcParams["svg.hashsalt"] = "states"  # the same bytes every time
    figure = Figure(figsize=(9.6, 4.6), facecolor=PAPER, layout="constrained")
    lanes = figure.subplots(4, 1, sharex=True, height_ratios=[1, 1, 2, 1])
    lanes[0].eventplot(times_s[is_detected], colors=PERSON_COLORS[1], linewidths=2.5)
    lanes[1].fill_between(times_s, raised, where=raised, step="post", color=PERSON_COLORS[0])
    lanes[2].plot(times_s, existence, color=PERSON_COLORS[2], linewidth=2.5)
    lanes[3].fill_between(times_s, fresh, where=fresh, step="post", color=LIT)
    names = (
        "raised hand\ndetected",
        "raised",
        "exists\n(probability)",
        "fresh\n(fit to drive to)",
    )
    for lane, name in zip(lanes, names, strict=True):
        lane.set_ylabel(name, rotation=0, ha="right", va="center", color=INK, fontsize=11)
        lane.set_facecolor(PAPER)
        lane.spines[["top", "right", "left"]].set_visible(False)
        lane.set_yticks([])
        for at_s in (*HAND_UP_S, LEAVES_S):
            lane.axvline(at_s, color=FADED, linewidth=0.8, linestyle=":")
    lanes[2].set_yticks([0.0, 0.5, 1.0])
    lanes[2].set_ylim(0.0, 1.08)
    events = ((HAND_UP_S[0], "hand up"), (HAND_UP_S[1], "hand down, legs seen"))
    for at_s, what in (*events, (LEAVES_S, "has left")):
        above = lanes[0].get_xaxis_transform()
        lanes[0].text(at_s, 1.1, what, transform=above, fontsize=10, color=INK)
    lanes[0].set_xlim(0.0, END_S)
    lanes[3].set_xlabel("time (s)", color=INK)
    path = Path(__file__).with_suffix(".svg")
    figure.savefig(path, metadata={"Date": None})


if __name__ == "__main__":
    main()
