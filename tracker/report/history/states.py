"""When did each person exist, and was fresh, raised and served; and how certain was it?

Kept beside `History` for the pages that want more than intervals. Bounded in memory: rows are
thinned, and whoever was last seen longest ago leaves.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from tracker.config import Config
from tracker.containers import FloatArray, FrameResult
from tracker.geometry import worst_std
from tracker.report.history.trail import Trail

_PEOPLE_KEPT = 100
_ROWS_KEPT = 400


@dataclass(slots=True, eq=False)
class PersonStates:
    """One confirmed customer, image by image.

    Attributes:
        id: The track's id.
        last_ns: Stamp of the newest row.
    """

    id: int
    last_ns: int = 0
    _trail: Trail = field(default_factory=lambda: Trail(8, capacity=_ROWS_KEPT))

    def append(self, stamp_ns: int, at_s: float, *numbers: float) -> None:
        """Take in an image: seconds, then the numbers of the properties below."""
        self.last_ns = stamp_ns
        self._trail.append(at_s, *numbers)

    @property
    def at_s(self) -> FloatArray:
        """Shape (R,): seconds since the first image."""
        return self._trail.rows[:, 0]

    @property
    def xy_m(self) -> FloatArray:
        """Shape (R, 2): place in the fixed frame."""
        return self._trail.rows[:, 1:3]

    @property
    def covariance_m2(self) -> FloatArray:
        """Shape (R, 2, 2): of the place."""
        return self._trail.rows[:, [3, 4, 4, 5]].reshape(-1, 2, 2)

    @property
    def existence(self) -> FloatArray:
        """Shape (R,): probability that the person is there."""
        return self._trail.rows[:, 6]

    @property
    def is_fresh(self) -> FloatArray:
        """Shape (R,): 1 where the estimate was recent and certain enough to drive to, else 0."""
        return self._trail.rows[:, 7]


class States:
    """Collects from every processed image.

    Args:
        config: `pose_max_std_m` and `pose_max_age_s` say what fresh is.

    Attributes:
        people: Confirmed customers by id, in the order they came.
    """

    def __init__(self, config: Config) -> None:
        self.people: dict[int, PersonStates] = {}
        self._config = config
        self._start_ns: int | None = None

    def write(self, result: FrameResult) -> None:
        """Take in what one image led to."""
        if self._start_ns is None:
            self._start_ns = result.stamp_ns
        at_s = (result.stamp_ns - self._start_ns) / 1e9
        tracks = result.tracks[result.tracks.confirmed]
        covariances = tracks.covariance[:, :2, :2]
        worst_m = worst_std(covariances)
        is_fresh = (tracks.unseen_s <= self._config.pose_max_age_s) & (
            worst_m <= self._config.pose_max_std_m
        )
        for row, track_id in enumerate(tracks.id.tolist()):
            x, y = tracks.mean[row, :2].tolist()
            (xx, xy), (_, yy) = covariances[row].tolist()
            existence, fresh = float(tracks.existence[row]), float(is_fresh[row])
            person = self.people.setdefault(track_id, PersonStates(track_id))
            person.append(result.stamp_ns, at_s, x, y, xx, xy, yy, existence, fresh)
        while len(self.people) > _PEOPLE_KEPT:
            gone = min(self.people.values(), key=lambda person: person.last_ns)
            del self.people[gone.id]
