"""Who becomes a customer, and who is deleted? Raised, existing and fresh are kept apart.

A hand that is not up says nothing about whether its owner is there: only time in which neither
hand nor scan shows somebody, although in view, lets existence fade and ends a track.
"""

from __future__ import annotations

import numpy as np

from tracker.compiling.loops import loop
from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.tracking import people as field
from tracker.tracking.association.gating import Pairs
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.streaks import step_streak
from tracker.tracking.people import People
from tracker.tracking.settings import Settings

#: One newcomer in two is somebody (guess).
BIRTH_EXISTENCE = 0.5
#: Existence below which nobody is believed in any more.
EXISTENCE_MIN = 0.05
#: One frame makes nobody more than so much likelier: its errors have a common cause.
LOG_EVIDENCE_MAX = float(np.log(100.0))
#: With such a standard deviation somebody's place is unknown, as after a dozen seconds (guess).
LOST_STD_M = 12.0
#: A nanosecond, for the sum of many lapses.
_LAPSE_S = 1e-9


@loop
def fade(
    people: People,
    covariance: FloatArray,
    dt_s: float,
    in_view: FloatArray,
    delete_after_s: float,
) -> None:
    """Lower existence: people may leave between frames, or are not seen though in view.

    Whoever might be anywhere by now is as good as gone, seen or not.

    Args:
        people: N; changed in place.
        covariance: Shape (1, N, 4, 4): over the modes, predicted.
        dt_s: Since the last frame.
        in_view: Shape (N,): chance that nothing kept them from being seen.
        delete_after_s: Existence fades with that time constant.
    """
    for person in range(len(in_view)):
        variance_m2 = (covariance[0, person, 0, 0] + covariance[0, person, 1, 1]) / 2.0
        lost = min(variance_m2 / LOST_STD_M**2, 1.0)
        lapse_s = dt_s * max(in_view[person], lost)
        people.spans[field.EXISTENCE, person] *= np.exp(-lapse_s / delete_after_s)
        people.spans[field.MISSING_S, person] += lapse_s


@loop
def believe(people: People, chosen: IntArray, pairs: Pairs, chance: FloatArray) -> None:
    """Bayes' rule on existence, in odds, in place.

    How much likelier a measurement is with the person than without counts for them; what is
    assigned to somebody is never evidence against them.

    Args:
        people: N tracks.
        chosen: Shape (N,): row of each one's pair, or -1.
        pairs: P pairs.
        chance: Shape (N,): of being detected.
    """
    existence = people.spans[field.EXISTENCE]
    for person in range(len(chosen)):
        evidence = 0.0
        if chosen[person] >= 0:
            evidence = pairs.log_odds[chosen[person]] + np.log(1.0 - chance[person])
        odds = np.exp(min(max(evidence, 0.0), LOG_EVIDENCE_MAX))
        odds *= existence[person] / (1.0 - existence[person])
        existence[person] = min(odds / (1.0 + odds), 1.0 - 1e-6)


@loop
def count_person(
    people: People,
    person: int,
    is_called: bool,
    certainty: float,
    instant: Instant,
    settings: Settings,
) -> None:
    """Take note of one frame, in place: streaks, M-of-N window, freshness, who is a customer.

    A missed hand lowers nothing but the streak: people put their hands down and stay.

    Args:
        people: Everybody, with the existence after this frame.
        person: Who counts.
        is_called: A raised hand was assigned to them.
        certainty: How probably the measurement that was assigned to them is theirs; 0 for none.
        instant: When it is; where no image was looked at, only hands that were seen count.
        settings: Of the tracker.
    """
    if instant.camera_looked or is_called:
        _count_image(people, person, is_called, instant.stamp_ns, settings)
    if certainty > 0.0:
        people.counts[field.SEEN_NS, person] = instant.stamp_ns
        # What may well be somebody else's does not end a silence.
        people.spans[field.MISSING_S, person] *= 1.0 - certainty
    if _is_convincing(people, person, is_called, settings):
        people.flags[field.CONFIRMED, person] = True


@loop
def _count_image(
    people: People, person: int, is_called: bool, stamp_ns: int, settings: Settings
) -> None:
    """One image more in which somebody's hand was up, or not."""
    counts, flags, recent = people.counts, people.flags, people.recent
    for age in range(recent.shape[1] - 1, 0, -1):
        recent[person, age] = recent[person, age - 1]
    recent[person, 0] = is_called
    was_raised = flags[field.RAISED, person]
    step_streak(counts, flags, person, is_called, settings.raise_streak, settings.lower_streak)
    if is_called:
        counts[field.DETECTIONS, person] += 1
        counts[field.CALLED_NS, person] = stamp_ns
    if flags[field.RAISED, person] and not was_raised:
        counts[field.RAISED_SINCE_NS, person] = stamp_ns


@loop
def _is_convincing(people: People, person: int, is_called: bool, settings: Settings) -> bool:
    if settings.confirms_by_existence > 0.0:
        return is_called and people.spans[field.EXISTENCE, person] >= settings.confirm_existence
    detections = 0
    for age in range(people.recent.shape[1]):
        detections += people.recent[person, age]
    return detections >= settings.confirm_detections


@loop
def is_still_there(people: People, person: int, stamp_ns: int, settings: Settings) -> bool:
    """Whether to keep somebody.

    A tentative track goes as soon as it cannot be confirmed within its window any more; a
    confirmed one once nothing has shown it for `delete_after_s`, sooner while it has few
    detections, or once no hand has been up for `forget_after_s`. A bystander is remembered for as
    long as it has been seen before, and no longer than a customer.
    """
    counts, missing_s = people.counts, people.spans[field.MISSING_S, person]
    if counts[field.ID, person] <= 0:
        known_s = (counts[field.SEEN_NS, person] - counts[field.BORN_NS, person]) / 1e9
        return missing_s <= min(known_s, settings.delete_after_s) + _LAPSE_S
    if not people.flags[field.CONFIRMED, person] and settings.confirms_by_existence == 0.0:
        return _may_be_confirmed(people.recent, person, settings.confirm_detections)
    maturity = min(counts[field.DETECTIONS, person] / settings.mature_detections, 1.0)
    is_alive = missing_s <= settings.delete_after_s * maturity + _LAPSE_S
    unheard_s = (stamp_ns - counts[field.CALLED_NS, person]) / 1e9
    is_alive = is_alive and unheard_s <= settings.forget_after_s + _LAPSE_S
    is_hopeful = people.spans[field.EXISTENCE, person] >= EXISTENCE_MIN
    return is_alive and (people.flags[field.CONFIRMED, person] or is_hopeful)


@loop
def _may_be_confirmed(recent: BoolArray, person: int, needed: float) -> bool:
    """Whether raised hands in all images to come would still make a customer."""
    window = recent.shape[1]
    for fresh in range(1, window):
        kept = 0
        for age in range(window - fresh):
            kept += recent[person, age]
        if kept >= 1 and kept + fresh >= needed:
            return True
    return False
