"""What do measurements have in common? Groups of one kind and one sensor pose share their math.

Nearly always one camera has measured everything in a frame: then what it would see of each track
has to be worked out once, not once for each pair.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tracker.containers import FloatArray, IntArray, Measurements, SensorKind


@dataclass(frozen=True, slots=True, eq=False)
class ClaimGroup:
    """Measurements of one kind from one sensor pose.

    Attributes:
        rows: Shape (G,): their rows among all measurements.
        values: Shape (G, 2); the second is 0 for bearings alone.
        noise: Shape (G, 2, 2); 1 in the last place for bearings alone, without correlation.
        polar: Bearings, with or without a range; otherwise positions.
        ranged: There is a second number; otherwise bearings alone.
        sensor_pose: Shape (3,).
        sensor_pose_covariance: Shape (3, 3), or None where the pose is well known.
    """

    rows: IntArray
    values: FloatArray
    noise: FloatArray
    polar: bool
    ranged: bool
    sensor_pose: FloatArray
    sensor_pose_covariance: FloatArray | None


def group_claims(claims: Measurements) -> Iterator[ClaimGroup]:
    """Split measurements into groups; together they hold every row once.

    Args:
        claims: M usable measurements.
    """
    if len(claims) == 0:
        return
    kind = claims.kind
    pose, doubt = claims.sensor_pose, claims.sensor_pose_covariance
    is_doubtful = bool(doubt.any())
    if (
        (kind == kind[0]).all()
        and (pose == pose[0]).all()
        and not (is_doubtful and (doubt != doubt[0]).any())
    ):
        yield _group(claims, np.arange(len(claims)), int(kind[0]), is_doubtful)
        return
    keys = np.concatenate([kind[:, None], pose, doubt.reshape(-1, 9)], axis=1)
    _, member = np.unique(keys, axis=0, return_inverse=True)
    member = member.reshape(-1)  # some versions of NumPy give it a second axis
    order = np.argsort(member, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(member[order])) + 1):
        yield _group(claims, rows, int(kind[rows[0]]), is_doubtful)


def _group(claims: Measurements, rows: IntArray, kind: int, is_doubtful: bool) -> ClaimGroup:
    # Nearly always it is all of them, and then nothing needs to be picked.
    picked = rows if len(rows) < len(claims) else slice(None)
    values, noise = claims.values[picked], claims.covariance[picked]
    ranged = kind != SensorKind.BEARING
    if not ranged:
        values, noise = values.copy(), noise.copy()
        values[:, 1] = 0.0
        noise[:, 1, :] = noise[:, :, 1] = 0.0
        noise[:, 1, 1] = 1.0
    polar = kind != SensorKind.POSITION
    doubt = claims.sensor_pose_covariance[rows[0]] if polar and is_doubtful else None
    return ClaimGroup(rows, values, noise, polar, ranged, claims.sensor_pose[rows[0]], doubt)
