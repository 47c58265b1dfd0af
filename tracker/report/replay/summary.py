"""What goes into summary.json, and what does the terminal show at the end?"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tracker.evaluation.metrics.raised_hands.episode_report import EpisodeReport
from tracker.geometry import worst_std
from tracker.outputs import writing_into
from tracker.report.history.history import History, Person, RaisedHand, Span

if TYPE_CHECKING:
    from rich.table import Table


def summarize(
    history: History,
    *,
    frames_seen: int | None = None,
    evaluation: EpisodeReport | None = None,
) -> dict[str, Any]:
    """Everything worth keeping of a recording, in plain numbers fit for JSON.

    Seconds count from `start_stamp_ns`. Positions are in meters of the fixed frame.

        start_stamp_ns      stamp of second 0, or null without any image
        duration_s          sensor time covered by the images
        frames              {seen, processed, hand_raised}; seen is null where nobody counted
        notes               {first note of a kind: images that carried one of that kind}
        hands_not_raised    {reason: images in which a hand that was found was not raised for it},
                            the most frequent first; the reasons are those of `Refusal`
        people              one entry per confirmed customer, in the order they came:
            id              as in tracks.csv and output.mcap
            first_seen_s, last_seen_s
            episodes        [{raised_at_s, lowered_at_s, frames, xy_m, std_m, bearing_deg,
                            bearing_std_deg}]; lowered_at_s is null while the hand is up at the
                            end, xy_m the mean over the episode, null where only the bearing is
                            known, std_m the standard deviation along the worst axis when it
                            began, bearing_deg from the camera and the x axis
            xy_m            mean over all episodes; null without one, or without a place
            selected        [{from_s, to_s}]; to_s is null while it lasts
            gestures        [{gesture, from_s, to_s}], likewise; the words are those of `Gesture`
        people_dropped      customers left out to bound memory
        evaluation          `EpisodeReport.as_dict()`, only where the truth was known

    Args:
        history: What was collected while the recording streamed.
        frames_seen: Images in the recording, the passed-over ones included.
        evaluation: The comparison with the truth, if there was any.
    """
    summary: dict[str, Any] = {
        "start_stamp_ns": history.start_ns,
        "duration_s": round(history.duration_s, 6),
        "frames": {
            "seen": frames_seen,
            "processed": history.frames_processed,
            "hand_raised": history.frames_raised,
        },
        "notes": history.notes,
        "hands_not_raised": {
            reason.name.lower(): images
            for reason, images in history.hands_not_raised.most_common()
        },
        "people": [_person(history, person) for person in history.people.values()],
        "people_dropped": history.people_dropped,
    }
    if evaluation is not None:
        summary["evaluation"] = evaluation.as_dict()
    return summary


def write_summary(summary: dict[str, Any], path: str | Path) -> None:
    """Write a summary as JSON; the file is there as a whole or not at all.

    Raises:
        RecordingError: The file cannot be written.
    """
    path = Path(path)
    text = json.dumps(summary, indent=2, allow_nan=False) + "\n"
    with writing_into(path.parent) as new:
        new(path.name).write_text(text, encoding="utf-8")


def summary_table(history: History) -> Table:
    """One line per time that a hand was up: who, when, where, served or not."""
    from rich.table import Table

    table = Table(title="Raised hands", title_justify="left")
    table.add_column("person")
    for name in ("hand up at", "for", "bearing", "x", "y", "± (95 %)", "served for"):
        table.add_column(name, justify="right")
    pairs = [(hand, person) for person in history.people.values() for hand in person.hands]
    for hand, person in sorted(pairs, key=lambda pair: pair[0].start_ns):
        served_s = sum(_overlap_s(history, hand, span) for span in person.selected)
        place = hand.mean_xy_m
        where = ("-", "-", "-")
        if place is not None:
            where = (f"{place[0]:.2f} m", f"{place[1]:.2f} m", f"{2 * _std_m(hand):.2f} m")
        table.add_row(
            f"#{person.id}",
            f"{history.seconds(hand.start_ns):.1f} s",
            f"{_length_s(history, hand):.1f} s" + ("" if hand.end_ns else " +"),
            f"{np.degrees(hand.direction_rad[0]):.0f}°",
            *where,
            f"{served_s:.1f} s" if served_s else "-",
        )
    return table


def _person(history: History, person: Person) -> dict[str, Any]:
    placed = sum(hand.placed for hand in person.hands)
    mean = sum((hand.sum_xy_m for hand in person.hands), np.zeros(2)) / max(1, placed)
    return {
        "id": person.id,
        "first_seen_s": _seconds(history, person.first_seen_ns),
        "last_seen_s": _seconds(history, person.last_seen_ns),
        "episodes": [
            {
                "raised_at_s": _seconds(history, hand.start_ns),
                "lowered_at_s": _seconds(history, hand.end_ns),
                "frames": hand.frames,
                "xy_m": None if hand.mean_xy_m is None else _numbers(hand.mean_xy_m),
                "std_m": round(_std_m(hand), 6),
                "bearing_deg": round(float(np.degrees(hand.direction_rad[0])), 3),
                "bearing_std_deg": round(float(np.degrees(hand.direction_rad[1])), 3),
            }
            for hand in person.hands
        ],
        "xy_m": _numbers(mean) if placed else None,
        "selected": [
            {"from_s": _seconds(history, span.start_ns), "to_s": _seconds(history, span.end_ns)}
            for span in person.selected
        ],
        "gestures": [
            {
                "gesture": span.gesture.word,
                "from_s": _seconds(history, span.start_ns),
                "to_s": _seconds(history, span.end_ns),
            }
            for span in person.said
        ],
    }


def _seconds(history: History, stamp_ns: int | None) -> float | None:
    return None if stamp_ns is None else round(history.seconds(stamp_ns), 6)


def _numbers(values: np.ndarray) -> list[float]:
    return [round(value, 6) for value in values.tolist()]


def _std_m(hand: RaisedHand) -> float:
    return float(worst_std(hand.covariance_m2))


def _stop_ns(history: History, span: Span) -> int:
    return span.end_ns if span.end_ns is not None else (history.end_ns or span.start_ns)


def _length_s(history: History, span: Span) -> float:
    return (_stop_ns(history, span) - span.start_ns) / 1e9


def _overlap_s(history: History, a: Span, b: Span) -> float:
    stop = min(_stop_ns(history, a), _stop_ns(history, b))
    return max(0.0, (stop - max(a.start_ns, b.start_ns)) / 1e9)
