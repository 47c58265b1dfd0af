"""A ROS 2 node without ROS: Cyclone DDS with the protocol of ROS 2.

environment   which domain, and how far discovery reaches (the variables ROS 2 reads)
names         ~/topic, namespaces, remapping; how DDS names topics and types
profiles      quality of service
raw           serialized messages through Cyclone DDS, whose API has no call for it
services      requests and replies, and the types they carry
node          the node: publishers, subscriptions, services, and its entry in ROS 2's graph
"""

from tracker.errors import ConfigError

try:
    import cyclonedds  # noqa: F401  # is it there at all?
except ModuleNotFoundError as missing:
    raise ConfigError(
        "Cyclone DDS is not installed. Install the extra `dds`: "
        "pip install '.[dds]' in the project's folder."
    ) from missing

from nodes.dds.endpoints import Publisher
from nodes.dds.names import Names
from nodes.dds.node import Node

__all__ = ["Names", "Node", "Publisher"]
