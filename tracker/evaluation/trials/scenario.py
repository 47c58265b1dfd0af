"""What is simulated? Named settings of people, hands, sensors and their faults."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal, TypeAlias

from tracker.config import Config

Parameters: TypeAlias = tuple[tuple[str, Any], ...]


def _parameters(**values: Any) -> Parameters:
    return tuple(values.items())


@dataclass(frozen=True, slots=True, kw_only=True)
class FilterScenario:
    """One person who moves exactly as the filter assumes, seen by one sensor.

    Nothing but the filter is at work: the person is known from the start, every measurement is
    theirs. So the posterior Cramer-Rao bound is known, and NEES has a distribution. Trials are
    short enough that (nearly) nobody walks through the sensor, where no filter of this kind holds.

    Attributes:
        title: One sentence.
        frames: Measurements of each trial.
        rate_hz: How many come each second.
        start_m: The sensor stands so far from where the person begins.
        start_std_m: Spread of the beginning, which the filter is told ...
        speed_std_mps: ... and of the speed, per axis.
        acceleration_density: How restless the person is, m^2/s^3.
        bearing_std_deg: Noise of the bearing.
        range_std_m: Noise of the range.
        outlier_share: Share of ranges that are far off ...
        outlier_std_m: ... by this standard deviation.
        parameters: Names and values that the tracker is set to, where they are not its defaults.
    """

    title: str
    frames: int = 20
    rate_hz: float = 10.0
    start_m: float = 6.0
    start_std_m: float = 0.3
    speed_std_mps: float = 0.3
    acceleration_density: float = 0.3
    bearing_std_deg: float = 2.0
    range_std_m: float = 0.08
    outlier_share: float = 0.0
    outlier_std_m: float = 3.0
    parameters: Parameters = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class PeopleScenario:
    """People around a robot who raise their hands; the whole tracker is at work.

    Attributes:
        title: One sentence.
        duration_s: Of one trial.
        rate_hz: Frames each second.
        people: How many, from and to; drawn anew for each trial.
        area_m: Where they walk: x from, x to, y from, y to; the robot stands at the origin.
        pause_s: Mean of their stops.
        recording: CSV with the paths of real people (t_s, id, x_m, y_m); None simulates them.
        hand_up_s: How long a hand stays up, from and to; infinite for never lowered.
        hand_down_s: How long it stays down, from and to.
        field_of_view_deg: Hands outside are not seen; 360 for everywhere.
        turn_amplitude_deg: The robot turns so far to either side ...
        turn_period_s: ... once in this time.
        bearing_std_deg: Noise of a hand's bearing.
        hand_offset_m: A hand is up so far to one side of the body.
        range_std_m: Noise of the range.
        outlier_share: Share of ranges that are far off (what stands behind was hit) ...
        outlier_m: ... by up to so much.
        range_missing_share: Share of hands that come without a range.
        detection_probability: Of a raised hand that is in view and not hidden.
        clutter_per_frame: Mean number of raised hands that nobody raised.
        body_width_m: Whoever is nearer hides what is behind; 0 for glass people.
        scan_detection_probability: Of a person's cluster in the scan; 0 without a laser.
        scan_clutter_per_frame: Mean number of clusters that are nobody.
        latency_s: Measurements are so much older than their stamp says.
        pose_std_m: Error of the robot's position, anew in every frame ...
        pose_std_deg: ... and of its direction.
        noise_known: Measurements state their true noise; otherwise what the tracker's parameters
            say, as on a robot (`range_std_m`, `hand_offset_std_m`).
        parameters: Names and values that the tracker is set to, where they are not its defaults.
    """

    title: str
    duration_s: float = 30.0
    rate_hz: float = 10.0
    people: tuple[int, int] = (3, 8)
    area_m: tuple[float, float, float, float] = (1.0, 7.0, -3.0, 3.0)
    pause_s: float = 5.0
    recording: str | None = None
    hand_up_s: tuple[float, float] = (float("inf"), float("inf"))
    hand_down_s: tuple[float, float] = (5.0, 15.0)
    field_of_view_deg: float = 360.0
    turn_amplitude_deg: float = 0.0
    turn_period_s: float = 10.0
    bearing_std_deg: float = 1.0
    hand_offset_m: float = 0.0
    range_std_m: float = 0.08
    outlier_share: float = 0.0
    outlier_m: float = 3.0
    range_missing_share: float = 0.0
    detection_probability: float = 0.95
    clutter_per_frame: float = 0.2
    body_width_m: float = 0.4
    scan_detection_probability: float = 0.0
    scan_clutter_per_frame: float = 0.0
    latency_s: float = 0.0
    pose_std_m: float = 0.0
    pose_std_deg: float = 0.0
    noise_known: bool = True
    parameters: Parameters = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownPeopleScenario:
    """People known from the start who move as the tracker assumes, seen by one sensor.

    Prediction, gate, assignment and correction are at work; nobody comes or goes. Whatever
    `motion`, `association` and `outlier_dof` say, people walk, the assignment is the most likely
    one, and bearings and ranges are Gaussian.

    Attributes:
        title: One sentence.
        people: How many.
        frames: Of each trial.
        rate_hz: How many come each second.
        area_m: Where people begin, and where clutter is: x from, x to, y from, y to; the sensor
            stands at the origin.
        start_std_m: Spread of the beginning, which the tracker is told ...
        speed_std_mps: ... and of the speed, per axis.
        acceleration_density: How restless people are, m^2/s^3.
        bearing_std_deg: Noise of the bearing.
        range_std_m: Noise of the range.
        detection_probability: Of everybody in every frame.
        clutter_per_frame: Mean number of measurements that are nobody's.
        parameters: Names and values that the tracker is set to, where they are not its defaults.
    """

    title: str
    people: int = 5
    frames: int = 30
    rate_hz: float = 10.0
    area_m: tuple[float, float, float, float] = (4.0, 8.0, -3.0, 3.0)
    start_std_m: float = 0.1
    speed_std_mps: float = 0.5
    acceleration_density: float = 0.3
    bearing_std_deg: float = 1.0
    range_std_m: float = 0.08
    detection_probability: float = 0.95
    clutter_per_frame: float = 1.0
    parameters: Parameters = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ScanScenario:
    """A room drawn at random; a ray-cast laser sees people, furniture and walls.

    All of the pipeline is at work but the hand models, in whose place the truth shows hands.

    Attributes:
        title: One sentence.
        duration_s: Of one trial.
        rate_hz: Frames each second; each has a scan of its own.
        people: How many, from and to; drawn anew for each trial.
        furniture: `tables` alone, or a `bistro` with chairs, a bar, and people close together.
        map_known: The pipeline has a map of walls and tables; `use_map` decides what it does.
        sitting_share: How many of them sit at a table; the others walk and stop.
        pause_s: Mean of their stops.
        hand_up_s: How long a hand stays up, from and to.
        hand_down_s: How long it stays down, from and to.
        detection_probability: Of a raised hand that is in the picture and not hidden.
        clutter_per_frame: Mean number of raised hands that nobody raised.
        landmark_std_px: Noise of a hand's place in the picture.
        parameters: Names and values that the pipeline is set to, where they are not its defaults.
    """

    title: str
    duration_s: float = 120.0
    rate_hz: float = 10.0
    people: tuple[int, int] = (3, 6)
    furniture: Literal["tables", "bistro"] = "tables"
    map_known: bool = False
    sitting_share: float = 0.4
    pause_s: float = 20.0
    hand_up_s: tuple[float, float] = (2.0, 6.0)
    hand_down_s: tuple[float, float] = (5.0, 40.0)
    detection_probability: float = 0.9
    clutter_per_frame: float = 0.02
    landmark_std_px: float = 2.0
    parameters: Parameters = ()


Scenario = FilterScenario | KnownPeopleScenario | PeopleScenario | ScanScenario

_MATCHED = _parameters(motion="cv", acceleration_density=0.3, outlier_dof=0.0)
_HEAVY_TAILED = _parameters(motion="cv", acceleration_density=0.3)
_HANDS: dict[str, Any] = {"hand_up_s": (2.0, 6.0), "hand_offset_m": 0.2, "bearing_std_deg": 0.5}
_HANDS_DOWN = PeopleScenario(
    title="Hands go down for 5 to 40 s and up again; the laser sees people all the time.",
    duration_s=120.0,
    people=(3, 6),
    pause_s=20.0,
    hand_down_s=(5.0, 40.0),
    detection_probability=0.9,
    clutter_per_frame=0.02,
    scan_detection_probability=0.9,
    scan_clutter_per_frame=1.0,
    **_HANDS,
)

SCENARIOS: Mapping[str, Scenario] = MappingProxyType(
    {
        "model-matched": FilterScenario(
            title="One person who moves exactly as the filter assumes; bearing noise 2 degrees.",
            parameters=_MATCHED,
        ),
        "model-matched-fine": FilterScenario(
            title="The same with bearing noise 0.5 degrees.",
            bearing_std_deg=0.5,
            parameters=_MATCHED,
        ),
        "model-matched-coarse": FilterScenario(
            title="The same with bearing noise 5 degrees.",
            bearing_std_deg=5.0,
            parameters=_MATCHED,
        ),
        "outliers": FilterScenario(
            title="Like model-matched, but one range in twenty is wrong by meters.",
            outlier_share=0.05,
            parameters=_HEAVY_TAILED,
        ),
        "known-people": KnownPeopleScenario(
            title="Five people who are known from the start, among clutter, seen 19 times of 20.",
            parameters=_parameters(
                acceleration_density=0.3, detection_probability=0.95, newcomer_density=0.04
            ),
        ),
        "known-people-missed": KnownPeopleScenario(
            title="The same, seen 6 times of 10.",
            detection_probability=0.6,
            parameters=_parameters(
                acceleration_density=0.3, detection_probability=0.6, newcomer_density=0.04
            ),
        ),
        "people": PeopleScenario(
            title="Three to eight people who walk and stop, seen 19 times of 20.",
        ),
        "people-missed": PeopleScenario(
            title="The same, seen 6 times of 10.",
            detection_probability=0.6,
        ),
        "crowd": PeopleScenario(
            title="Eight to fifteen people who hide one another, in clutter.",
            people=(8, 15),
            detection_probability=0.9,
            clutter_per_frame=0.5,
        ),
        "hands-down": _HANDS_DOWN,
        "hands-down-scans": ScanScenario(
            title="The same in a furnished room, with people found in ray-cast scans.",
        ),
        "hands-down-map": ScanScenario(
            title="The same with a map of walls and tables.",
            map_known=True,
        ),
        "bistro-scans": ScanScenario(
            title="A bistro with a map: chairs, a bar, shins under tables, people close together.",
            furniture="bistro",
            map_known=True,
        ),
        "seated-scans": ScanScenario(
            title="The same where everybody sits.",
            furniture="bistro",
            map_known=True,
            sitting_share=1.0,
        ),
        "cheap-lidar": PeopleScenario(
            title="A cheap, noisy laser and people who hardly stop; the tracker is not told the "
            "noise.",
            people=(3, 6),
            pause_s=1.0,
            hand_down_s=(3.0, 10.0),
            range_std_m=0.25,
            outlier_share=0.05,
            range_missing_share=0.1,
            detection_probability=0.7,
            clutter_per_frame=0.1,
            scan_detection_probability=0.6,
            scan_clutter_per_frame=1.0,
            latency_s=0.05,
            noise_known=False,
            **_HANDS,
        ),
        "rough": PeopleScenario(
            title="A turning robot: latency, pose noise, range outliers, missing ranges.",
            people=(3, 6),
            hand_down_s=(3.0, 10.0),
            field_of_view_deg=120.0,
            turn_amplitude_deg=40.0,
            outlier_share=0.05,
            range_missing_share=0.1,
            detection_probability=0.85,
            scan_detection_probability=0.8,
            latency_s=0.05,
            pose_std_m=0.03,
            pose_std_deg=0.5,
            **_HANDS,
        ),
    }
)


def default_config(scenario: Scenario) -> Config:
    """The tracker as the scenario wants it."""
    return Config().replace(**dict(scenario.parameters))
