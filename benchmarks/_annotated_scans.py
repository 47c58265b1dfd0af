"""Does the scan's segmentation find people where somebody has marked their legs in a recording?

Reads bags in which every scan (/training_scan, or any other LaserScan) is followed or preceded by
the legs marked in it (geometry_msgs/PoseArray, in the laser's frame); the n-th marks belong to the
n-th scan, whatever their stamps say.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray, Scan
from tracker.errors import RecordingError
from tracker.geometry import RigidTransform
from tracker.messages.decode import scan_from_message
from tracker.ranging import locate_scan, scan_people

_SCAN, _MARKS = "sensor_msgs/msg/LaserScan", "geometry_msgs/msg/PoseArray"

#: Marks closer together than this are legs of one person.
_STEP_M = 0.8


@dataclass(frozen=True, slots=True)
class ClusterScore:
    """How well clusters and marked people agree.

    Attributes:
        people: Marked, over all scans.
        found: Those with a cluster near them.
        clusters: Found, over all scans ...
        right: ... and those near somebody marked. Whoever is there and not marked counts against
            the clusters: precision is a lower bound.
        distance_m: Median, from marked people to their clusters.
    """

    people: int
    found: int
    clusters: int
    right: int
    distance_m: float

    @property
    def recall(self) -> float:
        """Share of the marked people who were found."""
        return self.found / self.people if self.people else float("nan")

    @property
    def precision(self) -> float:
        """Share of the clusters that are somebody marked."""
        return self.right / self.clusters if self.clusters else float("nan")


def score_clusters(
    path: str | Path, config: Config | None = None, within_m: float = 0.3
) -> ClusterScore:
    """Compare the clusters of a recording's scans with the people marked in them.

    Args:
        path: A bag with scans and marks.
        config: The ranging group.
        within_m: A cluster this near to a marked person is that person.

    Raises:
        RecordingError: The bag cannot be read, or scans and marks do not come in pairs.
    """
    config = config or Config()
    people = clusters = right = 0
    nearest: list[float] = []
    for scan, legs_xy_m in read_annotated_scans(path):
        marked = _join_legs(legs_xy_m)
        found = scan_people(locate_scan(scan, RigidTransform()), config).xy_m
        distance = np.linalg.norm(marked[:, None] - found, axis=-1)
        people += len(marked)
        clusters += len(found)
        right += int(np.count_nonzero(distance.min(axis=0, initial=np.inf) <= within_m))
        nearest += distance.min(axis=1, initial=np.inf).tolist()
    hits = [value for value in nearest if value <= within_m]
    median = float(np.median(hits)) if hits else float("nan")
    return ClusterScore(people, len(hits), clusters, right, median)


def read_annotated_scans(path: str | Path) -> Iterator[tuple[Scan, FloatArray]]:
    """Each scan with the legs marked in it, shape (L, 2), in the laser's frame.

    Raises:
        RecordingError: The bag cannot be read, or scans and marks do not come in pairs.
    """
    from rosbags.highlevel import AnyReader, AnyReaderError

    scans, marks = [], []
    try:
        with AnyReader([Path(path)]) as reader:
            for connection, _, raw in reader.messages():
                if connection.msgtype == _SCAN:
                    scans.append(scan_from_message(reader.deserialize(raw, _SCAN)))
                elif connection.msgtype == _MARKS:
                    poses = reader.deserialize(raw, _MARKS).poses  # type: ignore[attr-defined]
                    places = [(pose.position.x, pose.position.y) for pose in poses]
                    marks.append(np.array(places).reshape(-1, 2))
    except (AnyReaderError, OSError) as error:
        raise RecordingError(f"{path}: is not a bag that can be read ({error}).") from error
    if len(scans) != len(marks) or not scans:
        raise RecordingError(
            f"{path}: holds {len(scans)} scans and {len(marks)} PoseArrays; expected one "
            "PoseArray with the marked legs for each scan."
        )
    yield from zip(scans, marks, strict=True)


def _join_legs(legs_xy_m: FloatArray) -> FloatArray:
    """Middles of the marked people, shape (P, 2): legs within a step of each other are one's."""
    people: list[FloatArray] = []
    left = list(legs_xy_m)
    while left:
        first = left.pop(0)
        own = [leg for leg in left if np.linalg.norm(leg - first) <= _STEP_M]
        left = [leg for leg in left if np.linalg.norm(leg - first) > _STEP_M]
        people.append(np.mean([first, *own], axis=0))
    return np.array(people).reshape(-1, 2)
