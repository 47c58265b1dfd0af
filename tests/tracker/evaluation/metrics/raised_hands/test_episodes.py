import json
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from tracker.containers import FrameResult, Hands, Measurements, Tracks, Truth
from tracker.evaluation.metrics.raised_hands.episodes import EpisodeEvaluation, EpisodeReport

START_NS = 1_000_000_000_000
FRAME_NS = 100_000_000
TRUTH_NS = 20_000_000

# Who stands where with the hand up or not, at a frame: {person: (x, y, is_up)}.
World = Callable[[int], dict[int, tuple[float, float, bool]]]


def result_at(frame: int, tracks: dict[int, tuple[float, float, bool]]) -> FrameResult:
    count = len(tracks)
    values = np.array(list(tracks.values()), dtype=float).reshape(-1, 3)
    stamp_ns = START_NS + frame * FRAME_NS
    return FrameResult(
        stamp_ns=stamp_ns, hands=Hands.none(), measurements=Measurements.none(),
        tracks=Tracks(
            stamp_ns=stamp_ns, id=np.array(list(tracks)),
            mean=np.hstack([values[:, :2], np.zeros((count, 2))]),
            covariance=np.tile(np.eye(4), (count, 1, 1)), existence=np.ones(count),
            confirmed=np.ones(count), raised=values[:, 2], raised_since_ns=np.zeros(count),
            age_s=np.zeros(count), unseen_s=np.zeros(count), hand=np.full(count, -1),
        ),
        hand_raised=bool(values[:, 2].any()), customer_pose=None, approach_pose=None,
        sensor_pose=None, scan=None,
    )  # fmt: skip


def truth_of(world: World, frames: int, *, in_view: bool = True) -> Iterator[Truth]:
    for step in range(frames * FRAME_NS // TRUTH_NS):
        people = world(step * TRUTH_NS // FRAME_NS)
        values = np.array(list(people.values()), dtype=float)
        up = values[:, 2].astype(bool)
        yield Truth(
            START_NS + step * TRUTH_NS, np.array(list(people)), values[:, :2], up,
            np.full(len(people), in_view),
        )  # fmt: skip


def evaluate(world: World, tracks: World, frames: int, **settings) -> EpisodeReport:
    """Truth runs five times as fast as the images, and both come in the order of their stamps."""
    evaluation = EpisodeEvaluation(**settings)
    for step, truth in enumerate(truth_of(world, frames)):
        evaluation.add_truth(truth)
        if step % 5 == 0:
            evaluation.add_result(result_at(step // 5, tracks(step // 5)))
    return evaluation.report()


def test_a_hand_reported_at_its_third_image_has_a_delay_of_three_images():
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 10 <= k < 30)},
        lambda k: {3: (1.1, 0.0, 12 <= k < 32)} if k >= 11 else {},
        50,
    )
    (row,) = report.episodes
    assert (row.person, row.identities, row.frames) == (7, (3,), 20)
    assert row.delay_s == pytest.approx(0.2)
    assert row.reported_frames == 3
    assert row.position_error_m == pytest.approx(0.1)
    assert report.seconds(row.start_ns) == pytest.approx(1.0)
    assert not report.missed
    assert not report.invented


def test_the_position_error_is_the_median_over_the_reported_images():
    offsets = [0.05, 0.1, 0.6]
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 10 <= k < 13)},
        lambda k: {3: (1.0, offsets[min(max(k - 10, 0), 2)], 10 <= k < 13)},
        20,
    )
    assert report.episodes[0].position_error_m == pytest.approx(0.1)
    assert report.position_error_m == pytest.approx(0.1)


def test_an_unreported_hand_is_missed():
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 10 <= k < 30)}, lambda k: {3: (1.0, 0.0, False)}, 50
    )
    assert [row.person for row in report.missed] == [7]
    assert report.episodes[0].reported_frames is None
    assert report.episodes[0].position_error_m is None
    assert report.position_error_m is None


def test_a_hand_reported_more_than_a_meter_away_is_missed_and_the_report_invented():
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 10 <= k < 30)}, lambda k: {3: (2.1, 0.0, 12 <= k < 32)}, 50
    )
    assert len(report.missed) == 1
    (row,) = report.invented
    assert (row.identity, row.person) == (3, None)
    assert report.seconds(row.start_ns) == pytest.approx(1.2)
    assert report.seconds(row.end_ns) == pytest.approx(3.1)


def test_a_hand_up_for_less_images_than_the_streak_is_too_short_to_be_missed():
    report = evaluate(lambda k: {7: (1.0, 0.0, k == 10)}, lambda k: {}, 20)
    assert report.too_short == 1
    assert not report.episodes


def test_a_raised_track_of_a_person_whose_hand_is_down_is_invented():
    report = evaluate(
        lambda k: {7: (1.0, 0.0, False)}, lambda k: {3: (1.0, 0.0, 20 <= k < 23)}, 50
    )
    (row,) = report.invented
    assert (row.identity, row.person) == (3, 7)
    assert not report.episodes
    assert not report.identities


def test_a_track_still_raised_at_the_end_without_a_hand_is_invented():
    report = evaluate(lambda k: {7: (1.0, 0.0, False)}, lambda k: {3: (1.0, 0.0, k > 40)}, 50)
    assert len(report.invented) == 1


@pytest.mark.parametrize(
    ("lowered_at", "invented"),
    [(34, 0), (37, 0), (38, 1), (45, 1)],
    ids=["in time", "at the last moment", "one image late", "far too late"],
)
def test_a_track_may_stay_raised_for_the_transition_and_the_lower_streak(lowered_at, invented):
    # Up until image 29. Half a second (until 34) the arm falls; 35 and 36 are misses, the third,
    # 37, must lower it.
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 10 <= k < 30)},
        lambda k: {3: (1.0, 0.0, 12 <= k < lowered_at)},
        60,
    )
    assert len(report.invented) == invented
    assert not report.missed


@pytest.mark.parametrize(("early", "invented"), [(5, 0), (6, 1)], ids=["rising arm", "too early"])
def test_a_track_raised_while_the_arm_rises_is_not_invented(early, invented):
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 20 <= k < 40)},
        lambda k: {3: (1.0, 0.0, 20 - early <= k < 40)},
        60,
    )
    assert len(report.invented) == invented
    assert report.episodes[0].reported_frames == 1
    assert report.episodes[0].delay_s == 0.0


def test_a_second_raised_track_for_the_same_hand_is_invented():
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 10 <= k < 30)},
        lambda k: {3: (1.0, 0.0, 12 <= k < 32), 4: (1.4, 0.0, 12 <= k < 32)},
        50,
    )
    assert [row.identity for row in report.invented] == [4]
    assert report.identities == {7: (3,)}


def test_a_new_identity_in_the_middle_of_an_episode_is_a_switch():
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 10 <= k < 40)},
        lambda k: {3 if k < 25 else 9: (1.0, 0.0, 12 <= k < 42)},
        60,
    )
    assert report.identities == {7: (3, 9)}
    assert report.identity_switches == 1
    assert report.episodes[0].identities == (3, 9)


def test_two_hands_at_once_keep_their_own_identities():
    report = evaluate(
        lambda k: {7: (1.0, 0.4, 10 <= k < 40), 8: (1.0, -0.4, 20 <= k < 45)},
        lambda k: {3: (1.1, 0.4, 12 <= k < 42), 4: (1.1, -0.4, 22 <= k < 47)},
        60,
    )
    assert [(row.person, row.identities, row.reported_frames) for row in report.episodes] == [
        (7, (3,), 3),
        (8, (4,), 3),
    ]
    assert report.identity_switches == 0
    assert not report.invented


def test_swapped_tracks_are_a_switch_for_either_person():
    def tracks(frame):
        first, second = ((1.0, 0.5), (1.0, -0.5))
        if frame >= 25:
            first, second = second, first
        return {3: (*first, 12 <= frame < 42), 4: (*second, 12 <= frame < 42)}

    report = evaluate(
        lambda k: {7: (1.0, 0.5, 10 <= k < 40), 8: (1.0, -0.5, 10 <= k < 40)}, tracks, 60
    )
    assert report.identity_switches == 2
    assert report.identities == {7: (3, 4), 8: (4, 3)}
    assert not report.invented


def test_pairs_have_the_least_sum_of_distances_not_the_nearest_first():
    # Greedy would pair track 4 with person 7 (0.3 m) and leave the rest 0.9 m apart.
    report = evaluate(
        lambda k: {7: (0.0, 0.0, 10 <= k < 30), 8: (0.7, 0.0, 10 <= k < 30)},
        lambda k: {3: (-0.4, 0.0, 12 <= k < 32), 4: (0.3, 0.0, 12 <= k < 32)},
        50,
    )
    assert report.identities == {7: (3,), 8: (4,)}


def test_the_same_person_may_have_several_episodes_of_one_identity():
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 10 <= k < 30 or 60 <= k < 80)},
        lambda k: {3: (1.0, 0.0, 12 <= k < 32 or 61 <= k < 82)},
        100,
    )
    assert [row.reported_frames for row in report.episodes] == [3, 2]
    assert report.identities == {7: (3,)}
    assert report.identity_switches == 0


def test_a_hand_out_of_view_is_no_episode_and_its_report_is_not_invented():
    evaluation = EpisodeEvaluation()
    for truth in truth_of(lambda k: {7: (1.0, 0.0, 10 <= k < 30)}, 40, in_view=False):
        evaluation.add_truth(truth)
    for frame in range(40):
        evaluation.add_result(result_at(frame, {3: (1.0, 0.0, 12 <= frame < 32)}))
    report = evaluation.report()
    assert not report.episodes
    assert not report.invented
    assert report.identities == {7: (3,)}


@pytest.mark.parametrize("late", [0, 3, 500], ids=["in step", "results late", "all at the end"])
def test_the_report_does_not_depend_on_how_far_results_lag_behind(late):
    def world(frame):
        return {7: (1.0 + 0.01 * frame, 0.0, 10 <= frame < 30)}

    evaluation, waiting = EpisodeEvaluation(), []
    for step, truth in enumerate(truth_of(world, 50)):
        evaluation.add_truth(truth)
        if step % 5 == 0:
            x, y, _ = world(step // 5)[7]
            waiting.append(result_at(step // 5, {3: (x, y, 12 <= step // 5 < 32)}))
        if len(waiting) > late:
            evaluation.add_result(waiting.pop(0))
    for result in waiting:
        evaluation.add_result(result)
    report = evaluation.report()
    assert report.episodes[0].position_error_m == pytest.approx(0.0, abs=1e-12)
    assert report.episodes[0].reported_frames == 3
    assert report.frames == 50


def test_results_may_come_before_the_truth_of_their_time():
    evaluation = EpisodeEvaluation()
    for frame in range(50):
        evaluation.add_result(result_at(frame, {3: (1.0, 0.0, 12 <= frame < 32)}))
    for truth in truth_of(lambda k: {7: (1.0, 0.0, 10 <= k < 30)}, 50):
        evaluation.add_truth(truth)
    report = evaluation.report()
    assert report.episodes[0].reported_frames == 3
    assert report.frames == 50


def test_the_nearest_truth_sample_counts():
    evaluation = EpisodeEvaluation()
    for stamp_ns, x in ((0, 0.0), (40_000_000, 0.4)):
        evaluation.add_truth(Truth(START_NS + stamp_ns, [7], [[x, 0.0]], [True], [True]))
    result = result_at(0, {3: (0.4, 0.0, True)})
    near_second = FrameResult(
        **{
            **{name: getattr(result, name) for name in FrameResult.__slots__},
            "stamp_ns": START_NS + 21_000_000,
        }
    )
    evaluation.add_result(near_second)
    assert evaluation.report().position_error_m == pytest.approx(0.0)


def test_images_far_from_any_truth_are_counted_apart():
    evaluation = EpisodeEvaluation()
    for frame in range(5):
        evaluation.add_result(result_at(frame, {3: (1.0, 0.0, True)}))
    report = evaluation.report()
    assert (report.frames, report.frames_without_truth) == (0, 5)
    assert not report.invented


def test_memory_is_bounded_when_truth_or_results_stay_away(monkeypatch):
    monkeypatch.setattr("tracker.evaluation.metrics.raised_hands.episodes._TRUTH_BUFFERED", 50)
    monkeypatch.setattr("tracker.evaluation.metrics.raised_hands.episodes._RESULTS_BUFFERED", 20)
    evaluation = EpisodeEvaluation()
    for truth in truth_of(lambda k: {7: (1.0, 0.0, False)}, 40):
        evaluation.add_truth(truth)
    assert len(evaluation._truth) == 50
    evaluation = EpisodeEvaluation()
    for frame in range(100):
        evaluation.add_result(result_at(frame, {}))
    assert len(evaluation._results) == 20
    assert evaluation.report().frames_without_truth == 100


def test_a_clock_that_jumps_back_starts_new_episodes():
    evaluation = EpisodeEvaluation()
    for truth in truth_of(lambda k: {7: (1.0, 0.0, True)}, 5):
        evaluation.add_truth(truth)
    for truth in truth_of(lambda k: {7: (1.0, 0.0, True)}, 5):
        evaluation.add_truth(truth)
    report = evaluation.report()
    assert report.too_short == 2  # no image came at all


def test_the_report_survives_json():
    report = evaluate(
        lambda k: {7: (1.0, 0.0, 10 <= k < 30), 8: (3.0, 0.0, 10 <= k < 30)},
        lambda k: {3: (1.1, 0.0, 12 <= k < 32), 5: (9.0, 9.0, k == 40)},
        50,
    )
    there = json.loads(json.dumps(report.as_dict(), allow_nan=False))
    assert there == report.as_dict()
    assert (there["found"], there["missed"], len(there["invented"])) == (1, 1, 1)
    assert there["episodes"][0]["hand_up_at_s"] == 1.0
    assert there["identities"] == {"7": [3]}
