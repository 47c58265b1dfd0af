"""How is the node doing? Rates, latency, which input is missing, as /diagnostics has it.

Whether an input is silent is judged on a steady clock, so that it shows while simulated time
stands still as well.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field

import numpy as np

from nodes.shared.image_silence import patience_s
from nodes.shared.link import Link
from nodes.shared.topics import DIAGNOSTICS_TYPE, Input
from tracker.config import Config
from tracker.containers import FrameResult, PerceptionWork
from tracker.messages import Encoded
from tracker.messages.parts import header
from tracker.messages.types import build, serialize
from tracker.notes import NoteKind
from tracker.problems.clock_offset import ClockOffset
from tracker.problems.scan_use import ScanUse
from tracker.wording import counted

#: Reports are due so often; with `SILENT_S` a silent input shows within two seconds.
REPORT_PERIOD_S = 0.5
#: An input that has not come for so long is called stale.
SILENT_S = 0.9
#: Frames over which latency is told, and reports over which rates are.
_LATENCIES, _REPORTS = 200, 10
#: A scanner that serves none of so many images in a row is worth a warning.
_UNUSED_IMAGES = 10
#: Stamps ahead of their arrival by more than this come from a clock that is wrong.
_AHEAD_S = 0.25
#: Stamps farther than this from the node's clock are of another time, not late.
_OTHER_TIME_S = 10.0

#: Of perception, as `PerceptionWork` has them.
_STAGES = ("search", "new_hands")

OK, WARN, ERROR = 0, 1, 2

#: The inputs that are told apart, and how bad it is to miss them.
_WATCHED = {
    Input.IMAGES: ERROR,
    Input.SCAN: WARN,
    Input.TRANSFORMS: WARN,
    Input.CAMERA_INFO: OK,
    Input.MAP: OK,
}


@dataclass(frozen=True, slots=True)
class Status:
    """One line of /diagnostics.

    Attributes:
        name: What it is about.
        level: `OK`, `WARN` or `ERROR`.
        message: In a few words.
        values: In numbers.
        is_news: The log has not told of it in other words.
    """

    name: str
    level: int
    message: str
    values: Mapping[str, object] = field(default_factory=dict)
    is_news: bool = True


@dataclass(slots=True)
class _Watched:
    count: int = 0
    last_ns: int | None = None
    malformed: int = 0
    last_fault: str = ""


class Diagnostics:
    """Counts what happens, from any thread, and reports it.

    Args:
        steady_ns: A clock that never jumps.
        topic_names: Where each input is listened to, for the words of the report.
    """

    def __init__(self, steady_ns: Callable[[], int], topic_names: Mapping[Input, str]) -> None:
        self._steady_ns = steady_ns
        self._topic_names = topic_names
        self._lock = threading.Lock()
        self._inputs = {item: _Watched() for item in Input}
        self._latency_s = deque[float](maxlen=_LATENCIES)
        self._busy_s = deque[float](maxlen=_LATENCIES)
        self._work = deque[PerceptionWork](maxlen=_LATENCIES)
        self._reports = deque[tuple[int, dict[str, int]]](maxlen=_REPORTS + 1)
        self._last: FrameResult | None = None
        self._scan_use = ScanUse()
        self._depth_use = ScanUse(lambda kind: kind.leaves_depth_unused)
        self._scan_clock = ClockOffset()
        self._processed = 0
        self._last_frame_ns: int | None = None
        self._listening_ns: int | None = None
        self._located_ns: int | None = None
        self._links: Mapping[Input, Link] = {}
        self.resets = 0

    def listen(self) -> None:
        """Nothing was listened to, and is from now on: silence begins here."""
        with self._lock:
            self._listening_ns = self._steady_ns()

    def heard(self, item: Input) -> None:
        """Something has come."""
        with self._lock:
            self._inputs[item].count += 1
            self._inputs[item].last_ns = self._steady_ns()

    def scan_stamped(self, stamp_ns: int, now_ns: int) -> None:
        """A scan with this stamp has come, at this time of the node's clock."""
        with self._lock:
            self._scan_clock.add(stamp_ns, now_ns)

    def malformed(self, item: Input, text: str) -> None:
        """A malformed message has come."""
        with self._lock:
            self._inputs[item].malformed += 1
            self._inputs[item].last_fault = text

    def processed(self, result: FrameResult, latency_s: float, busy_s: float) -> None:
        """An image was processed.

        Args:
            result: What came of it.
            latency_s: From its stamp until `/hand_raised` was published, on the node's clock.
            busy_s: From when the worker took it until then.
        """
        with self._lock:
            self._processed += 1
            self._last = result
            for use in (self._scan_use, self._depth_use):
                use.add(result)
                if use.used:
                    use.reset()
            self._latency_s.append(latency_s)
            self._busy_s.append(busy_s)
            if result.work is not None:
                self._work.append(result.work)
            self._last_frame_ns = self._steady_ns()
            if result.sensor_pose is not None:
                self._located_ns = self._last_frame_ns

    def is_hopeful(self) -> bool:
        """Whether transforms come at all, so that waiting for one makes sense."""
        last_ns = self._inputs[Input.TRANSFORMS].last_ns
        return last_ns is not None and self._since(last_ns) < SILENT_S

    @property
    def silence_s(self) -> float | None:
        """How long ago an image was processed; None before the first."""
        return None if self._last_frame_ns is None else self._since(self._last_frame_ns)

    def report(
        self,
        config: Config,
        detector: str,
        *,
        is_enabled: bool,
        lost: int,
        links: Mapping[Input, Link] | None = None,
    ) -> list[Status]:
        """Everything there is to say now; rates are since a few reports ago.

        Args:
            config: The parameters in force.
            detector: What finds hands.
            is_enabled: Whether images are processed at all.
            lost: Images that gave way because the worker was behind.
            links: What the wire knows of who publishes the inputs.
        """
        with self._lock:
            self._links = links or {}
            counts = {item.value: seen.count for item, seen in self._inputs.items()}
            counts |= {"processed": self._processed, "lost": lost}
            counts |= {f"{i.value} malformed": seen.malformed for i, seen in self._inputs.items()}
            self._reports.append((self._steady_ns(), counts))
            return [
                *(
                    self._input_status(item, level, is_enabled)
                    for item, level in self._watched(config).items()
                ),
                self._processing_status(config, detector, is_enabled),
                self._customers_status(config, is_enabled),
            ]

    def _watched(self, config: Config) -> dict[Input, int]:
        """The inputs that are told apart now, and how bad it is to miss them.

        Scans that never come are not missed where a depth camera serves.
        """
        has_depth = self._inputs[Input.DEPTH].last_ns is not None
        has_scans = self._inputs[Input.SCAN].last_ns is not None
        if config.depth_source == "scan" or (config.depth_source == "both" and not has_depth):
            return _WATCHED
        watched = _WATCHED | {Input.DEPTH: WARN}
        if config.depth_source == "depth" or not has_scans:
            del watched[Input.SCAN]
        return watched

    def _input_status(self, item: Input, missed: int, is_enabled: bool) -> Status:
        seen = self._inputs[item]
        level, message = self._judge(item, missed)
        if level != OK and not is_enabled:
            level, message = OK, "disabled"
        elif level != OK and self._is_settling():
            level, message = OK, "awaited"
        malformed = self._increase(f"{item.value} malformed")
        is_fault = level == OK and malformed > 0
        if is_fault:
            level, message = WARN, f"{malformed} malformed messages recently: {seen.last_fault}"
        values: dict[str, object] = {
            "topic": self._topic_names[item],
            "received": seen.count,
            "rate_hz": f"{self._rate(item.value):.1f}",
            "age_s": "never came" if seen.last_ns is None else f"{self._since(seen.last_ns):.1f}",
            "malformed": seen.malformed,
        }
        if item in self._links:
            values |= {"publishers": self._links[item].publishers, **self._links[item].values}
        if seen.last_fault:
            values["last_fault"] = seen.last_fault
        return Status(item.value, level, message, values, is_news=not is_fault)

    def _judge(self, item: Input, missed: int) -> tuple[int, str]:
        seen, level = self._inputs[item], missed
        if item is Input.CAMERA_INFO:  # one is enough, and many drivers send no more
            notes = self._last.notes if self._last is not None else ()
            for note in notes:
                if note.kind in (NoteKind.CAMERA_INFO_REFUSED, NoteKind.PRINCIPAL_POINT_OFF):
                    return WARN, note.text
            words = "missing: camera_fx, camera_fy, camera_cx and camera_cy are used"
            return OK, "has come" if seen.count else words
        if item is Input.MAP:  # latched: it comes once
            notes = self._last.notes if self._last is not None else ()
            for note in notes:
                if note.kind is NoteKind.MAP_NOT_LOCATED:
                    return WARN, note.text
            words = "missing: only the scan tells furniture from people"
            return OK, "has come" if seen.count else words
        if item is Input.TRANSFORMS:
            located_ns = self._located_ns
            if located_ns is not None and self._since(located_ns) < SILENT_S:
                return OK, "the camera's position is known"
            if seen.last_ns is None and self._inputs[Input.STATIC_TRANSFORMS].count:
                return self._judge_connection("coming")
        if seen.last_ns is None:
            return (
                level,
                f"missing: nothing has come on {self._topic_names[item]}{self._silence(item)}",
            )
        age_s = self._since(seen.last_ns)
        if age_s >= SILENT_S:
            where = f"{self._topic_names[item]} for {age_s:.1f} s{self._silence(item)}"
            return level, f"stale: nothing has come on {where}"
        if item is Input.TRANSFORMS:
            return self._judge_connection("coming")
        unused = self._scan_use.frames
        if item is Input.SCAN and unused >= _UNUSED_IMAGES:
            return WARN, f"no scan was used in the last {unused} images: {self._scan_use.reason()}"
        unused = self._depth_use.frames
        if item is Input.DEPTH and unused >= _UNUSED_IMAGES:
            why = self._depth_use.reason()
            return WARN, f"no depth was used in the last {unused} images: {why}"
        ahead_s = self._scan_clock.ahead_s()
        if item is Input.SCAN and _AHEAD_S < ahead_s < _OTHER_TIME_S:
            return WARN, f"stamps are {ahead_s:.3f} s ahead of the node's clock: not synchronized?"
        link = self._links.get(item)
        return (WARN, f"coming, but {link.loss}") if link and link.loss else (OK, "coming")

    def _silence(self, item: Input) -> str:
        """Why nothing comes, as far as the wire knows; follows the words that say so."""
        return self._links[item].silence if item in self._links else ""

    def _judge_connection(self, otherwise: str) -> tuple[int, str]:
        """Transforms come, yet the last image had no pose."""
        last, frame_ns = self._last, self._last_frame_ns
        if last is None or frame_ns is None or self._since(frame_ns) >= SILENT_S:
            return OK, otherwise
        why = (note.text for note in last.notes if note.kind is NoteKind.NO_POSE)
        return WARN, next(why, "no pose")

    def _processing_status(self, config: Config, detector: str, is_enabled: bool) -> Status:
        rate_hz, lost = self._rate("processed"), self._increase("lost")
        level, message = OK, f"{rate_hz:.1f} Hz"
        if not is_enabled:
            message = "disabled"
        elif lost:
            level = WARN
            message = f"too slow: {counted(lost, 'image')} lost recently, {message}"
        latency, busy = np.array(self._latency_s or [np.nan]), np.array(self._busy_s or [np.nan])
        middle_s = float(np.median(latency))
        values: dict[str, object] = {
            "processed": self._processed,
            "processed_hz": f"{rate_hz:.2f}",
            "wanted_hz": config.processing_rate,
            "lost": self._reports[-1][1]["lost"],
            "resets": self.resets,
            "busy_ms_median": _milliseconds(busy, 50),
            "busy_ms_p99": _milliseconds(busy, 99),
            "detector": detector,
            "model_complexity": config.model_complexity,
            "raise_rule": config.raise_rule,
            "notes": "; ".join(map(str, self._last.notes)) if self._last else "",
        }
        if self._work:
            values |= _work_values(self._work)
        if abs(middle_s) > _OTHER_TIME_S:
            values["latency"] = (
                f"stamps are {middle_s:.1f} s from the node's clock: is use_sim_time right?"
            )
        else:
            values["latency_ms_median"] = _milliseconds(latency, 50)
            values["latency_ms_p99"] = _milliseconds(latency, 99)
        return Status("processing", level, message, values)

    def _customers_status(self, config: Config, is_enabled: bool) -> Status:
        silence_s = self.silence_s
        if self._last is None or silence_s is None:
            return Status("customers", OK, "no image was processed yet")
        if not is_enabled:
            return Status("customers", OK, "nobody is reported: disabled")
        if silence_s >= patience_s(config):
            why = f"nobody is reported: no image was processed for {silence_s:.1f} s"
            return Status("customers", OK if self._is_settling() else WARN, why)
        tracks = self._last.tracks
        refusals = self._last.hands.refusals.most_common()
        confirmed, raised = int(tracks.confirmed.sum()), int(tracks.raised.sum())
        chosen = tracks.selected_id
        return Status(
            "customers",
            OK,
            f"{confirmed} known, {raised} with a hand up",
            {
                "tracks": len(tracks),
                "confirmed": confirmed,
                "raised": raised,
                "selected_id": "none" if chosen is None else chosen,
                "hands_not_raised": "; ".join(f"{why.words}: {count}" for why, count in refusals),
                "has_pose": self._last.customer_pose is not None,
            },
        )

    def _is_settling(self) -> bool:
        return self._listening_ns is not None and self._since(self._listening_ns) < SILENT_S

    def _since(self, then_ns: int) -> float:
        return (self._steady_ns() - then_ns) / 1e9

    def _increase(self, name: str) -> int:
        return self._reports[-1][1][name] - self._reports[0][1][name]

    def _rate(self, name: str) -> float:
        elapsed_s = (self._reports[-1][0] - self._reports[0][0]) / 1e9
        return self._increase(name) / elapsed_s if elapsed_s > 0 else 0.0


def encode_statuses(statuses: list[Status], stamp_ns: int, node_name: str) -> Encoded:
    """A diagnostic_msgs/DiagnosticArray.

    Args:
        statuses: The lines of the report.
        stamp_ns: On the node's clock.
        node_name: With its namespace, as `robot1/hand_detector`: two robots report on one topic.
    """
    lines = [
        build(
            "diagnostic_msgs/msg/DiagnosticStatus",
            level=status.level,
            name=f"{node_name}: {status.name}",
            message=status.message,
            hardware_id=node_name,
            values=[
                build("diagnostic_msgs/msg/KeyValue", key=key, value=str(value))
                for key, value in status.values.items()
            ],
        )
        for status in statuses
    ]
    return serialize(build(DIAGNOSTICS_TYPE, header=header(stamp_ns, ""), status=lines))


def _work_values(work: Collection[PerceptionWork]) -> dict[str, object]:
    """What perception did of late: counts on average, times in the middle."""
    stages = {name: np.array([getattr(each, f"{name}_s") for each in work]) for name in _STAGES}
    return {
        "places_searched_mean": f"{np.mean([each.places for each in work]):.1f}",
        "hands_read_mean": f"{np.mean([each.hands for each in work]):.1f}",
        "place_bar_max": f"{max(each.place_bar for each in work):.1f}",
        **{f"{name}_ms_median": _milliseconds(times, 50) for name, times in stages.items()},
    }


def _milliseconds(values_s: np.ndarray, percentile: float) -> str:
    return f"{1e3 * float(np.percentile(values_s, percentile)):.1f}"
