from collections import Counter

import numpy as np
import pytest

from tracker.evaluation.metrics.identity import identity_switches, track_purity


def random_pairs(rng, frames=40, people=4):
    """Everybody paired in every frame, with tracks that change hands now and then."""
    tracks, pairs = np.arange(people), []
    for frame in range(frames):
        if rng.random() < 0.3:
            rng.shuffle(tracks)
        if rng.random() < 0.1:
            tracks[rng.integers(people)] = tracks.max() + 1
        pairs += [(frame, person, int(track)) for person, track in enumerate(tracks)]
    return np.array(pairs).T


def test_switches_equal_the_mismatches_of_stone_soup_s_mota(stonesoup, at):
    from stonesoup.measures import Euclidean
    from stonesoup.metricgenerator.clearmotmetrics import ClearMotMetrics
    from stonesoup.metricgenerator.manager import MultiManager
    from stonesoup.types.association import AssociationSet, TimeRangeAssociation
    from stonesoup.types.groundtruth import GroundTruthPath, GroundTruthState
    from stonesoup.types.state import State
    from stonesoup.types.time import TimeRange
    from stonesoup.types.track import Track

    rng = np.random.default_rng(3)
    for _ in range(5):
        frame, person, track = random_pairs(rng)
        truths = {
            key: GroundTruthPath(
                [GroundTruthState([0.0, 0.0], at(int(t))) for t in frame[person == key]]
            )
            for key in np.unique(person)
        }
        tracks = {
            key: Track([State([0.0, 0.0], at(int(t))) for t in frame[track == key]])
            for key in np.unique(track)
        }
        associations = {
            TimeRangeAssociation([truths[p], tracks[k]], TimeRange(at(int(t)), at(t + 0.5)))
            for t, p, k in zip(frame, person, track, strict=True)
        }
        generator = ClearMotMetrics(distance_measure=Euclidean((0, 1)))
        manager = MultiManager([generator])
        manager.add_data(
            {"groundtruth_paths": set(truths.values()), "tracks": set(tracks.values())}
        )
        manager.association_set = AssociationSet(associations)
        _, mota = generator.compute_metric(manager)
        mismatches = round((1.0 - mota.value) * len(frame))
        assert identity_switches(person, track) == mismatches
        assert mismatches > 0


def test_a_switch_behind_a_gap_counts_once():
    person = np.array([1, 2, 2, 1, 1])
    track = np.array([7, 8, 8, 9, 9])
    assert identity_switches(person, track) == 1


def test_purity_is_what_counting_by_hand_gives():
    rng = np.random.default_rng(4)
    for _ in range(10):
        _, person, track = random_pairs(rng)
        counts = {key: Counter(person[track == key].tolist()) for key in set(track.tolist())}
        most = sum(count.most_common(1)[0][1] for count in counts.values())
        assert track_purity(person, track) == pytest.approx(most / len(track))


def test_without_pairs_nothing_switches_and_nothing_is_pure():
    nothing = np.zeros(0, dtype=np.int64)
    assert identity_switches(nothing, nothing) == 0
    assert np.isnan(track_purity(nothing, nothing))
