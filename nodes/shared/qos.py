"""The quality of service of each topic, and why.

Plain data, for both shells. A reader that asks for less than a writer offers connects; one that
asks for more hears nothing, without an error.
"""

from __future__ import annotations

from typing import NamedTuple

from nodes.shared.topics import Input, Output


class Profile(NamedTuple):
    """Quality of service of one topic; the history is always "keep last".

    Attributes:
        reliable: Lost messages are sent again.
        transient_local: Who comes late still gets the last ones.
        depth: How many messages are kept.
        reason: Why.
    """

    reliable: bool
    transient_local: bool
    depth: int
    reason: str


PROFILES: dict[Input | Output, Profile] = {
    Input.IMAGES: Profile(
        False, False, 5,
        "Cameras offer best effort, and a late image is useless. Best effort also receives from "
        "reliable cameras. The depth is five, because images may arrive while a callback runs.",
    ),
    Input.SCAN: Profile(
        False, False, 10, "Scanners offer best effort. A few scans are kept for busy moments.",
    ),
    Input.DEPTH: Profile(
        False, False, 5, "As images.",
    ),
    Input.DEPTH_CAMERA_INFO: Profile(
        False, False, 5, "As camera_info.",
    ),
    Input.CAMERA_INFO: Profile(
        False, False, 5, "Arrives with each image, so it has the same profile.",
    ),
    Input.MAP: Profile(
        True, True, 1, "map_server and SLAM publish it once, mostly before this node starts.",
    ),
    Input.TRANSFORMS: Profile(
        True, False, 100, "The profile of tf2's own listener: a lost transform delays images.",
    ),
    Input.STATIC_TRANSFORMS: Profile(
        True, True, 100, "Static: each publisher sends its part of the robot once.",
    ),
    Input.COMMANDS: Profile(
        True, False, 10, "A command is sent once and must not be lost.",
    ),
    Output.HAND_RAISED: Profile(
        True, True, 1, "A state: a subscriber that starts late must get it, and only the last "
                       "value matters.",
    ),
    Output.CUSTOMER_POSE: Profile(
        True, False, 1, "A goal: the robot must not drive to an old one, so it is not transient "
                        "local.",
    ),
    Output.APPROACH_POSE: Profile(
        True, False, 1, "The same as for the customer's pose.",
    ),
    Output.RAISED_HANDS: Profile(
        True, True, 1, "The same as for the Bool.",
    ),
    Output.WAITING_LIST: Profile(
        True, True, 1, "A state: a program that starts later must know who waits.",
    ),
    Output.ANSWERS: Profile(
        True, False, 10, "One answer for each command; none may be lost.",
    ),
    Output.TRACKS: Profile(
        True, False, 5, "Small, and no identity should be missed.",
    ),
    Output.MARKERS: Profile(
        True, False, 5, "RViz requests a reliable publisher.",
    ),
    Output.GESTURE: Profile(
        True, False, 10, "Published when it changes, so none may be lost; a few come at once.",
    ),
    Output.DEBUG_IMAGE: Profile(
        True, False, 1, "For people; reliable, because viewers request that by default.",
    ),
    Output.DIAGNOSTICS: Profile(
        True, False, 10, "As diagnostic_updater does.",
    ),
}  # fmt: skip
