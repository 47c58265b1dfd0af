"""What the tracker did in each round of association."""

import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.evaluation.metrics.rounds import rounds_of
from tracker.tracking.association.gating import find_pairs
from tracker.tracking.people import TAG, room_for
from tracker.tracking.prediction.modes import merge_modes
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.settings import settings_of
from tracker.tracking.trace import NO_TRACE, Trace, Watched

PERIOD_NS = 100_000_000
PLAIN = Config(motion="cv", association="hungarian", outlier_dof=0.0)


def watched(frames, config=PLAIN):
    """Rounds of some frames, and the tracks after each."""
    rounds = []
    tracker = PersonTracker(config, watch=lambda frame: rounds.extend(rounds_of(frame)))
    tracks = [tracker.step(number * PERIOD_NS, each) for number, each in enumerate(frames)]
    return rounds, tracks


def hand(bearing_rad, range_m):
    return Measurements.polar([bearing_rad], [range_m], 0.05, 0.08)


def test_each_sensor_has_a_round_raised_hands_first():
    scan = Measurements.polar([0.0, 1.0], 2.0, 0.02, 0.02, (0.1, 0.0, 0.0), raised=False)
    rounds, _ = watched([Measurements.concatenate(scan, hand(0.0, 2.0))] * 2)
    assert [item.stamp_ns for item in rounds] == [0, 0, PERIOD_NS, PERIOD_NS]
    assert [item.rows.tolist() for item in rounds] == [[2], [0, 1]] * 2
    assert [len(item.claims.kind) for item in rounds] == [3] * 4


def test_a_frame_in_which_nothing_is_measured_has_no_round():
    rounds, _ = watched([hand(0.0, 2.0), Measurements.none(), hand(0.0, 2.0)])
    assert [item.stamp_ns for item in rounds] == [0, 2 * PERIOD_NS]


def test_a_round_in_which_nobody_is_there_has_no_pairs():
    rounds, _ = watched([hand(0.0, 2.0)])
    assert len(rounds[0].existence) == len(rounds[0].track) == len(rounds[0].is_chosen) == 0


def test_identities_are_those_of_everybody_before_the_frame():
    rounds, tracks = watched([hand(0.0, 2.0)] * 3)
    assert [item.id.tolist() for item in rounds] == [[], [1], [1]]
    assert tracks[-1].id.tolist() == [1]


@pytest.mark.parametrize("motion", ["cv", "imm"])
def test_a_round_s_pairs_are_those_of_what_was_predicted(motion):
    config = Config(motion=motion, association="hungarian")
    hands = Measurements.polar([0.0, 0.02, 0.7], [2.0, np.nan, 3.0], 0.05, 0.08)
    rounds, _ = watched([hands[[0, 2]], hands[[0, 2]], hands], config)
    last = rounds[-1]
    people = room_for(*last.mean.shape[:2], 5)
    for array, found in zip(people, (last.weight, last.mean, last.covariance), strict=False):
        array[:] = found
    people.counts[TAG] = -1
    assert len(last.id) == 2
    assert last.chance == pytest.approx([config.detection_probability] * 2)
    mean, covariance = np.empty((2, 4)), np.empty((2, 4, 4))
    merge_modes(*people[:3], mean, covariance)
    pairs = find_pairs(
        *(people, mean[None], covariance[None], last.claims),
        *(np.argsort(last.claims.kind, kind="stable"), last.chance, np.zeros((0, 0))),
        *(config.newcomer_density, settings_of(config)),
    )
    assert last.track.tolist() == pairs.track.tolist()
    assert last.claim.tolist() == pairs.claim.tolist()
    np.testing.assert_allclose(last.log_likelihood, pairs.log_likelihood, rtol=1e-9)
    np.testing.assert_allclose(last.log_newcomer, pairs.log_newcomer, rtol=1e-9)


def test_what_the_assignment_takes_is_what_moves_the_tracks():
    rounds, tracks = watched([hand(0.0, 2.0), hand(0.0, 2.0), hand(0.02, 2.05)])
    last = rounds[-1]
    assert last.is_chosen.tolist() == [True]
    assert (tracks[-1].mean[0] != last.mean[0, 0]).any()
    assert tracks[-1].existence[0] > last.existence[0]


def test_where_nobody_watches_there_is_nothing_to_read():
    people = room_for(1, 3, 5)
    claims = claims_of(hand(0.0, 2.0))
    for trace in (NO_TRACE, Trace.room(1, 1, 3)):
        assert list(rounds_of(Watched(0, people, claims, trace, PLAIN))) == []
