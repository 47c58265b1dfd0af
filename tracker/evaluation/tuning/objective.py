"""What is a better tracker? GOSPA in simulations, prediction of measurements in recordings.

An objective has parts that the search sees and parts that it never sees, so that what was found
can be held against what was there before. The parts are the same for every configuration:
differences between configurations are not differences between scenes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, Protocol

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray, IntArray
from tracker.errors import ConfigError
from tracker.evaluation.recordings.tracker_steps import Step
from tracker.evaluation.studies.monte_carlo import find_scenario, run_unit
from tracker.evaluation.trials.scenario import PeopleScenario, ScanScenario
from tracker.evaluation.trials.stated_noise import STATED, restate
from tracker.evaluation.tuning.predictive_score import score_steps
from tracker.evaluation.tuning.space import tunable

#: Scenes that no search sees begin at this number; searches take those from 0 on.
FIRST_UNSEEN = 1_000_000

#: Applies a function to every item, here or elsewhere: `map`, or an executor's.
Map = Callable[[Callable[[int], float], Iterable[int]], Iterable[float]]


class Objective(Protocol):
    """What the search needs to know of it; it can be sent to other processes."""

    @property
    def name(self) -> str:
        """Of the scenario or the recording."""

    @property
    def figure(self) -> str:
        """What is measured, with its unit."""

    @property
    def is_cost(self) -> bool:
        """Less is better."""

    @property
    def parts(self) -> int:
        """How many parts the search sees."""

    def seen(self, config: Config) -> Iterator[float]:
        """The figure of each part that the search sees."""

    def unseen(self, config: Config, run: Map = map) -> FloatArray:
        """The figure of each part that it never sees."""

    def judges(self, name: str) -> bool:
        """Whether its figures depend on a parameter at all."""

    def check(self, names: Sequence[str]) -> None:
        """Refuse parameters that it cannot judge, by a `ConfigError`."""

    def describe(self) -> str:
        """All that decides on its figures, in words: the same words, the same figures."""


@dataclass(frozen=True, slots=True)
class ScenarioObjective:
    """GOSPA of whole trials of a scenario, with a cutoff of 1 m.

    Attributes:
        name: Of the scenario.
        scenario: What happens.
        seed: Of every scene.
        parts: Scenes that the search sees, each ...
        scene_s: ... so long.
        unseen_scenes: Scenes for the verdict, as long as the scenario has them.
    """

    name: str
    scenario: PeopleScenario | ScanScenario
    seed: int = 1
    parts: int = 6
    scene_s: float = 8.0
    unseen_scenes: int = 40

    figure: ClassVar[str] = "GOSPA (m)"
    is_cost: ClassVar[bool] = True

    def seen(self, config: Config) -> Iterator[float]:
        """GOSPA of each scene that the search sees."""
        scenario = replace(self.scenario, duration_s=self.scene_s)
        for part in range(self.parts):
            yield _gospa_m(scenario, config, self.seed, part)

    def unseen(self, config: Config, run: Map = map) -> FloatArray:
        """GOSPA of each scene that it never sees."""
        numbers = range(FIRST_UNSEEN, FIRST_UNSEEN + self.unseen_scenes)
        score = partial(_gospa_m, self.scenario, config, self.seed)
        return np.array(list(run(score, numbers)))

    def judges(self, name: str) -> bool:
        """Every parameter, by what becomes of it."""
        return True

    def check(self, names: Sequence[str]) -> None:
        """There is nothing to refuse."""

    def describe(self) -> str:
        """All that decides on the figures."""
        return f"{self.parts} scenes of {self.scene_s:g} s, seed {self.seed}: {self.scenario}"


@dataclass(frozen=True, slots=True, eq=False)
class RecordingObjective:
    """How well a recording's measurements were predicted, in pieces of some seconds.

    The search sees the first part of the recording, the verdict is about the rest; in both the
    tracker runs from the beginning.

    Attributes:
        name: Of the recording.
        steps: From `tracker_steps.recorded_steps`.
        told: The configuration that they were recorded under.
        piece_s: Length of a piece; pieces without a measurement do not count.
        seen_share: So much of the recording the search sees.
    """

    name: str
    steps: tuple[Step, ...]
    told: Config
    piece_s: float = 5.0
    seen_share: float = 0.6

    figure: ClassVar[str] = "log-density of measurements (1/m^2)"
    is_cost: ClassVar[bool] = False
    parts: ClassVar[int] = 1

    def __post_init__(self) -> None:
        stamps = np.array([step.stamp_ns for step in self.steps if len(step.measurements)])
        seen = stamps < self._split_ns
        if min(len(np.unique(self._piece(part))) for part in (stamps[seen], stamps[~seen])) < 2:
            raise ConfigError(
                f"{self.name}: contains too few measurements for a search and a final test; use "
                "a recording of a minute or more in which people raise hands."
            )

    def seen(self, config: Config) -> Iterator[float]:
        """The mean score of the part that the search sees."""
        steps = [step for step in self.steps if step.stamp_ns < self._split_ns]
        yield float(self._scores(steps, config, 0).mean())

    def unseen(self, config: Config, run: Map = map) -> FloatArray:
        """The mean score of each piece that it never sees."""
        return self._scores(self.steps, config, self._split_ns)

    def judges(self, name: str) -> bool:
        """Whether the measurements tell anything of a parameter."""
        if name in STATED:
            return name in self._restated
        return tunable()[name].kind != "life"

    def check(self, names: Sequence[str]) -> None:
        """Refuse parameters on which the score of measurements does not depend."""
        blind = [name for name in names if not self.judges(name)]
        if blind:
            raise ConfigError(
                f"A recording cannot tune {', '.join(blind)}: its score does not depend on when "
                "tracks begin and end (life). It can tune the stated noise only with `ranging: "
                "person`, and that of hands only with `pose_opinion: none`. Choose other "
                "parameters, or tune on a scenario."
            )

    def describe(self) -> str:
        """All that decides on the figures."""
        first, last = self.steps[0].stamp_ns, self.steps[-1].stamp_ns
        count = sum(len(step.measurements) for step in self.steps)
        return f"{count} measurements from {first} to {last}, taken under {self.told}"

    @property
    def _restated(self) -> tuple[str, ...]:
        """Stated noise that can be told anew; which hands had a pose is not kept."""
        if self.told.ranging != "person":
            return ()
        poses = self.told.detector == "pose" or self.told.pose_opinion == "evidence"
        return ("range_std_m",) if poses else STATED

    @property
    def _split_ns(self) -> int:
        first, last = self.steps[0].stamp_ns, self.steps[-1].stamp_ns
        return first + round((last - first) * self.seen_share)

    def _piece(self, stamps_ns: IntArray) -> IntArray:
        return (stamps_ns - self.steps[0].stamp_ns) // round(self.piece_s * 1e9)

    def _scores(self, steps: Sequence[Step], config: Config, from_ns: int) -> FloatArray:
        if self._restated:
            told_m = self.told.hand_offset_std_m if self._restated == STATED else None
            steps = [
                replace(step, measurements=restate(step.measurements, config, told_m))
                for step in steps
            ]
        score = score_steps(steps, config)
        counts = score.stamps_ns >= from_ns
        _, piece = np.unique(self._piece(score.stamps_ns[counts]), return_inverse=True)
        return np.bincount(piece, score.log_densities[counts]) / np.bincount(piece)


def scenario_objective(
    name: str, *, seed: int, parts: int, scene_s: float, unseen: int
) -> Objective:
    """The objective of a scenario.

    Raises:
        SceneError: No scenario has this name.
        ConfigError: Nothing but a filter is at work in it.
    """
    _, scenario = find_scenario(name)
    if not isinstance(scenario, (PeopleScenario, ScanScenario)):
        raise ConfigError(
            f"The scenario {name} has no tracks that come and go, so GOSPA says nothing of it; "
            "choose one in which the whole tracker is at work, such as `people` or `rough`."
        )
    return ScenarioObjective(name, scenario, seed, parts, scene_s, unseen)


def _gospa_m(
    scenario: PeopleScenario | ScanScenario, config: Config, seed: int, trial: int
) -> float:
    return float(run_unit(scenario, config, seed, trial, 1).rows["gospa_m"][0])
