import numpy as np
import pytest

from tracker import Scan
from tracker.errors import ClockError
from tracker.geometry import RigidTransform
from tracker.transforms import StampedTransform
from tracker.waiting import WaitingRoom

S = 1_000_000_000


def base(stamp_s, x_m=0.0):
    moved = RigidTransform((x_m, 0.0, 0.0))
    return StampedTransform(round(stamp_s * S), "map", "base_link", moved)


def scan(stamp_s):
    return Scan(round(stamp_s * S), "laser", 0.0, 0.1, 0.1, 10.0, np.ones(3))


def room_with(*samples):
    room = WaitingRoom(10.0)
    for sample in samples:
        room.add_transform(sample)
    return room


@pytest.mark.parametrize(
    "odd_s", [0.0, 5.0, 160.0, 2.0**31], ids=["zero", "long-ago", "a-minute-ahead", "far-ahead"]
)
def test_one_transform_with_an_odd_stamp_is_refused_and_outdates_none(odd_s):
    room = room_with(base(100.0, 1.0), base(100.2, 1.2))
    with pytest.raises(ClockError, match="far from the one before"):
        room.add_transform(base(odd_s))
    assert room.transforms.lookup("map", "base_link", 100 * S + S // 10).translation_m[0] == 1.1


def test_the_odd_stamp_of_a_new_frame_is_held_against_the_others():
    room = room_with(base(100.0))
    with pytest.raises(ClockError, match="'wheel'"):
        room.add_transform(StampedTransform(3 * S, "base_link", "wheel", RigidTransform()))


def test_transforms_of_a_new_earlier_time_replace_those_of_before():
    room = room_with(base(100.0, 1.0), base(100.2, 1.2))
    with pytest.raises(ClockError):
        room.add_transform(base(95.0, 5.0))
    room.add_transform(base(95.1, 5.1))
    room.add_transform(base(95.3, 5.3))
    assert room.transforms.lookup("map", "base_link", round(95.2 * S)).translation_m[0] == (
        pytest.approx(5.2)
    )
    assert not room.transforms.can_lookup("map", "base_link", 100 * S)


def test_a_late_transform_is_used():
    room = room_with(base(100.0, 0.0), base(100.4, 4.0), base(100.2, 3.0))
    assert room.transforms.lookup("map", "base_link", round(100.2 * S)).translation_m[0] == 3.0


def test_scans_come_nearest_first():
    room = WaitingRoom(10.0)
    for stamp_s in (1.0, 1.1, 1.2, 1.3):
        room.add_scan(scan(stamp_s))
    found = [one.stamp_ns / S for one in room.scans_by_age(round(1.14 * S))]
    assert found == [1.1, 1.2, 1.0, 1.3]
    room.forget_scans_after(round(1.1 * S))
    assert len(room.scans_by_age(0)) == 2


def test_a_reset_forgets_scans_and_moving_transforms():
    room = room_with(
        base(100.0), StampedTransform(0, "base_link", "laser", RigidTransform(), True)
    )
    room.add_scan(scan(100.0))
    room.reset()
    assert room.scans_by_age(0) == []
    assert room.transforms.can_lookup("base_link", "laser", 3 * S)
    room.add_transform(base(2.0))  # any time is believed again
    assert room.transforms.can_lookup("map", "laser", 2 * S)
