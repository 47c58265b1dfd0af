"""What does one instant tell of everybody known? Predict, associate, correct, count.

Whoever is new, gone or tracked twice is left to `renewal`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray, Measurements
from tracker.tracking.admission import once_per_person, usable, with_hand_bias
from tracker.tracking.association import assign, log_odds
from tracker.tracking.gating import Pairs, find_pairs
from tracker.tracking.innovations import Round, Watch
from tracker.tracking.joint_probability import marginals
from tracker.tracking.life_cycle import believe, count_detections, fade
from tracker.tracking.modes import Belief, predict_modes
from tracker.tracking.motion import motion_over
from tracker.tracking.people import People
from tracker.tracking.posterior import update_assigned, update_jointly
from tracker.tracking.view import View, visibility

#: Of a raised hand, the chance that one counts whose owner had it down in the last frame (guess).
RAISES_AGAIN = 0.5
#: Nobody is ever certain to be detected, or certain not to be.
DETECTION_MIN = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class Observed:
    """Everybody after one instant.

    Attributes:
        people: The same N people, corrected and counted.
        is_called: Shape (N,): a raised hand was theirs.
        is_seen: Shape (N,): any measurement was theirs.
        raised: Raised hands, once per person, that are nobody's.
        others: Other measurements that are nobody's.
    """

    people: People
    is_called: BoolArray
    is_seen: BoolArray
    raised: Measurements
    others: Measurements


def observe(
    people: People,
    measurements: Measurements,
    dt_s: float,
    stamp_ns: int,
    config: Config,
    view: View | None,
    scan_view: View | None,
    watch: Watch | None = None,
) -> Observed:
    """Carry everybody over the interval, and correct them by what was measured.

    Args:
        people: N people, after the last frame.
        measurements: M claims; those that no filter can live with are passed over.
        dt_s: Since the last frame.
        stamp_ns: This frame's.
        config: The tracking group.
        view: Where the camera could see hands; None means everywhere.
        scan_view: Where the scan could show people; None where there is no scan.
        watch: Told of both rounds of association, raised hands first.
    """
    tell = None if watch is None else _teller(watch, stamp_ns, people, config)
    people, in_camera, in_view = _predict(people, dt_s, config, view, scan_view)
    raised, others = _admit(measurements, people, dt_s, config)
    hand_chance = np.where(people.streaks.missed == 0, 1.0, RAISES_AGAIN)
    belief, existence, called_by = _update(
        people.belief,
        people.existence,
        raised,
        in_camera * hand_chance,
        config,
        tell,
    )
    belief, existence, shown_by = _update(belief, existence, others, in_view, config, tell)
    is_called, is_shown = called_by >= 0, shown_by >= 0
    is_seen = is_called | is_shown
    hand = np.full(len(people), -1, dtype=np.int64)
    hand[is_shown] = others.hand[shown_by[is_shown]]
    hand[is_called] = raised.hand[called_by[is_called]]
    people = count_detections(
        people,
        is_called,
        is_seen,
        stamp_ns,
        config,
        belief=belief,
        existence=existence,
        hand=hand,
    )
    return Observed(
        people=people,
        is_called=is_called,
        is_seen=is_seen,
        raised=_left(raised, called_by),
        others=_left(others, shown_by),
    )


def _admit(
    measurements: Measurements, people: People, dt_s: float, config: Config
) -> tuple[Measurements, Measurements]:
    """Raised hands, one per person, and everything else."""
    sane = usable(measurements)
    if not sane.all():
        measurements = measurements[sane]
    raised, others = measurements, NO_MEASUREMENTS
    if not measurements.raised.all():
        raised, others = measurements[measurements.raised], measurements[~measurements.raised]
    callers_m = people.belief.merged()[0][people.raised, :2]
    raised = once_per_person(raised, callers_m, config)
    return with_hand_bias(raised, dt_s, config), others


def _predict(
    people: People, dt_s: float, config: Config, view: View | None, scan_view: View | None
) -> tuple[People, FloatArray, FloatArray]:
    """Everybody at this instant; visible to the camera, and to anything."""
    belief = predict_modes(people.belief, motion_over(dt_s, config))
    belief = replace(belief, known=belief.merged())  # asked for by the views, hands and gates
    in_camera = np.ones(len(people))
    if view is not None or scan_view is not None:
        xy_m = belief.merged()[0][:, :2]
        in_camera = visibility(xy_m, view)
    in_view = in_camera
    if scan_view is not None:
        in_view = np.maximum(in_camera, visibility(xy_m, scan_view))
    return fade(people, belief, dt_s, in_view, config), in_camera, in_view


def _update(
    belief: Belief,
    existence: FloatArray,
    claims: Measurements,
    visible: FloatArray,
    config: Config,
    tell: Callable[..., None] | None,
) -> tuple[Belief, FloatArray, IntArray]:
    """Associate and correct; also says which measurement each track got, or -1."""
    got = np.full(len(existence), -1, dtype=np.int64)
    chance = np.maximum(visible * config.detection_probability, DETECTION_MIN)
    if len(existence) == 0 or len(claims) == 0:
        if tell is not None:
            nothing = Pairs.join([], len(belief.weight))
            tell(belief, existence, chance, claims, nothing, nothing.track)
        return belief, existence, got
    pairs = find_pairs(belief, claims, config)
    odds = log_odds(pairs, belief.weight, chance)
    chosen = assign(pairs, odds, len(existence))
    rows = np.flatnonzero(chosen >= 0)
    hits = chosen[rows]
    if tell is not None:
        tell(belief, existence, chance, claims, pairs, hits)
    if config.association == "jpda":
        belief = update_jointly(belief, pairs, marginals(pairs.track, pairs.claim, odds))
    else:
        belief = update_assigned(belief, pairs if len(hits) == len(pairs) else pairs[hits])
    got[rows] = pairs.claim[hits]
    evidence = np.zeros(len(existence))
    evidence[rows] = odds[hits] + np.log(1.0 - chance[rows])
    return belief, believe(existence, evidence), got


def _teller(watch: Watch, stamp_ns: int, people: People, config: Config) -> Callable[..., None]:
    def tell(
        belief: Belief,
        existence: FloatArray,
        chance: FloatArray,
        claims: Measurements,
        pairs: Pairs,
        chosen: IntArray,
    ) -> None:
        watch(Round(stamp_ns, people.id, belief, existence, chance, claims, pairs, chosen, config))

    return tell


def _left(claims: Measurements, taken: IntArray) -> Measurements:
    is_left = np.ones(len(claims), dtype=bool)
    is_left[taken[taken >= 0]] = False
    return claims[is_left] if is_left.any() else NO_MEASUREMENTS


NO_MEASUREMENTS = Measurements.none()
