"""Frames of people as the tracker gives them, ten a second, told in a few words."""

from dataclasses import replace

import numpy as np
import pytest

from tracker import Config, Tracks
from tracker.service import CallKeeper, Command

PERIOD_NS = 100_000_000


def tracks_of(stamp_ns, people, up, since_ns):
    """Tracks of `people`, identity -> (x_m, y_m); hands of `up` are raised since `since_ns`."""
    ids = np.array(sorted(people), dtype=np.int64)
    count = len(ids)
    mean = np.zeros((count, 4))
    mean[:, :2] = np.array([people[track_id] for track_id in ids.tolist()]).reshape(-1, 2)
    ones = np.ones(count, dtype=bool)
    return replace(
        Tracks.none(stamp_ns),
        id=ids,
        mean=mean,
        covariance=np.tile(0.01 * np.eye(4), (count, 1, 1)),
        existence=np.ones(count),
        confirmed=ones,
        raised=np.isin(ids, sorted(up)),
        raised_since_ns=np.array([since_ns.get(one, -1) for one in ids.tolist()], dtype=np.int64),
        age_s=np.ones(count),
        unseen_s=np.zeros(count),
        hand=-np.ones(count, dtype=np.int64),
        gesture=np.zeros(count, dtype=np.int64),
    )


class Room:
    """A call keeper and its clock."""

    def __init__(self, **parameters):
        self.keeper = CallKeeper(Config(**parameters))
        self.stamp_ns = 10**12
        self.since_ns = {}
        self.robot_xy_m = np.zeros(2)
        self.scan_view = None

    def run(self, seconds, people, up=()):
        """Let people stand there for a while, some with a hand up."""
        for _ in range(round(seconds * 10)):
            self.stamp_ns += PERIOD_NS
            self.since_ns = {one: self.since_ns.get(one, self.stamp_ns) for one in up}
            tracks = tracks_of(self.stamp_ns, people, up, self.since_ns)
            self.keeper.step(tracks, self.robot_xy_m, self.scan_view)
        return self.keeper.now

    def say(self, text):
        return self.keeper.obey(Command.parse(text))

    @property
    def states(self):
        """Number -> state, in the order of service."""
        return {caller.id: caller.state.value for caller in self.keeper.now.callers}


@pytest.fixture
def make_room():
    return Room
