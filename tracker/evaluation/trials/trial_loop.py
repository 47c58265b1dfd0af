"""All frames of a trial through the tracker in one loop: what `PersonTracker` does one by one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.compiling.loops import loop, maker
from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.containers.arrays import COUNTS, frozen, sealed
from tracker.evaluation.metrics.frames import TrackFrames
from tracker.evaluation.trials.machine_code import machine_code
from tracker.evaluation.trials.people_sensing import SensedFrames
from tracker.tracking.frame import track_frame
from tracker.tracking.instant import Instant
from tracker.tracking.life_cycle.renewal import Frame
from tracker.tracking.people import CONFIRMED, ID, RAISED, People, room_for
from tracker.tracking.person_tracker import NO_LIKENESS
from tracker.tracking.prediction.motion import modes_of
from tracker.tracking.sensing.claims import Claims, claims_of
from tracker.tracking.settings import Settings, settings_of
from tracker.tracking.trace import NO_TRACE, Trace
from tracker.tracking.update.bias import BIAS

#: There is room for so many customers a frame at first.
PEOPLE_EXPECTED = 8


class Given(NamedTuple):
    """What the tracker is given over T frames.

    Attributes:
        stamps_ns: Shape (T,).
        claims: One frame's behind the other's.
        begins: Shape (T + 1,): row of each frame's first claim, and how many there are.
        dt_s: Shape (T,): since the frame before.
        camera_views: Shape (T, 5), as `view_numbers` has them.
        scan_views: Shape (T, 5), or (T, 0) without a laser.
    """

    stamps_ns: IntArray
    claims: Claims
    begins: IntArray
    dt_s: FloatArray
    camera_views: FloatArray
    scan_views: FloatArray


class TrackRows(NamedTuple):
    """The confirmed customers of T frames, one frame's behind the other's.

    Attributes:
        counts: Shape (T,): how many rows are each frame's.
        id: Shape (R,); with room behind them, as the rest.
        xy_m: Shape (R, 2).
        covariance_m2: Shape (R, 2, 2), with what lasts, as `Tracks.covariance`.
        raised: Shape (R,).
    """

    counts: IntArray
    id: IntArray
    xy_m: FloatArray
    covariance_m2: FloatArray
    raised: BoolArray


def track_sensed(stamps_ns: IntArray, sensed: SensedFrames, config: Config) -> TrackFrames:
    """The confirmed customers that a tracker of their own makes of T frames.

    Args:
        stamps_ns: Shape (T,), ascending.
        sensed: T frames.
        config: The tracker's parameters.
    """
    dt_s = np.diff(stamps_ns, prepend=stamps_ns[:1]) / 1e9
    given = Given(
        frozen(stamps_ns, COUNTS),
        claims_of(sensed.measurements),
        frozen(sensed.begins, COUNTS),
        sealed(dt_s),
        _views(sensed.poses, sensed.field_of_view_rad),
        _views(sensed.poses, 2.0 * np.pi) if sensed.has_scan else sealed(np.zeros((len(dt_s), 0))),
    )
    nobody = room_for(modes_of(config), 0, config.confirm_window)
    track = machine_code(track_trial)
    rows = track(given, nobody, NO_LIKENESS, settings_of(config), NO_TRACE)
    end = int(rows.counts.sum())
    return TrackFrames.from_rows(
        rows.counts, rows.id[:end], rows.xy_m[:end], rows.covariance_m2[:end], rows.raised[:end]
    )


def track_trial(
    given: Given, people: People, likeness: FloatArray, settings: Settings, trace: Trace
) -> TrackRows:
    """Track over all frames.

    Args:
        given: T frames.
        people: Nobody.
        likeness: None, as of `track_frame`.
        settings: Of the tracker.
        trace: Nobody watches.
    """
    frames, end = len(given.stamps_ns), 0
    next_id, next_bystander = 1, -1
    rows = _room(frames, PEOPLE_EXPECTED * frames)
    for frame in range(frames):
        claims = _between(given.claims, given.begins[frame], given.begins[frame + 1])
        instant = Instant(
            given.stamps_ns[frame], given.dt_s[frame], next_id, next_bystander,
            given.camera_views[frame], given.scan_views[frame],
            given.scan_views.shape[1] > 0, True,
        )  # fmt: skip
        now = track_frame(people, claims, instant, likeness, settings, trace)
        people, next_id, next_bystander = now.people, now.next_id, now.next_bystander
        if end + people.weight.shape[1] > len(rows.id):
            rows = _with_more_room(rows, end + people.weight.shape[1])
        rows.counts[frame] = _write_customers(now, rows, end)
        end += rows.counts[frame]
    return rows


@maker
def _between(claims: Claims, begin: int, end: int) -> Claims:
    return Claims(
        claims.values[begin:end], claims.noise[begin:end], claims.kind[begin:end],
        claims.pose[begin:end], claims.doubt[begin:end], claims.raised[begin:end],
        claims.body[begin:end], claims.hand[begin:end], claims.tag[begin:end],
        claims.bias[begin:end],
    )  # fmt: skip


@loop
def _write_customers(now: Frame, rows: TrackRows, begin: int) -> int:
    """Write those who are confirmed to the rows from `begin` on; gives how many they are."""
    row, people = begin, now.people
    for person in range(people.weight.shape[1]):
        if people.flags[CONFIRMED, person] and people.counts[ID, person] > 0:
            rows.id[row] = people.counts[ID, person]
            rows.raised[row] = people.flags[RAISED, person]
            for i in range(2):
                rows.xy_m[row, i] = now.mean[0, person, i]
                for j in range(2):
                    rows.covariance_m2[row, i, j] = now.covariance[0, person, i, j]
            for item, i, j in BIAS:
                rows.covariance_m2[row, i, j] += people.spans[item, person]
            row += 1
    return row - begin


@maker
def _room(frames: int, rows: int) -> TrackRows:
    return TrackRows(
        np.empty(frames, np.int64), np.empty(rows, np.int64), np.empty((rows, 2)),
        np.empty((rows, 2, 2)), np.empty(rows, np.bool_),
    )  # fmt: skip


@maker
def _with_more_room(rows: TrackRows, least: int) -> TrackRows:
    """The same rows, with room for twice as many, and for `least`."""
    wide = _room(0, max(2 * len(rows.id), least))
    for row in range(len(rows.id)):
        wide.id[row], wide.raised[row] = rows.id[row], rows.raised[row]
        for i in range(2):
            wide.xy_m[row, i] = rows.xy_m[row, i]
            for j in range(2):
                wide.covariance_m2[row, i, j] = rows.covariance_m2[row, i, j]
    return TrackRows(rows.counts, wide.id, wide.xy_m, wide.covariance_m2, wide.raised)


def _views(poses: FloatArray, field_of_view_rad: float) -> FloatArray:
    width, reach = np.full((2, len(poses)), [[field_of_view_rad], [np.inf]])
    return sealed(np.column_stack([poses, width, reach]))
