"""Who becomes a customer, and who is gone? Raised, exists and fresh stay three things."""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray
from tracker.tracking.people import People

#: Before its first detection is counted; after it, one newcomer in two is somebody (guess).
BIRTH_EXISTENCE = 0.1
#: How much likelier a measurement inside the gate is from the person than from clutter (guess).
_EVIDENCE = 9.0


def count_detections(
    people: People, is_called: BoolArray, is_seen: BoolArray, stamp_ns: int, config: Config
) -> People:
    """Take note of one frame: streaks, M-of-N window, existence, freshness.

    A missed hand lowers nothing but the streak: people put their hands down and stay.

    Args:
        people: Everybody, after the update.
        is_called: Shape (N,): a raised hand was assigned.
        is_seen: Shape (N,): any measurement was assigned.
        stamp_ns: This frame's.
        config: The tracking group.
    """
    streaks = people.streaks.step(is_called, config.raise_streak, config.lower_streak)
    rising = streaks.raised & ~people.streaks.raised
    recent = np.concatenate([is_called[:, None], people.recent[:, :-1]], axis=1)
    odds = people.existence / np.maximum(1.0 - people.existence, 1e-12)
    odds = np.where(is_seen, odds * _EVIDENCE, odds)
    return people.replace(
        streaks=streaks,
        recent=recent,
        confirmed=people.confirmed | (recent.sum(axis=1) >= config.confirm_detections),
        existence=np.minimum(odds / (1.0 + odds), 1.0 - 1e-6),
        raised_since_ns=np.where(rising, stamp_ns, people.raised_since_ns),
        seen_ns=np.where(is_seen, stamp_ns, people.seen_ns),
        called_ns=np.where(is_called, stamp_ns, people.called_ns),
    )


def fade_existence(people: People, dt_s: float, config: Config) -> People:
    """Between frames people may leave: existence fades with `delete_after_s` as time constant."""
    return people.replace(existence=people.existence * np.exp(-dt_s / config.delete_after_s))


def still_there(people: People, stamp_ns: int, config: Config) -> BoolArray:
    """Shape (N,): whom to keep.

    A tentative track goes as soon as it cannot be confirmed within its window any more; a
    confirmed one once nothing has shown it for `delete_after_s`, or no hand for `forget_after_s`.
    """
    window = config.confirm_window
    fresh = np.arange(1, window)  # if the next so many frames all were detections ...
    kept = np.cumsum(people.recent, axis=1)[:, window - 1 - fresh]  # ... these would still count
    hopeful = ((kept >= 1) & (kept + fresh >= config.confirm_detections)).any(axis=1)
    unseen_s = (stamp_ns - people.seen_ns) / 1e9
    uncalled_s = (stamp_ns - people.called_ns) / 1e9
    alive = (unseen_s <= config.delete_after_s) & (uncalled_s <= config.forget_after_s)
    return np.where(people.confirmed, alive, hopeful)
