"""Where was each frame at a stamp? A time-stamped tree of frames, bounded in memory.

The core's own stand-in for tf2's buffer, for recordings, simulations and machines without ROS. It
interpolates like tf2 (translations linearly, rotations by slerp) and never extrapolates.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from tracker.containers import check_stamp
from tracker.errors import TransformError
from tracker.geometry import RigidTransform, interpolate

#: No frame is farther from its parent; beyond, squares lose what they are made of.
_FARTHEST_M = 1e9


@dataclass(frozen=True, slots=True)
class StampedTransform:
    """`parent_from_child` at one instant, as /tf and /tf_static carry it.

    Attributes:
        stamp_ns: When it holds; ignored for a static one.
        parent: Frame of the result.
        child: Frame of the argument; every child has one parent.
        transform: Takes points of `child` to `parent`.
        is_static: Holds at every time.
    """

    stamp_ns: int
    parent: str
    child: str
    transform: RigidTransform
    is_static: bool = False


class Transforms(Protocol):
    """What the pipeline needs of a transform buffer; `TransformBuffer` comes along."""

    def add(self, sample: StampedTransform) -> None:
        """Take in one transform."""
        ...

    def lookup(self, target: str, source: str, stamp_ns: int) -> RigidTransform:
        """`target_from_source` at a stamp, or a TransformError."""
        ...

    def can_lookup(self, target: str, source: str, stamp_ns: int) -> bool:
        """Whether `lookup` would answer."""
        ...

    @property
    def frames(self) -> set[str]:
        """Every frame heard of."""
        ...

    def forget_after(self, stamp_ns: int) -> None:
        """Drop what is later than a stamp."""
        ...

    def clear(self) -> None:
        """Forget the moving transforms."""
        ...


class TransformBuffer:
    """Remembers transforms for a while and chains them at a stamp.

    Args:
        memory_s: How long a moving transform is kept, by the stamps of its own kind.
    """

    def __init__(self, memory_s: float = 10.0) -> None:
        self._memory_ns = int(memory_s * 1e9)
        self._parent: dict[str, str] = {}
        self._static: dict[str, RigidTransform] = {}
        self._moving: dict[str, list[tuple[int, RigidTransform]]] = {}

    def add(self, sample: StampedTransform) -> None:
        """Take in one transform; a repeated stamp replaces the earlier word.

        Raises:
            TransformError: It would close a circle of frames, has no names or a zero or non-finite
                rotation.
            ClockError: Its stamp is negative.
        """
        check_stamp(sample.stamp_ns)
        sample = checked(sample)
        parent, child, transform = sample.parent, sample.child, sample.transform
        if child in self._chain(parent):
            raise _circle(child, parent)
        if self._parent.get(child, parent) != parent:
            self._moving.pop(child, None)  # those were relative to another frame
        self._parent[child] = parent
        if sample.is_static:
            self._static[child] = transform
            self._moving.pop(child, None)
            return
        self._static.pop(child, None)
        samples = self._moving.setdefault(child, [])
        if samples and sample.stamp_ns < samples[-1][0] - self._memory_ns:
            samples.clear()  # the clock has jumped back, as when a recording loops
        row = bisect_left(samples, sample.stamp_ns, key=_stamp)
        if row < len(samples) and samples[row][0] == sample.stamp_ns:
            samples[row] = (sample.stamp_ns, transform)
        else:
            insort(samples, (sample.stamp_ns, transform), key=_stamp)
        oldest = samples[-1][0] - self._memory_ns
        del samples[: bisect_left(samples, oldest, key=_stamp)]

    def lookup(self, target: str, source: str, stamp_ns: int) -> RigidTransform:
        """`target_from_source` at a stamp.

        Raises:
            TransformError: A frame is unknown, the two are not connected, or the stamp lies
                outside what a link remembers; the message names the link.
        """
        target, source = target.lstrip("/"), source.lstrip("/")
        if target == source:
            return RigidTransform()
        up_source, up_target = self._chain(source), self._chain(target)
        common = next((frame for frame in up_source if frame in up_target), None)
        if common is None:
            raise TransformError(self._unconnected(target, source))
        common_from_source = self._climb(source, common, stamp_ns)
        common_from_target = self._climb(target, common, stamp_ns)
        return common_from_target.inverse() @ common_from_source

    def can_lookup(self, target: str, source: str, stamp_ns: int) -> bool:
        """Whether `lookup` would answer."""
        try:
            self.lookup(target, source, stamp_ns)
        except TransformError:
            return False
        return True

    @property
    def frames(self) -> set[str]:
        """Every frame heard of."""
        return set(self._parent) | set(self._parent.values())

    def forget_after(self, stamp_ns: int) -> None:
        """Drop what is later than a stamp: left over from before the clock jumped back."""
        for samples in self._moving.values():
            del samples[bisect_right(samples, stamp_ns, key=_stamp) :]

    def clear(self) -> None:
        """Forget the moving transforms, after a jump of the clock."""
        for child in list(self._moving):
            del self._moving[child], self._parent[child]

    def _chain(self, frame: str) -> list[str]:
        chain = [frame]
        while chain[-1] in self._parent:
            chain.append(self._parent[chain[-1]])
        return chain

    def _climb(self, frame: str, root: str, stamp_ns: int) -> RigidTransform:
        result = RigidTransform()
        while frame != root:
            result = self._at(frame, stamp_ns) @ result
            frame = self._parent[frame]
        return result

    def _at(self, child: str, stamp_ns: int) -> RigidTransform:
        if child in self._static:
            return self._static[child]
        samples = self._moving[child]
        if not samples:
            raise TransformError(
                f"Transform from {child!r} to {self._parent[child]!r} was not received since the "
                "clock jumped back."
            )
        row = bisect_left(samples, stamp_ns, key=_stamp)
        if row < len(samples) and samples[row][0] == stamp_ns:
            return samples[row][1]
        if row == 0 or row == len(samples):
            first, last = samples[0][0] / 1e9, samples[-1][0] / 1e9
            raise TransformError(
                f"Transform from {child!r} to {self._parent[child]!r} is known from {first:.3f} s "
                f"to {last:.3f} s, not at {stamp_ns / 1e9:.3f} s."
            )
        (before_ns, before), (after_ns, after) = samples[row - 1], samples[row]
        return interpolate(before, after, (stamp_ns - before_ns) / (after_ns - before_ns))

    def _unconnected(self, target: str, source: str) -> str:
        known = self.frames
        missing = [repr(frame) for frame in (target, source) if frame not in known]
        heard = ", ".join(sorted(known)) or "none yet"
        if missing:
            return f"No transform names the frame {' or '.join(missing)}; known frames: {heard}."
        return f"Frames {source!r} and {target!r} are not connected; known frames: {heard}."


def checked(sample: StampedTransform) -> StampedTransform:
    """The transform with plain names and a quaternion of length 1.

    Raises:
        TransformError: It has no two names, a number that is not finite or too large, or no
            rotation; or both names are the same.
    """
    parent, child = sample.parent.lstrip("/"), sample.child.lstrip("/")
    place_m, quaternion = sample.transform.translation_m, sample.transform.quaternion_xyzw
    norm = sum(value * value for value in quaternion) ** 0.5
    is_finite = np.all(np.isfinite((*place_m, *quaternion)))
    is_near = max(abs(value) for value in place_m) <= _FARTHEST_M
    if not parent or not child or not is_finite or not is_near or abs(norm - 1.0) > 0.1:
        raise TransformError(
            f"Transform from {child!r} to {parent!r} is unusable: two names, finite numbers, "
            f"less than {_FARTHEST_M:g} m and a quaternion of length 1 (here {norm:.3g}) are "
            "needed."
        )
    if parent == child:
        raise _circle(child, parent)
    x, y, z, w = (value / norm for value in quaternion)
    transform = RigidTransform(place_m, (x, y, z, w))
    return replace(sample, parent=parent, child=child, transform=transform)


def _circle(child: str, parent: str) -> TransformError:
    return TransformError(f"Transform from {child!r} to {parent!r} closes a loop of frames.")


def _stamp(sample: tuple[int, RigidTransform]) -> int:
    return sample[0]
