"""Who is next? The order of service, by policy or by command."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from tracker.config import Config
from tracker.containers import Caller, CallState, FloatArray


def choose(
    callers: Iterable[Caller],
    chosen_id: int | None,
    stamp_ns: int,
    robot_xy_m: FloatArray,
    config: Config,
) -> int | None:
    """To whom the robot should go now.

    Whoever is being served by command comes first, the last such command before others. Then
    whoever was chosen stays chosen: while the call waits with `calls_wait`, else while the hand
    is up and `selection_hold_s` longer. Then the policy `selection` decides.

    Args:
        callers: Everybody on the list; of those being served the last one was ordered last.
        chosen_id: Who was chosen before, or None.
        stamp_ns: This frame's.
        robot_xy_m: Shape (2,): where the robot is, for `selection: nearest`.
        config: `selection`, `selection_hold_s` and `calls_wait`.

    Returns:
        Their number, or None where there is nobody to go to.
    """
    served = [caller for caller in callers if caller.state is CallState.BEING_SERVED]
    if served:
        return served[-1].id
    waiting = [caller for caller in callers if caller.state is CallState.WAITING]
    for caller in waiting:
        if caller.id == chosen_id and _stays(caller, stamp_ns, config):
            return chosen_id
    if not config.calls_wait:
        # A hand that is up is selected as if calls ended with it: its last rise is what counts.
        waiting = [
            replace(caller, called_ns=caller.raised_since_ns) for caller in waiting if caller.is_up
        ]
    ranked = in_order(waiting, robot_xy_m, config)
    return ranked[0].id if ranked else None


def in_order(waiting: Iterable[Caller], robot_xy_m: FloatArray, config: Config) -> list[Caller]:
    """Those who wait, the next one first; who was postponed comes after the others."""

    def rank(caller: Caller) -> tuple[int, float, int]:
        since_ns = caller.called_ns
        by_policy = {
            "first": since_ns,
            "newest": -since_ns,
            "nearest": math.dist(caller.xy_m, robot_xy_m.tolist()),
        }
        return caller.postponed_ns, by_policy[config.selection], caller.id

    return sorted(waiting, key=rank)


def _stays(caller: Caller, stamp_ns: int, config: Config) -> bool:
    if caller.postponed_ns == stamp_ns:
        return False
    if config.calls_wait or caller.is_up:
        return True
    hold_ns = config.selection_hold_s * 1e9
    return caller.track_id is not None and 0.0 < hold_ns >= stamp_ns - caller.last_up_ns
