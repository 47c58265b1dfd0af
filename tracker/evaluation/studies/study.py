"""The figures of a study over all trials, with their intervals and what was expected."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Generic, TypeVar

import numpy as np
from scipy.stats import norm

from tracker.config import Config
from tracker.containers import FloatArray
from tracker.evaluation.metrics.consistency import mean_bounds
from tracker.evaluation.metrics.cramer_rao import posterior_bound
from tracker.evaluation.metrics.intervals import wilson_interval
from tracker.evaluation.trials.filter_study import prior_covariance
from tracker.evaluation.trials.scenario import (
    FilterScenario,
    KnownPeopleScenario,
    PeopleScenario,
    ScanScenario,
    Scenario,
)

#: A filter is judged once its first second, in which it knows what it was told, is over.
SETTLED_S = 1.0
#: A track this many times farther off than the bound, at the end, is lost.
LOST_BOUNDS = 6.0


@dataclass(frozen=True, slots=True)
class Figure:
    """One number of a study.

    Attributes:
        name: What it is, with its unit.
        value: Over all trials; NaN where nothing was measured.
        low: 95 % interval of `value`, from the spread among trials; NaN where there is none.
        high: Its other end.
        expected: Between which numbers `value` lies in 95 % of all studies of a perfect filter.
        good: Which values are good, in a word or two; empty for what is neither good nor bad.
    """

    name: str
    value: float
    low: float = float("nan")
    high: float = float("nan")
    expected: tuple[float, float] | None = None
    good: str = ""

    @property
    def as_expected(self) -> bool | None:
        """Whether the value lies in the expected interval; None without such an interval."""
        if self.expected is None:
            return None
        return self.expected[0] <= self.value <= self.expected[1]


_Scenario = TypeVar("_Scenario", bound=Scenario)


@dataclass(frozen=True, eq=False)
class StudyOf(Generic[_Scenario]):
    """Trials of a scenario.

    Attributes:
        name: Of the scenario.
        scenario: What happened.
        config: The tracker's parameters.
        seed: Of the study.
        rows: Figures of each trial, shape (B,), by name.
    """

    name: str
    scenario: _Scenario
    config: Config
    seed: int
    rows: dict[str, FloatArray]

    @property
    def trials(self) -> int:
        """How many."""
        return len(next(iter(self.rows.values())))


@dataclass(frozen=True, eq=False)
class FilterStudy(StudyOf[FilterScenario]):
    """Trials of a `FilterScenario`.

    Attributes:
        rows: Figures of each trial, shape (B,): `mse_m2`, `bound_m2` (along the trial's own path)
            and `mean_nees`, means over the frames once settled; `final_error_m`, `final_nees` at
            the last frame.
        squared_error_m2: Shape (T,), mean over the trials.
        nees: Shape (T,), mean over the trials.
        information: Shape (T, 2, 2), mean over the trials.
    """

    squared_error_m2: FloatArray
    nees: FloatArray
    information: FloatArray

    @cached_property
    def bound_m2(self) -> FloatArray:
        """Shape (T,): least mean squared error of the position, from the expected information."""
        scenario = self.scenario
        bound = posterior_bound(
            prior_covariance(scenario),
            self.information,
            1.0 / scenario.rate_hz,
            scenario.acceleration_density,
        )
        return np.asarray(bound[:, 0, 0] + bound[:, 1, 1])

    @property
    def lost(self) -> int:
        """Trials whose track is far from the person at the end."""
        limit_m = LOST_BOUNDS * np.sqrt(self.bound_m2[-1])
        return int(np.count_nonzero(~(self.rows["final_error_m"] <= limit_m)))

    @property
    def figures(self) -> tuple[Figure, ...]:
        """The table of the study."""
        settled = settled_frame(self.scenario)
        expected_m = float(np.sqrt(self.bound_m2[settled:].mean()))
        bound_m = float(np.sqrt(self.rows["bound_m2"].mean()))
        rmse = _root_mean("RMSE (m)", self.rows["mse_m2"], "less")
        bounds = mean_bounds(4, self.trials)
        nees = _mean("NEES at the end (ideal 4)", self.rows["final_nees"], "near 4")
        return (
            Figure(
                "RMSE / Cramer-Rao bound",
                rmse.value / bound_m,
                rmse.low / bound_m,
                rmse.high / bound_m,
                good="near 1",
            ),
            rmse,
            Figure("bound along the paths (m)", bound_m),
            Figure("bound of expected information (m)", expected_m),
            replace(nees, expected=bounds),
            _mean("NEES over time (ideal 4)", self.rows["mean_nees"], "near 4"),
            Figure("tracks lost", float(self.lost), good="0"),
        )


@dataclass(frozen=True, eq=False)
class KnownPeopleStudy(StudyOf[KnownPeopleScenario]):
    """Trials of a `KnownPeopleScenario`.

    Attributes:
        rows: Figures of each trial, shape (B,), from `known_people.known_people_rows`.
    """

    @property
    def figures(self) -> tuple[Figure, ...]:
        """The table of the study."""
        rows = self.rows
        return (
            _root_mean("RMSE (m)", rows["mse_m2"], "less"),
            _mean("NEES of found people (ideal 4)", rows["final_nees"], "near 4"),
            _mean("wrong measurements, share", rows["wrong_share"], "0", most=1.0),
            _mean("people swapped, share", rows["swapped_share"], "0", most=1.0),
            _mean("people lost, share", rows["lost_share"], "0", most=1.0),
        )


@dataclass(frozen=True, eq=False)
class PeopleStudy(StudyOf[PeopleScenario | ScanScenario]):
    """Trials of a `PeopleScenario` or a `ScanScenario`.

    Attributes:
        rows: Figures of each trial, shape (B,), by the names of `metrics.scores.score_trial`.
    """

    @property
    def remark(self) -> str:
        """What one must know to judge the false tracks and raises."""
        clutter = self.scenario.clutter_per_frame
        return (
            f"In every image {clutter:g} raised hands on average are nobody's: false tracks and "
            f"false raises come of these. A trial lasts {self.scenario.duration_s:g} s."
        )

    @property
    def figures(self) -> tuple[Figure, ...]:
        """The table of the study."""
        rows = self.rows
        hands, again = float(rows["hands"].sum()), float(rows["raised_again"].sum())
        return (
            _mean("GOSPA (m), cutoff 1 m", rows["gospa_m"], "less"),
            _mean("  error of places (m²)", rows["gospa_localisation"], "less"),
            _mean("  people missed (m²)", rows["gospa_missed"], "less"),
            _mean("  false tracks (m²)", rows["gospa_false"], "less"),
            _mean("OSPA (m), cutoff 1 m", rows["ospa_m"], "less"),
            _mean("missed share of people", rows["missed_share"], "0", most=1.0),
            _mean("false tracks in a frame", rows["false_tracks"], "0"),
            _mean("identity switches a minute", rows["identity_switches_per_min"], "0"),
            _mean("track purity", rows["track_purity"], "near 1", most=1.0),
            _mean("RMSE of found people (m)", rows["rmse_m"], "less"),
            _mean("NEES of the position (ideal 2)", rows["nees_position"], "near 2"),
            _mean(
                "people inside the 95 % ellipse, share",
                rows["covered_share"],
                "near 0.95",
                most=1.0,
            ),
            _mean("time to raise (s)", rows["time_to_raise_s"], "less"),
            Figure("raised hands", hands),
            _share("missed raises, share", rows["missed_raises"].sum(), hands, "0"),
            _mean("false raises in a trial", rows["false_raises"], "0"),
            _share("raised again: same identity", rows["same_identity"].sum(), again, "near 1"),
            _share("raised again: somebody else's", rows["wrong_identity"].sum(), again, "0"),
        )


Study = FilterStudy | KnownPeopleStudy | PeopleStudy


def settled_frame(scenario: FilterScenario) -> int:
    """First frame that is judged; the last one at least."""
    return min(round(SETTLED_S * scenario.rate_hz), scenario.frames - 1)


def study_as_dict(study: Study) -> dict[str, Any]:
    """A study in plain numbers, for JSON; None for what was not measured."""
    return {
        "scenario": study.name,
        "title": study.scenario.title,
        "trials": study.trials,
        "seed": study.seed,
        "figures": [
            {
                "name": figure.name.strip(),
                "value": _number(figure.value),
                "interval_95": [_number(figure.low), _number(figure.high)],
                "expected_95": None if figure.expected is None else list(figure.expected),
                "good": figure.good,
            }
            for figure in study.figures
        ],
    }


def _mean(name: str, values: FloatArray, good: str, most: float = np.inf) -> Figure:
    """The mean and its interval, cut at what a figure can be: from 0 to `most`."""
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return Figure(name, float("nan"), good=good)
    mean = float(values.mean())
    if len(values) == 1:
        return Figure(name, mean, good=good)
    half = float(norm.ppf(0.975) * values.std(ddof=1) / np.sqrt(len(values)))
    return Figure(name, mean, max(mean - half, 0.0), min(mean + half, most), good=good)


def _root_mean(name: str, squares: FloatArray, good: str) -> Figure:
    mean = _mean(name, squares, good)
    value, low, high = (float(np.sqrt(x)) for x in (mean.value, mean.low, mean.high))
    return Figure(name, value, low, high, good=good)


def _share(name: str, count: float, total: float, good: str) -> Figure:
    """A share and Wilson's interval of it."""
    if total == 0:
        return Figure(name, float("nan"), good=good)
    return Figure(name, float(count / total), *wilson_interval(count, total), good=good)


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
