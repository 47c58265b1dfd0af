"""With which quality of service is each topic heard and spoken, and why?

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
        "Cameras offer best effort, and a late image is worth nothing; best effort hears reliable "
        "ones too. Five, since an image of several datagrams may come while a callback runs.",
    ),
    Input.SCAN: Profile(
        False, False, 10, "Scanners offer best effort; a few are kept for busy moments.",
    ),
    Input.DEPTH: Profile(
        False, False, 5, "As images.",
    ),
    Input.DEPTH_CAMERA_INFO: Profile(
        False, False, 5, "As camera_info.",
    ),
    Input.CAMERA_INFO: Profile(
        False, False, 5, "Comes with each image, as the image does.",
    ),
    Input.MAP: Profile(
        True, True, 1, "Latched by map_server and SLAM: it comes once, before this node mostly.",
    ),
    Input.TRANSFORMS: Profile(
        True, False, 100, "What tf2's own listener asks for: a lost transform delays images.",
    ),
    Input.STATIC_TRANSFORMS: Profile(
        True, True, 100, "Latched by their publishers, each with a part of the robot.",
    ),
    Input.COMMANDS: Profile(
        True, False, 10, "What a program or a person says once; none may be lost.",
    ),
    Output.HAND_RAISED: Profile(
        True, True, 1, "A state: who comes late must know it, and only the last one counts.",
    ),
    Output.CUSTOMER_POSE: Profile(
        True, False, 1, "A goal; an old one must not be driven to, so it is not latched.",
    ),
    Output.APPROACH_POSE: Profile(
        True, False, 1, "As the customer's pose.",
    ),
    Output.RAISED_HANDS: Profile(
        True, True, 1, "As the Bool, with its stamp.",
    ),
    Output.WAITING_LIST: Profile(
        True, True, 1, "A state: a program that is started later must know who waits.",
    ),
    Output.ANSWERS: Profile(
        True, False, 10, "One for each command; none may be lost.",
    ),
    Output.TRACKS: Profile(
        True, False, 5, "Small, and identities should not be missed.",
    ),
    Output.MARKERS: Profile(
        True, False, 5, "RViz asks for reliable ones.",
    ),
    Output.GESTURE: Profile(
        True, False, 10, "Told when it changes, so that none may be missed; a few come at once.",
    ),
    Output.DEBUG_IMAGE: Profile(
        True, False, 1, "For people; reliable, since viewers ask for that by default.",
    ),
    Output.DIAGNOSTICS: Profile(
        True, False, 10, "As diagnostic_updater does.",
    ),
}  # fmt: skip
