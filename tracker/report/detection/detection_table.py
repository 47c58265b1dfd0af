"""How does an evaluation of detection look in a terminal, and in files?"""

from __future__ import annotations

import csv
import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tracker.evaluation.detection.episode import FRAMES_TO_FIND
from tracker.evaluation.detection.figures import (
    FalseRate,
    Recall,
    detection_as_dict,
    false_rate,
    false_rate_by_activity,
    false_rate_by_distance,
    recall_by_factor,
    recall_of,
)
from tracker.evaluation.detection.study import DetectionStudy
from tracker.outputs import writing_into
from tracker.report.detection.detection_plot import draw_detection
from tracker.wording import counted

SCENE_FILES = ("evaluation.json", "episodes.csv", "minutes.csv", "evaluation.png")

if TYPE_CHECKING:
    from rich.table import Table


def recall_table(study: DetectionStudy) -> Table:
    """One line per level of each factor, the total at the end."""
    from rich.table import Table

    table = Table(
        title=f"Raised hands found within {FRAMES_TO_FIND} images, "
        f"{counted(len(study.episodes), 'episode')} of seed {study.seed}",
        title_justify="left",
    )
    for name in ("factor", "level"):
        table.add_column(name, no_wrap=True)
    for name in ("found", "recall", "95 % interval", "images", "error"):
        table.add_column(name, justify="right", no_wrap=True)
    for factor, rows in recall_by_factor(study).items():
        for place, row in enumerate(rows):
            table.add_row(factor if place == 0 else "", *_recall_cells(row))
        table.add_section()
    table.add_row("all", *_recall_cells(recall_of("", study.episodes)))
    table.caption = (
        "recall: share of raised hands that were found, 100 % is perfect; images: median number "
        "until found; error: median of the landmarks, in hand lengths, less is better"
    )
    table.caption_justify = "left"
    return table


def false_table(study: DetectionStudy) -> Table:
    """One line per activity and distance, the camera's hour at the end."""
    from rich.table import Table

    table = Table(
        title=f"False raises in {counted(len(study.minutes), 'minute')} without a call",
        title_justify="left",
    )
    for name in ("by", "level"):
        table.add_column(name, no_wrap=True)
    for name in ("false", "hours", "an hour", "95 % interval"):
        table.add_column(name, justify="right", no_wrap=True)
    for name, rows in (
        ("a person who", false_rate_by_activity(study.minutes)),
        ("a person at", false_rate_by_distance(study.minutes)),
        ("the camera", [false_rate(study.minutes)]),
    ):
        for place, row in enumerate(rows):
            table.add_row(name if place == 0 else "", *_false_cells(row))
        table.add_section()
    beside = sum(item.score.false_raises for item in study.episodes)
    table.caption = (
        "false: raises while nobody calls, 0 is perfect; "
        f"besides these, {beside} in the episodes with a raised hand"
    )
    table.caption_justify = "left"
    return table


def write_detection(study: DetectionStudy, folder: str | Path) -> tuple[Path, ...]:
    """Write evaluation.json, episodes.csv, minutes.csv (a line for each) and evaluation.png.

    Args:
        study: What was found.
        folder: Made where it is missing; what is there is replaced.

    Returns:
        The files.

    Raises:
        RecordingError: A file cannot be written.
    """
    folder = Path(folder)
    document, episodes, minutes, picture = files = tuple(folder / name for name in SCENE_FILES)
    with writing_into(folder) as new:
        text = json.dumps(detection_as_dict(study), indent=1) + "\n"
        new(document.name).write_text(text, encoding="utf-8")
        _write_episodes(study, new(episodes.name))
        _write_minutes(study, new(minutes.name))
        draw_detection(study, new(picture.name))
    return files


def _write_episodes(study: DetectionStudy, path: Path) -> None:
    rows = []
    for item in study.episodes:
        score = item.score
        error = "" if np.isnan(score.landmark_error) else f"{score.landmark_error:.4f}"
        rows.append(
            {"episode": item.number, **asdict(item.conditions), "style": item.style}
            | {"posture": item.posture, "hand_px": f"{score.hand_px:.1f}"}
            | {"found": int(score.frames is not None), "images": score.frames}
            | {"landmark_error": error, "false_raises": score.false_raises}
        )
    _write_rows(path, rows)


def _write_minutes(study: DetectionStudy, path: Path) -> None:
    rows = [
        {
            "minute": item.number,
            "people": "; ".join(f"{what} at {away_m:.1f} m" for what, away_m in item.people),
            "false_raises": len(item.false_raises),
            "of": "; ".join(f"{each.what} at {each.at_s:.1f} s" for each in item.false_raises),
        }
        for item in study.minutes
    ]
    _write_rows(path, rows)


def _write_rows(path: Path, rows: list[dict[str, object]]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        if rows:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


def _recall_cells(row: Recall) -> tuple[str, ...]:
    return (
        row.level,
        f"{row.found} of {row.total}",
        _percent(row.share),
        f"{100 * row.low:.0f}-{100 * row.high:.0f} %" if row.total else "",
        "-" if np.isnan(row.median_frames) else f"{row.median_frames:g}",
        _percent(row.landmark_error),
    )


def _false_cells(row: FalseRate) -> tuple[str, ...]:
    if row.hours == 0:
        return row.level, str(row.count), "0", "-", ""
    interval = f"{row.low:.1f} to {row.high:.1f}"
    return row.level, str(row.count), f"{row.hours:.2f}", f"{row.per_hour:.1f}", interval


def _percent(share: float) -> str:
    return "-" if np.isnan(share) else f"{100 * share:.1f} %"
