"""Who waits for service? A call is kept after the hand goes down.

A call belongs to a person, and a person has one number: a hand that goes up once more while the
call is open changes nothing, and who is lost and found again at the same place keeps the number.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tracker.config import Config
from tracker.containers import Caller, CallState, FloatArray, Tracks, View, WaitingList
from tracker.service.commands import Answer, Command, Verb
from tracker.service.order import choose, in_order
from tracker.service.places import found_again

#: How long a call that is over is still shown (guess).
_SHOWN_NS = 60_000_000_000


class CallKeeper:
    """Remembers who has called. Time is that of the frames; the same frames give the same list.

    Args:
        config: The parameters of the group `service`.
    """

    def __init__(self, config: Config) -> None:
        self.config = config
        self._callers: dict[int, Caller] = {}
        self._now = WaitingList()
        self._robot_xy_m = np.zeros(2)

    @property
    def now(self) -> WaitingList:
        """The list after the last frame or command."""
        return self._now

    @property
    def wants_bystanders(self) -> bool:
        """Whether somebody may be found again among those who have not called."""
        return any(
            caller.state.is_open and (caller.track_id or -1) < 0
            for caller in self._callers.values()
        )

    def step(
        self, tracks: Tracks, robot_xy_m: FloatArray, scan_view: View | None = None
    ) -> WaitingList:
        """Take in one frame.

        Args:
            tracks: Everybody who has called; bystanders too where `wants_bystanders`.
            robot_xy_m: Shape (2,): where the robot is, in the fixed frame.
            scan_view: Where the scan could show people; None where there was none.

        Returns:
            The list after this frame.
        """
        self._robot_xy_m = robot_xy_m
        if self._callers or tracks.raised.any():
            lapse_s = (tracks.stamp_ns - self._now.stamp_ns) / 1e9
            self._look(tracks)
            self._miss(scan_view, lapse_s)
            self._hear(tracks)
            self._end_calls(tracks.stamp_ns)
        return self._renew(tracks.stamp_ns)

    def obey(self, command: Command) -> Answer:
        """Follow a command, at the instant of the last frame.

        Returns:
            What happened, or why not.
        """
        if command.verb is Verb.CLEAR:
            return self._clear()
        caller_id = command.caller_id
        if caller_id is None:
            caller_id = self._now.selected_id
            if caller_id is None:
                return Answer(False, "nobody is selected")
        caller = self._callers.get(caller_id)
        if caller is None:
            known = ", ".join(map(str, sorted(self._callers))) or "nobody"
            return Answer(False, f"no customer has the number {caller_id}; on the list: {known}")
        if command.verb in (Verb.RELEASE, Verb.WAIT) and not caller.state.is_open:
            return Answer(False, f"the call of customer {caller_id} is over: {_words(caller)}")
        state, says = _LEADS_TO[command.verb]
        stamp_ns = self._now.stamp_ns
        postponed_ns = stamp_ns if command.verb is Verb.WAIT else 0
        self._callers[caller_id] = replace(
            caller, state=state, state_since_ns=stamp_ns, postponed_ns=postponed_ns, missing_s=0.0
        )
        if command.verb is Verb.SERVE:  # the last one served by command is the selected one
            self._callers[caller_id] = self._callers.pop(caller_id)
        self._renew(stamp_ns)
        return Answer(True, f"customer {caller_id} {says}")

    def reset(self) -> None:
        """Forget everybody."""
        self._callers.clear()
        self._now = WaitingList()

    def lower_hands(self) -> None:
        """No hand counts as up until it is seen up again."""
        for caller in self._callers.values():
            self._callers[caller.id] = replace(caller, is_up=False)
        self._renew(self._now.stamp_ns)

    def restore(self, kept: WaitingList) -> None:
        """Continue with an earlier list, together with new calls; nobody is in sight."""
        if self._now.selected_id is None:
            self._now = replace(self._now, selected_id=kept.selected_id)
        for caller in sorted(kept.callers, key=lambda caller: caller.state_since_ns):
            self._callers.setdefault(caller.id, replace(caller, track_id=None, is_up=False))
        self._renew(max(kept.stamp_ns, self._now.stamp_ns))

    def _look(self, tracks: Tracks) -> None:
        """Where everybody is now; the lost are looked for at their places."""
        rows = {track_id: row for row, track_id in enumerate(tracks.id.tolist())}
        lost = []
        for caller in self._callers.values():
            if caller.track_id in rows:
                del rows[caller.track_id]
            else:
                lost.append(caller)
        if lost and rows:
            unknown = sorted(rows.values())
            pairs = found_again(
                np.array([caller.xy_m for caller in lost]),
                np.array([_matrix(caller) for caller in lost]),
                tracks.mean[unknown, :2],
                tracks.covariance[unknown, :2, :2],
                self.config.place_std_m,
            )
            found = {lost[one].id: int(tracks.id[unknown[other]]) for one, other in pairs}
        else:
            found = {}
        for caller in lost:
            track_id = found.get(caller.id)
            if track_id != caller.track_id or caller.is_up:
                self._callers[caller.id] = replace(caller, track_id=track_id, is_up=False)

    def _miss(self, scan_view: View | None, lapse_s: float) -> None:
        """How long those who wait have been missed at their places."""
        if scan_view is None:
            return
        for caller in self._callers.values():
            is_missed = caller.state is CallState.WAITING and caller.track_id is None
            if is_missed and scan_view.covers(caller.xy_m):
                self._callers[caller.id] = replace(caller, missing_s=caller.missing_s + lapse_s)

    def _hear(self, tracks: Tracks) -> None:
        """Update places, and begin or renew the calls of people whose hand is up."""
        by_track = {caller.track_id: caller for caller in self._callers.values()}
        fresh = tracks.unseen_s <= self.config.pose_max_age_s
        columns = tracks.id.tolist(), tracks.raised.tolist(), fresh.tolist(), _places(tracks)
        for row, (track_id, is_up, is_fresh, place) in enumerate(zip(*columns, strict=True)):
            caller = by_track.get(track_id)
            if caller is None and not is_up:
                continue
            changes: dict[str, Any] = {}
            if caller is None:
                caller = _new_caller(tracks, row, place)
            elif is_fresh:  # the others keep their last place
                changes = place
            if is_up:
                changes |= self._raised(caller, int(tracks.raised_since_ns[row]), tracks.stamp_ns)
            elif caller.is_up:
                changes["is_up"] = False
            self._callers[caller.id] = replace(caller, **changes) if changes else caller

    def _raised(self, caller: Caller, since_ns: int, stamp_ns: int) -> dict[str, Any]:
        """What changes for somebody whose hand is up."""
        changes = {"is_up": True, "raised_since_ns": since_ns, "last_up_ns": stamp_ns}
        is_over = caller.state in (CallState.SERVED, CallState.GONE)
        down_s = (stamp_ns - caller.last_up_ns) / 1e9
        if is_over and not caller.is_up and down_s > self.config.call_again_after_s:
            anew = {"called_ns": since_ns, "state_since_ns": stamp_ns, "postponed_ns": 0}
            return changes | anew | {"state": CallState.WAITING}
        return changes

    def _end_calls(self, stamp_ns: int) -> None:
        """Calls that were too short, are too old, or whose callers have left."""
        config = self.config
        hold_ns = config.selection_hold_s * 1e9
        for caller in list(self._callers.values()):
            silent_ns = stamp_ns - max(caller.last_up_ns, caller.state_since_ns)
            is_held = caller.id == self._now.selected_id and silent_ns <= hold_ns
            up_s = (caller.last_up_ns - caller.called_ns) / 1e9
            is_short = caller.state is CallState.WAITING and not caller.is_up
            if is_short and up_s < config.call_min_s and not is_held and not caller.postponed_ns:
                del self._callers[caller.id]
            elif caller.state.is_open:
                if silent_ns > config.call_expiry_s * 1e9 or caller.missing_s > config.call_left_s:
                    self._callers[caller.id] = replace(
                        caller, state=CallState.GONE, state_since_ns=stamp_ns
                    )
            elif not caller.is_up and silent_ns > self._kept_ns(caller):
                del self._callers[caller.id]

    def _kept_ns(self, caller: Caller) -> float:
        """How long somebody whose call is over is remembered after it, or the last raise."""
        if caller.state is CallState.IGNORED:
            return self.config.call_expiry_s * 1e9
        return max(_SHOWN_NS, self.config.call_again_after_s * 1e9)

    def _clear(self) -> Answer:
        """End every call; hands that are up now count again once they have been down."""
        stamp_ns = self._now.stamp_ns
        ended = [caller for caller in self._callers.values() if caller.state.is_open]
        for caller in list(self._callers.values()):
            if caller.state.is_open or caller.state is CallState.IGNORED:
                self._callers[caller.id] = replace(
                    caller, state=CallState.GONE, state_since_ns=stamp_ns
                )
        self._renew(stamp_ns)
        return Answer(True, f"{len(ended)} calls ended" if len(ended) != 1 else "1 call ended")

    def _renew(self, stamp_ns: int) -> WaitingList:
        callers = list(self._callers.values())
        if not callers:
            self._now = WaitingList(stamp_ns)
            return self._now
        chosen_id = choose(callers, self._now.selected_id, stamp_ns, self._robot_xy_m, self.config)
        of = {state: [item for item in callers if item.state is state] for state in CallState}
        waiting = in_order(of[CallState.WAITING], self._robot_xy_m, self.config)
        if (
            self.config.calls_wait
        ):  # else the selected one may be whose hand is up, not who is next
            waiting.sort(key=lambda caller: caller.id != chosen_id)
        over = of[CallState.SERVED] + of[CallState.GONE] + of[CallState.IGNORED]
        over.sort(key=lambda caller: (-caller.state_since_ns, caller.id))
        served = of[CallState.BEING_SERVED][::-1]
        self._now = WaitingList(stamp_ns, (*served, *waiting, *over), chosen_id)
        return self._now


#: What each command makes of a call, and how that is said.
_LEADS_TO = {
    Verb.SERVE: (CallState.BEING_SERVED, "is being served"),
    Verb.SERVED: (CallState.SERVED, "is served"),
    Verb.WAIT: (CallState.WAITING, "waits behind the others"),
    Verb.RELEASE: (CallState.GONE, "is released"),
    Verb.IGNORE: (CallState.IGNORED, "is ignored"),
}


def _new_caller(tracks: Tracks, row: int, place: dict[str, Any]) -> Caller:
    track_id, since_ns = int(tracks.id[row]), int(tracks.raised_since_ns[row])
    return Caller(
        id=track_id,
        state=CallState.WAITING,
        called_ns=since_ns,
        state_since_ns=tracks.stamp_ns,
        raised_since_ns=since_ns,
        last_up_ns=tracks.stamp_ns,
        is_up=True,
        track_id=track_id,
        **place,
    )


def _places(tracks: Tracks) -> list[dict[str, Any]]:
    """Where each was seen, and when."""
    seen_ns = tracks.stamp_ns - np.rint(tracks.unseen_s * 1e9).astype(np.int64)
    xy_m, spread_m2 = tracks.mean[:, :2].tolist(), tracks.covariance[:, [0, 0, 1], [0, 1, 1]]
    return [
        {"xy_m": (x, y), "covariance_m2": (xx, xy, yy), "seen_ns": at_ns, "missing_s": 0.0}
        for (x, y), (xx, xy, yy), at_ns in zip(
            xy_m, spread_m2.tolist(), seen_ns.tolist(), strict=True
        )
    ]


def _matrix(caller: Caller) -> list[list[float]]:
    xx, xy, yy = caller.covariance_m2
    return [[xx, xy], [xy, yy]]


def _words(caller: Caller) -> str:
    return caller.state.value.replace("_", " ")
