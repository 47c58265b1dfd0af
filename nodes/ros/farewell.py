"""How is `hand_raised: false` published after the context was shut down?

rclpy's own handler of Ctrl-C shuts every context down before anybody hears of it, and the
publishers of such a context send nothing any more: listeners would see the hand up for ever.
"""

from __future__ import annotations

import time
from typing import Any

from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher

from tracker.messages import encode

#: How long those who listened may take to be met again; each one met gets what is latched.
_MEETING_S = 1.0


def take_back(publisher: Publisher[Any], domain_id: int) -> None:
    """Publish once on a topic that no hand is up, from a short-lived context.

    Args:
        publisher: Of `hand_raised`, whose context is down.
        domain_id: The one of its context.
    """
    context = Context()
    context.init(args=[], initialize_logging=False, domain_id=domain_id)
    try:
        node = Node(
            "hand_detector_farewell",
            context=context,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        again = node.create_publisher(
            publisher.msg_type, publisher.topic_name, publisher.qos_profile
        )
        again.publish(encode(False).cdr)
        time.sleep(_MEETING_S)
        again.wait_for_all_acked(Duration(seconds=_MEETING_S))
        node.destroy_node()
    finally:
        context.try_shutdown()
