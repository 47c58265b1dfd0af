import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.errors import ConfigError, SceneError
from tracker.evaluation.recordings.tracker_steps import Step
from tracker.evaluation.studies.monte_carlo import run_unit
from tracker.evaluation.trials.scenario import SCENARIOS
from tracker.evaluation.tuning.objective import (
    FIRST_UNSEEN,
    RecordingObjective,
    ScenarioObjective,
    scenario_objective,
)
from tracker.evaluation.tuning.space import tunable

SHORT = ScenarioObjective("people", SCENARIOS["people"], parts=2, scene_s=1.0, unseen_scenes=1)


def steps_of_a_minute(range_std_m, told, seed=1):
    """Somebody who stands 3 m ahead with a hand up, measured ten times a second."""
    rng = np.random.default_rng(seed)
    values = rng.normal((0.0, 3.0), (range_std_m / 3.0, range_std_m), (600, 2))
    return tuple(
        Step(
            number * 100_000_000,
            Measurements.polar([b], [r], told.range_std_m / 3.0, told.range_std_m),
            (0.0, 0.0),
            None,
            None,
        )
        for number, (b, r) in enumerate(values)
    )


def test_the_same_seed_gives_the_same_figures():
    config = Config()
    assert list(SHORT.seen(config)) == list(SHORT.seen(config))
    other = ScenarioObjective("people", SCENARIOS["people"], seed=2, parts=2, scene_s=1.0)
    assert list(other.seen(config)) != list(SHORT.seen(config))


def test_the_figures_are_the_gospa_of_the_scenario_s_own_trials():
    long = ScenarioObjective("people", SCENARIOS["people"], parts=1, scene_s=30.0)
    (found,) = long.seen(Config())
    expected = run_unit(SCENARIOS["people"], Config(), 1, 0, 1).rows["gospa_m"]
    assert found == expected[0]


def test_unseen_scenes_are_no_scenes_of_the_search():
    asked = []

    def run(function, numbers):
        asked.extend(numbers)
        return [0.0 for _ in asked]

    SHORT.unseen(Config(), run)
    assert asked == [FIRST_UNSEEN]
    assert min(asked) > 10_000 > SHORT.parts


def test_a_recording_is_predicted_best_with_its_own_noise():
    told = Config()
    recording = RecordingObjective("a.mcap", steps_of_a_minute(0.25, told), told)
    true, stated = Config(range_std_m=0.25), told
    assert next(iter(recording.seen(true))) > next(iter(recording.seen(stated)))
    gain = recording.unseen(true) - recording.unseen(stated)
    assert gain.mean() > 3.0 * gain.std(ddof=1) / np.sqrt(len(gain))


def test_the_search_sees_nothing_of_the_part_that_judges():
    told = Config()
    steps = steps_of_a_minute(0.1, told)
    split = next(i for i, step in enumerate(steps) if step.stamp_ns >= 36_000_000_000)
    other = steps[:split] + steps_of_a_minute(0.1, told, seed=2)[split:]
    one, two = (RecordingObjective("a.mcap", item, told) for item in (steps, other))
    assert list(one.seen(told)) == pytest.approx(list(two.seen(told)), abs=1e-12)
    assert (one.unseen(told) != two.unseen(told)).all()


def test_what_a_recording_cannot_judge_is_refused_by_name():
    told = Config(pose_opinion="none")
    recording = RecordingObjective("a.mcap", steps_of_a_minute(0.1, told), told)
    recording.check([name for name, search in tunable().items() if search.kind != "life"])
    with pytest.raises(ConfigError, match="cannot tune delete_after_s"):
        recording.check(["delete_after_s"])
    spec = RecordingObjective("a.mcap", recording.steps, Config(ranging="spec"))
    with pytest.raises(ConfigError, match="cannot tune range_std_m"):
        spec.check(["range_std_m"])
    posed = RecordingObjective("a.mcap", recording.steps, Config())
    posed.check(["range_std_m"])
    with pytest.raises(ConfigError, match="cannot tune hand_offset_std_m"):
        posed.check(["hand_offset_std_m"])


def test_a_recording_without_enough_in_it_is_refused():
    told = Config()
    with pytest.raises(ConfigError, match=r"a\.mcap: contains too few measurements"):
        RecordingObjective("a.mcap", steps_of_a_minute(0.1, told)[:20], told)


def test_scenarios_without_a_whole_tracker_are_refused():
    with pytest.raises(ConfigError, match="model-matched has no tracks that come and go"):
        scenario_objective("model-matched", seed=1, parts=1, scene_s=1.0, unseen=2)
    with pytest.raises(SceneError, match="moonbase"):
        scenario_objective("moonbase", seed=1, parts=1, scene_s=1.0, unseen=2)
