"""Who becomes a customer, and who is gone? Raised, exists and fresh stay three things.

A hand that is not up says nothing about whether its owner is there: only time in which neither
hand nor scan shows somebody, although in view, lets existence fade and ends a track.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray
from tracker.tracking.modes import Belief
from tracker.tracking.people import People

#: One newcomer in two is somebody (guess).
BIRTH_EXISTENCE = 0.5
#: Existence below which nobody is believed in any more.
EXISTENCE_MIN = 0.05
#: One frame makes nobody more than so much likelier: its errors have a common cause.
LOG_EVIDENCE_MAX = float(np.log(100.0))


def believe(existence: FloatArray, log_evidence: FloatArray) -> FloatArray:
    """Bayes' rule on existence, in odds.

    Args:
        existence: Shape (N,).
        log_evidence: Shape (N,): how much likelier this frame's measurement is with the person
            than without, logarithm; 0 where nothing was measured. Less than 0 counts as 0: what is
            assigned to somebody is no evidence against them.
    """
    evidence = np.exp(np.minimum(np.maximum(log_evidence, 0.0), LOG_EVIDENCE_MAX))
    odds = existence / (1.0 - existence) * evidence
    return np.asarray(np.minimum(odds / (1.0 + odds), 1.0 - 1e-6))


def count_detections(
    people: People,
    is_called: BoolArray,
    is_seen: BoolArray,
    stamp_ns: int,
    config: Config,
    **changes: Any,
) -> People:
    """Take note of one frame: streaks, M-of-N window, freshness, who is a customer.

    A missed hand lowers nothing but the streak: people put their hands down and stay.

    Args:
        people: Everybody, after the update.
        is_called: Shape (N,): a raised hand was assigned.
        is_seen: Shape (N,): any measurement was assigned.
        stamp_ns: This frame's.
        config: The tracking group.
        changes: Other arrays of `People` that this frame has changed.
    """
    existence = changes.get("existence", people.existence)
    streaks = people.streaks.step(is_called, config.raise_streak, config.lower_streak)
    rising = streaks.raised & ~people.streaks.raised
    recent = np.empty_like(people.recent)
    recent[:, 0], recent[:, 1:] = is_called, people.recent[:, :-1]
    if config.confirmation == "m_of_n":
        convinced = recent.sum(axis=1) >= config.confirm_detections
    else:
        convinced = is_called & (existence >= config.confirm_existence)
    return people.replace(
        streaks=streaks,
        recent=recent,
        detections=people.detections + is_called,
        confirmed=people.confirmed | convinced,
        raised_since_ns=np.where(rising, stamp_ns, people.raised_since_ns),
        seen_ns=np.where(is_seen, stamp_ns, people.seen_ns),
        called_ns=np.where(is_called, stamp_ns, people.called_ns),
        missing_s=people.missing_s * ~is_seen,
        **changes,
    )


def fade(
    people: People, belief: Belief, dt_s: float, visible: FloatArray, config: Config
) -> People:
    """Between frames people may leave, and only where they would be seen does silence tell.

    Args:
        people: Everybody.
        belief: Where they are by now.
        dt_s: Since the last frame.
        visible: Shape (N,), in [0, 1], from `view.visibility`.
        config: Existence fades with `delete_after_s` as its time constant.
    """
    lapse_s = dt_s * visible
    return people.replace(
        belief=belief,
        existence=people.existence * np.exp(-lapse_s / config.delete_after_s),
        missing_s=people.missing_s + lapse_s,
    )


def still_there(people: People, stamp_ns: int, config: Config) -> BoolArray:
    """Shape (N,): whom to keep.

    A tentative track goes as soon as it cannot be confirmed within its window any more; a
    confirmed one once nothing has shown it for `delete_after_s`, sooner while it has few
    detections, or once no hand has been up for `forget_after_s`. A bystander is remembered for as
    long as it has been seen before, and no longer than a customer.
    """
    patience_s = config.delete_after_s * np.minimum(
        people.detections / config.mature_detections, 1.0
    )
    # A nanosecond for the sum of the lapses.
    alive = (people.missing_s <= patience_s + 1e-9) & (
        people.called_ns >= stamp_ns - round(config.forget_after_s * 1e9)
    )
    known_s = (people.seen_ns - people.born_ns) / 1e9
    remembered = people.missing_s <= np.minimum(known_s, config.delete_after_s) + 1e-9
    alive = np.where(people.is_customer, alive, remembered)
    if (people.confirmed | ~people.is_customer).all():
        return alive
    if config.confirmation == "m_of_n":
        hopeful = _may_be_confirmed(people.recent, config)
    else:
        hopeful = alive & (people.existence >= EXISTENCE_MIN)
    return np.where(people.confirmed | ~people.is_customer, alive, hopeful)


def _may_be_confirmed(recent: BoolArray, config: Config) -> BoolArray:
    window = config.confirm_window
    fresh = np.arange(1, window)  # if the next so many frames all were detections ...
    kept = np.cumsum(recent, axis=1)[:, window - 1 - fresh]  # ... these would still count
    return np.asarray(((kept >= 1) & (kept + fresh >= config.confirm_detections)).any(axis=1))
