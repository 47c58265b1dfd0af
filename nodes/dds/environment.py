"""Which DDS domain is meant, and whom may we meet there? By the variables that ROS 2 reads.

As rcl and rmw_cyclonedds (Jazzy) do it, so that a node without ROS meets those with it.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from tracker.errors import ConfigError

_RANGES = ("SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT")

#: Above it, the domain's UDP ports leave the range that exists.
_LAST_DOMAIN = 232


class DomainSettings(NamedTuple):
    """Where to meet.

    Attributes:
        domain_id: The DDS domain.
        config: Cyclone DDS's configuration: XML, then what CYCLONEDDS_URI says, which wins.
    """

    domain_id: int
    config: str


def domain_settings(environment: Mapping[str, str]) -> DomainSettings:
    """Read ROS_DOMAIN_ID, ROS_AUTOMATIC_DISCOVERY_RANGE and those beside them.

    ROS_LOCALHOST_ONLY=1 (deprecated in ROS 2) wins over the range. ROS_STATIC_PEERS lists hosts to
    greet, separated by semicolons.

    Args:
        environment: Such as `os.environ`.

    Raises:
        ConfigError: A variable's value is none.
    """
    text = environment.get("ROS_DOMAIN_ID") or "0"
    if not text.isascii() or not text.isdigit() or int(text) > _LAST_DOMAIN:
        raise ConfigError(f"ROS_DOMAIN_ID is {text!r}; needed is a number, 0 to {_LAST_DOMAIN}.")
    reach = environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE") or "SUBNET"
    if reach not in _RANGES:
        raise ConfigError(
            f"ROS_AUTOMATIC_DISCOVERY_RANGE is {reach!r}; allowed is {', '.join(_RANGES)}."
        )
    peers = [peer for peer in environment.get("ROS_STATIC_PEERS", "").split(";") if peer]
    if environment.get("ROS_LOCALHOST_ONLY", "0") not in ("", "0"):
        reach, peers = "LOCALHOST", []
    own = environment.get("CYCLONEDDS_URI", "")
    # Cyclone DDS refuses to start when an interface is named twice; a file is not looked into.
    may_name_interfaces = "NetworkInterface" in own or "file:" in own
    interfaces = "" if may_name_interfaces else _interfaces(reach, peers)
    parts = [_discovery(reach, peers, interfaces), own]
    return DomainSettings(int(text), ",".join(part for part in parts if part))


def _interfaces(reach: str, peers: list[str]) -> str:
    """Where to listen: Cyclone DDS 11 is deaf to greetings on an interface it does not use.

    By itself it uses the network card alone, and ROS 2 greets this machine on the loopback.
    """
    if reach != "LOCALHOST":
        return ""
    beyond = '<NetworkInterface autodetermine="true"/>' if peers else ""
    return f'<Interfaces><NetworkInterface address="127.0.0.1"/>{beyond}</Interfaces>'


def _discovery(reach: str, peers: list[str], interfaces: str) -> str:
    if reach == "SYSTEM_DEFAULT":
        return ""
    multicast = "" if reach == "SUBNET" else "<AllowMulticast>false</AllowMulticast>"
    if reach == "OFF":  # a tag that nobody else has
        discovery = (
            f"<ParticipantIndex>none</ParticipantIndex><Tag>ros_discovery_off_{os.getpid()}</Tag>"
        )
    else:
        hosts = ["localhost", *peers] if reach == "LOCALHOST" else peers
        discovery = (
            "<ParticipantIndex>auto</ParticipantIndex>"
            # How many processes of one machine find each other, as in rmw_cyclonedds.
            "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
        )
        if hosts:
            greeted = "".join(f"<Peer address={quoteattr(host)}/>" for host in hosts)
            discovery += f"<Peers>{greeted}</Peers>"
    return (
        f"<CycloneDDS><Domain><General>{interfaces}{multicast}</General>"
        f"<Discovery>{discovery}</Discovery></Domain></CycloneDDS>"
    )
