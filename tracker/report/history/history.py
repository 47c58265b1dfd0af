"""What is kept of a whole recording for its pictures and its summary?

Little: memory stays bounded however long the recording is. Paths are thinned, scans fall into a
grid of fixed size, and beyond `PEOPLE_KEPT` whoever was last seen longest ago leaves (tracks.csv
still has them).
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray, FrameResult, Refusal, Tracks
from tracker.geometry import worst_std
from tracker.gesture import Gesture
from tracker.notes import NoteKind
from tracker.report.fan import PLACED_STD_M, direction, fan
from tracker.report.history.hit_grid import HitGrid
from tracker.report.history.trail import Trail

PEOPLE_KEPT = 1000


@dataclass(slots=True, eq=False)
class Span:
    """An interval of time; `end_ns` is None while it lasts."""

    start_ns: int
    end_ns: int | None = None


@dataclass(slots=True, eq=False)
class RaisedHand(Span):
    """One time that a person's hand was up, as the tracker reported it.

    Attributes:
        xy_m: Shape (2,): where the person was when it was first reported, supposed or known.
        covariance_m2: Shape (2, 2): of that place.
        camera_xy_m: Shape (2,): where the camera was then.
        frames: Processed images with the hand up.
        placed: Those of them in which the person's place was known.
        sum_xy_m: Shape (2,): sum of the person's positions over these.
    """

    xy_m: FloatArray = field(default_factory=lambda: np.zeros(2))
    covariance_m2: FloatArray = field(default_factory=lambda: np.zeros((2, 2)))
    camera_xy_m: FloatArray = field(default_factory=lambda: np.zeros(2))
    frames: int = 0
    placed: int = 0
    sum_xy_m: FloatArray = field(default_factory=lambda: np.zeros(2))

    @property
    def mean_xy_m(self) -> FloatArray | None:
        """Shape (2,): where the person was on average while the hand was up; None if unknown."""
        return np.asarray(self.sum_xy_m / self.placed) if self.placed else None

    @property
    def direction_rad(self) -> tuple[float, float]:
        """Bearing from the camera at which the hand was first reported, and its deviation."""
        return direction(self.xy_m, self.covariance_m2, self.camera_xy_m)

    @property
    def fan_rad(self) -> tuple[float, float]:
        """Right and left edge of the fan that shows this direction."""
        return fan(self.xy_m, self.covariance_m2, self.camera_xy_m)


@dataclass(slots=True, eq=False)
class SaidByHand(Span):
    """How long a person's hand said one thing."""

    gesture: Gesture = Gesture.NONE


@dataclass(slots=True, eq=False)
class Person:
    """One confirmed customer.

    Attributes:
        id: The track's id.
        first_seen_ns: When the track began, tentatively.
        confirmed_ns: When it was first believed.
        last_seen_ns: The last image in which the tracker knew this person.
        path: Rows of x_m, y_m, while the place was known.
        hands: Each time the hand was up, in order of time.
        selected: Each time this person was the one served, in order of time.
        said: What the hand said, in order of time.
        states: Rows of seconds since the start, existence (a probability), and 1 where the
            estimate was recent and certain enough to drive to, else 0.
    """

    id: int
    first_seen_ns: int
    confirmed_ns: int
    last_seen_ns: int
    path: Trail = field(default_factory=lambda: Trail(2, capacity=256))
    hands: list[RaisedHand] = field(default_factory=list)
    selected: list[Span] = field(default_factory=list)
    said: list[SaidByHand] = field(default_factory=list)
    states: Trail = field(default_factory=lambda: Trail(3, capacity=128))


class History:
    """Collects from every processed image.

    Args:
        config: `pose_max_std_m` and `pose_max_age_s` say what is certain and recent.

    Attributes:
        people: Confirmed customers by id, in the order they came.
        people_dropped: Earlier people who were given up to bound memory.
        frames_processed: Images so far.
        frames_raised: Images after which some hand was up.
        hands_not_raised: For each reason, the images in which a hand was not raised for it.
        camera_path: Rows of x_m, y_m, yaw_rad of the camera in the fixed frame.
        walls: Where scans met something.
        start_ns: Stamp of second 0, the first image's; None before it.
        end_ns: Stamp of the newest image, or None before the first.
    """

    def __init__(self, config: Config | None = None) -> None:
        self._config = config or Config()
        self.people: dict[int, Person] = {}
        self.people_dropped = 0
        self.frames_processed = 0
        self.frames_raised = 0
        self._notes: Counter[NoteKind] = Counter()
        self._first_notes: dict[NoteKind, str] = {}
        self.hands_not_raised: Counter[Refusal] = Counter()
        self.camera_path = Trail(3, capacity=2048)
        self.walls = HitGrid()
        self.start_ns: int | None = None
        self.end_ns: int | None = None
        self._duration_ns = 0
        self._scan_stamp_ns = -1
        self._open_hands: dict[int, RaisedHand] = {}
        self._open_selection: dict[int, Span] = {}
        self._open_said: dict[int, SaidByHand] = {}

    def write(self, result: FrameResult) -> None:
        """Take in what one image led to; a stamp that jumps back ends all that lasts."""
        if self.start_ns is None:
            self.start_ns = result.stamp_ns
        if self.end_ns is not None:
            if result.stamp_ns < self.end_ns:
                self._end_all(self.end_ns)
            self._duration_ns += max(0, result.stamp_ns - self.end_ns)
        self.end_ns = result.stamp_ns
        self.frames_processed += 1
        self.frames_raised += int(result.hand_raised)
        for note in result.notes:
            if note.kind is NoteKind.NEW_FIXED_FRAME:
                self._forget_places()
            self._notes[note.kind] += 1
            self._first_notes.setdefault(note.kind, note.text)
        self.hands_not_raised.update(result.hands.refusals.keys())
        if result.sensor_pose is not None:
            x, y, yaw = result.sensor_pose
            self.camera_path.append(float(x), float(y), float(yaw))
        scan = result.scan
        if scan is not None:
            if scan.stamp_ns != self._scan_stamp_ns:  # two images may share one
                self.walls.add(scan)
            self._scan_stamp_ns = scan.stamp_ns
        is_known = result.sensor_pose is not None or not len(self.camera_path)
        self._write_people(result.tracks[result.tracks.confirmed], is_known=is_known)

    @property
    def notes(self) -> dict[str, int]:
        """How many images carried each kind of note; the key is the first one's text."""
        return {self._first_notes[kind]: count for kind, count in self._notes.most_common()}

    @property
    def duration_s(self) -> float:
        """Sensor time covered by the images, jumps backwards not counted."""
        return self._duration_ns / 1e9

    def seconds(self, stamp_ns: int) -> float:
        """A stamp as seconds since the start."""
        return (stamp_ns - (self.start_ns or 0)) / 1e9

    def _write_people(self, tracks: Tracks, *, is_known: bool) -> None:
        now_ns = tracks.stamp_ns
        camera = self.camera_path.rows
        camera_xy_m = camera[-1, :2].copy() if len(camera) else np.zeros(2)
        worst_m = worst_std(tracks.covariance[:, :2, :2])
        is_placed = (worst_m <= PLACED_STD_M) & is_known
        is_fresh = worst_m <= self._config.pose_max_std_m
        is_fresh &= tracks.unseen_s <= self._config.pose_max_age_s
        for row, track_id in enumerate(tracks.id.tolist()):
            xy = tracks.mean[row, :2]
            person = self.people.get(track_id)
            if person is None:
                began_ns = now_ns - round(float(tracks.age_s[row]) * 1e9)
                person = self.people[track_id] = Person(track_id, began_ns, now_ns, now_ns)
            person.last_seen_ns = now_ns
            existence, fresh = float(tracks.existence[row]), float(is_fresh[row])
            person.states.append(self.seconds(now_ns), existence, fresh)
            if is_placed[row]:
                person.path.append(float(xy[0]), float(xy[1]))
            if tracks.raised[row]:
                hand = self._open_hands.get(track_id)
                if hand is None:
                    covariance = tracks.covariance[row, :2, :2].copy()
                    hand = RaisedHand(now_ns, None, xy.copy(), covariance, camera_xy_m)
                    self._open_hands[track_id] = hand
                    person.hands.append(hand)
                hand.frames += 1
                if is_placed[row]:
                    hand.placed += 1
                    hand.sum_xy_m = hand.sum_xy_m + xy
            if track_id == tracks.selected_id and track_id not in self._open_selection:
                self._open_selection[track_id] = span = Span(now_ns)
                person.selected.append(span)
        raised = set(tracks.id[tracks.raised].tolist())
        for track_id in [key for key in self._open_hands if key not in raised]:
            self._open_hands.pop(track_id).end_ns = now_ns
        for track_id in [key for key in self._open_selection if key != tracks.selected_id]:
            self._open_selection.pop(track_id).end_ns = now_ns
        self._write_said(tracks)
        while len(self.people) > PEOPLE_KEPT:
            gone = min(self.people.values(), key=lambda person: person.last_seen_ns)
            del self.people[gone.id]
            self.people_dropped += 1

    def _write_said(self, tracks: Tracks) -> None:
        codes = zip(tracks.id.tolist(), tracks.gesture.tolist(), strict=True)
        now = {track_id: Gesture(code) for track_id, code in codes if code != Gesture.NONE}
        for track_id, span in list(self._open_said.items()):
            if now.get(track_id) != span.gesture:
                self._open_said.pop(track_id).end_ns = tracks.stamp_ns
        for track_id, gesture in now.items():
            if track_id not in self._open_said:
                span = SaidByHand(tracks.stamp_ns, None, gesture)
                self._open_said[track_id] = span
                self.people[track_id].said.append(span)

    def _forget_places(self) -> None:
        """Places before the first transform were the camera's, not the fixed frame's."""
        for person in self.people.values():
            person.path = Trail(2, capacity=256)
            for hand in person.hands:
                hand.placed, hand.sum_xy_m = 0, np.zeros(2)

    def _end_all(self, stamp_ns: int) -> None:
        for open_spans in (self._open_hands, self._open_selection, self._open_said):
            for span in open_spans.values():
                span.end_ns = stamp_ns
            open_spans.clear()
