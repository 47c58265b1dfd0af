"""Recall and false raises of a detection study, with their intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tracker.evaluation.detection.scenes import FACTORS
from tracker.evaluation.detection.study import DetectionStudy, Episode, Minute
from tracker.evaluation.metrics.intervals import poisson_interval, wilson_interval

#: Lower ends of the classes of a hand's length, in pixels.
_SIZES_PX = (0, 14, 20, 28, 40, 60)


@dataclass(frozen=True, slots=True)
class Recall:
    """How many of some raised hands were found.

    Attributes:
        level: Of which hands.
        found: Within the allowed images.
        total: Raised hands.
        share: `found` of `total`; NaN of none.
        low: 95 % interval of the share, by Wilson.
        high: Its other end.
        median_frames: Images until it was found; NaN where none was.
        landmark_error: Median, in hand lengths; NaN where none was found.
    """

    level: str
    found: int
    total: int
    share: float
    low: float
    high: float
    median_frames: float
    landmark_error: float


@dataclass(frozen=True, slots=True)
class FalseRate:
    """How often something was taken for a raised hand.

    The interval takes false raises for independent. Who gestures that way does so again and again,
    so that few minutes with many of them are less sure than it says.

    Attributes:
        level: During what.
        count: False raises.
        hours: Watched: of the camera, or of people who do that.
        per_hour: NaN of no time.
        low: 95 % interval of the rate, by Garwood.
        high: Its other end.
    """

    level: str
    count: int
    hours: float
    per_hour: float
    low: float
    high: float


def recall_of(level: str, episodes: Sequence[Episode]) -> Recall:
    """Sum up some episodes.

    Args:
        level: Their name.
        episodes: Which.
    """
    frames = [item.score.frames for item in episodes if item.score.frames is not None]
    errors = np.array([item.score.landmark_error for item in episodes])
    errors = errors[np.isfinite(errors)]
    found, total = len(frames), len(episodes)
    return Recall(
        level,
        found,
        total,
        found / total if total else float("nan"),
        *wilson_interval(found, total),
        float(np.median(frames)) if frames else float("nan"),
        float(np.median(errors)) if len(errors) else float("nan"),
    )


def recall_by_factor(study: DetectionStudy) -> dict[str, list[Recall]]:
    """Recall at each level of each factor: distance, size, and what the scenes were drawn from."""
    factors: dict[str, Callable[[Episode], str]] = {
        "distance": lambda item: f"{item.conditions.distance_m:g} m",
        "size": lambda item: _size(item.score.hand_px),
        **{name: _condition(name) for name in FACTORS},
        "style": lambda item: item.style,
        "posture": lambda item: item.posture,
    }
    sizes = [_size(low) for low in _SIZES_PX]
    order = {
        "distance": [f"{distance_m:g} m" for distance_m in study.distances_m],
        "size": sizes,
        **FACTORS,
        "style": ("beside", "straight", "low"),
        "posture": ("sits", "stands"),
    }
    answer = {}
    for name, level_of in factors.items():
        rows = [
            recall_of(level, [item for item in study.episodes if level_of(item) == level])
            for level in order[name]
        ]
        answer[name] = [row for row in rows if row.total]
    return answer


def false_rate(minutes: Sequence[Minute]) -> FalseRate:
    """False raises in an hour of the camera."""
    count = sum(len(minute.false_raises) for minute in minutes)
    return _rate("nobody calls", count, len(minutes) / 60.0)


def false_rate_by_activity(minutes: Sequence[Minute]) -> list[FalseRate]:
    """False raises in an hour of one person who does one thing."""
    doing = [what for minute in minutes for what, _ in minute.people]
    false = [item.what for minute in minutes for item in minute.false_raises]
    return [
        _rate(what, false.count(what), doing.count(what) / 60.0) for what in dict.fromkeys(doing)
    ]


def false_rate_by_distance(minutes: Sequence[Minute]) -> list[FalseRate]:
    """False raises in an hour of one person, by meters of distance."""
    places = [int(away_m) for minute in minutes for _, away_m in minute.people]
    false = [int(item.distance_m) for minute in minutes for item in minute.false_raises]
    return [
        _rate(f"{low}-{low + 1} m", false.count(low), places.count(low) / 60.0)
        for low in sorted(set(places))
    ]


def detection_as_dict(study: DetectionStudy) -> dict[str, Any]:
    """A study in plain numbers, fit for JSON; None for what was not measured."""
    return {
        "seed": study.seed,
        "distances_m": list(study.distances_m),
        "recall": _plain(recall_of("all", study.episodes)),
        "recall_by": {
            name: [_plain(row) for row in rows] for name, rows in recall_by_factor(study).items()
        },
        "false_raises": _plain(false_rate(study.minutes)),
        "false_raises_by": {
            "activity": [_plain(row) for row in false_rate_by_activity(study.minutes)],
            "distance": [_plain(row) for row in false_rate_by_distance(study.minutes)],
        },
        "false_raises_beside_callers": sum(item.score.false_raises for item in study.episodes),
        "parameters": study.config.model_dump(),
    }


def _condition(name: str) -> Callable[[Episode], str]:
    return lambda item: str(getattr(item.conditions, name))


def _size(hand_px: float) -> str:
    row = int(np.searchsorted(_SIZES_PX, hand_px, side="right")) - 1
    low = _SIZES_PX[row]
    if row == 0:
        return f"< {_SIZES_PX[1]} px"
    return f">= {low} px" if row == len(_SIZES_PX) - 1 else f"{low}-{_SIZES_PX[row + 1]} px"


def _rate(level: str, count: int, hours: float) -> FalseRate:
    per_hour = count / hours if hours else float("nan")
    return FalseRate(level, count, hours, per_hour, *poisson_interval(count, hours))


def _plain(row: Recall | FalseRate) -> dict[str, Any]:
    return {
        name: None if isinstance(value, float) and np.isnan(value) else value
        for name, value in asdict(row).items()
    }
