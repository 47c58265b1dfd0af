"""Who has called, since when, and what has become of it?"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import numpy as np

from tracker.errors import RecordingError

#: Numbers and stamps have 64 bits; half of them leave room for those that follow.
_NUMBERS_END = 2**62


class CallState(str, Enum):
    """What has become of a call; the values are the words of messages and files."""

    WAITING = "waiting"
    BEING_SERVED = "being_served"
    SERVED = "served"
    GONE = "gone"
    IGNORED = "ignored"

    @property
    def is_open(self) -> bool:
        """Whether somebody still has to come to this customer."""
        return self in (CallState.WAITING, CallState.BEING_SERVED)


@dataclass(frozen=True, slots=True)
class Caller:
    """One person who has called, seen now or not.

    Attributes:
        id: The person's number on the list: the identity of the track that called first. It
            stays when the person is lost and found again under another identity.
        state: What has become of the call.
        called_ns: Stamp at which the hand went up for this call.
        state_since_ns: Stamp at which `state` last changed.
        raised_since_ns: Stamp at which the hand last went up.
        last_up_ns: Stamp of the last image in which the hand counted as raised.
        is_up: Whether the hand is up now.
        xy_m: Where the person was last seen, in the fixed frame.
        covariance_m2: Of that place: xx, xy, yy, in square meters.
        seen_ns: Stamp of that sighting.
        track_id: The identity in `Tracks` that the person has now; None while out of sight, below
            0 while only the scan shows them.
        postponed_ns: Stamp at which the call was put behind the others; 0 where it never was.
        missing_s: For how long the scan has shown nobody at that place, though in its view.
    """

    id: int
    state: CallState
    called_ns: int
    state_since_ns: int
    raised_since_ns: int
    last_up_ns: int
    is_up: bool
    xy_m: tuple[float, float]
    covariance_m2: tuple[float, float, float]
    seen_ns: int
    track_id: int | None = None
    postponed_ns: int = 0
    missing_s: float = 0.0


@dataclass(frozen=True, slots=True)
class WaitingList:
    """Everybody who has called, at one instant.

    Attributes:
        stamp_ns: When it holds.
        callers: In the order of service: those being served, the last one first; those who wait,
            the next one first; those whose call is over.
        selected_id: Number of the customer to whom the robot should go now, or None.
    """

    stamp_ns: int = 0
    callers: tuple[Caller, ...] = field(default=())
    selected_id: int | None = None

    def __len__(self) -> int:
        return len(self.callers)

    def find(self, caller_id: int | None) -> Caller | None:
        """The caller with a number, or None."""
        return next((caller for caller in self.callers if caller.id == caller_id), None)

    @property
    def selected(self) -> Caller | None:
        """The customer to whom the robot should go now."""
        return self.find(self.selected_id)

    @property
    def selected_track_id(self) -> int | None:
        """That customer's identity in `Tracks`; None while they are not tracked as a customer."""
        selected = self.selected
        track_id = None if selected is None else selected.track_id
        return None if track_id is None or track_id < 0 else track_id

    @property
    def waiting(self) -> tuple[Caller, ...]:
        """Who waits, the next one first."""
        return tuple(caller for caller in self.callers if caller.state is CallState.WAITING)

    def to_json(self) -> str:
        """A text for `from_json`, to store the list while the program is not running."""
        callers = [
            {name: getattr(caller, name) for name in Caller.__slots__} for caller in self.callers
        ]
        return json.dumps(
            {"stamp_ns": self.stamp_ns, "selected_id": self.selected_id, "callers": callers}
        )

    @staticmethod
    def from_json(text: str) -> WaitingList:
        """Read the text of `to_json`. Nobody is in sight: the tracks of that run no longer exist.

        Raises:
            RecordingError: The text is no such list.
        """
        try:
            said = json.loads(text)
            callers = tuple(_caller(item) for item in said["callers"])
            selected_id = said["selected_id"]
            found = WaitingList(
                _whole(said["stamp_ns"]), callers, selected_id and _whole(selected_id)
            )
        except (KeyError, TypeError, ValueError, OverflowError, RecursionError) as error:
            raise RecordingError(
                f"This is not a waiting list ({type(error).__name__}: {error}). Delete the file; "
                "the list then starts empty."
            ) from error
        return found


def _caller(item: Mapping[str, Any]) -> Caller:
    x, y = map(float, item["xy_m"])
    xx, xy, yy = map(float, item["covariance_m2"])
    if not np.isfinite([x, y, xx, xy, yy]).all() or min(xx, yy, xx * yy - xy * xy) < 0.0:
        raise ValueError("a place or covariance is invalid")
    stamps = {name: _whole(item[name]) for name in Caller.__slots__ if name.endswith("_ns")}
    return Caller(
        id=_whole(item["id"], least=1),
        state=CallState(item["state"]),
        is_up=False,
        xy_m=(x, y),
        covariance_m2=(xx, xy, yy),
        **stamps,
    )


def _whole(said: Any, least: int = 0) -> int:
    """A number of a customer, or a stamp."""
    number = int(said)
    if not least <= number < _NUMBERS_END:
        raise ValueError(f"{number} is out of range")
    return number
