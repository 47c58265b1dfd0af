"""Quality of service in the form of Cyclone DDS."""

from __future__ import annotations

from cyclonedds.core import Policy, Qos

from nodes.shared.qos import Profile

_UNLIMITED = -1

#: rmw_cyclonedds lets a writer wait forever for a slow reliable reader. Better lose a message than
#: the present: a reader that hangs would stop the node.
_MAX_BLOCKING_NS = 100_000_000

DEFAULT = Profile(True, False, 10, "ROS 2's default.")
GRAPH = Profile(True, True, 1, "A subscriber that starts late must know who is there.")
CLOCK = Profile(False, False, 1, "Only current values matter.")
SERVICES = Profile(True, False, 10, "ROS 2's default for services.")
PARAMETER_SERVICES = Profile(True, False, 1000, "ROS 2's default for parameters.")
PARAMETER_EVENTS = Profile(True, False, 1000, "ROS 2's default for parameters.")
ROSOUT = Profile(True, True, 1000, "ROS 2's default for logs.")


def endpoint_qos(profile: Profile, user_data: str) -> Qos:
    """A reader's or writer's quality of service, with what rmw_cyclonedds sets besides.

    Args:
        profile: The profile.
        user_data: What the endpoint says of itself, `key=value;` each.
    """
    history = Policy.History.KeepLast(profile.depth)
    policies = [
        history,
        reliability(profile),
        Policy.WriterDataLifecycle(autodispose=False),
        Policy.DataRepresentation(use_cdrv0_representation=True),  # ROS 2 knows no other
        Policy.Userdata(user_data.encode()),
    ]
    if profile.transient_local:
        policies += [
            Policy.Durability.TransientLocal,
            Policy.DurabilityService(0, history, _UNLIMITED, _UNLIMITED, _UNLIMITED),
        ]
    return Qos(*policies)


def reliability(profile: Profile) -> Policy.Reliability:
    """Whether what is lost is sent again, as a policy of its own."""
    if profile.reliable:
        return Policy.Reliability.Reliable(_MAX_BLOCKING_NS)
    return Policy.Reliability.BestEffort
