"""Which DDS domain and network are used? By the environment variables of ROS 2.

As rcl and rmw_cyclonedds (Jazzy) do it, so that a node without ROS meets those with it.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from tracker.errors import ConfigError

_RANGES = ("SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT")

#: Above it, the domain's UDP ports leave the range that exists.
LAST_DOMAIN = 232

#: Room for several raw pictures; the kernel grants what net.core.rmem_max allows. With the usual
#: 1 MB, none of 60 raw pictures of 1920x1080 arrived over loopback.
RECEIVE_BUFFER_MB = 32
#: A missing fragment is asked for again after 10 ms, not 100: pictures come ten times a second.
_RECEIVING = (
    f'<SocketReceiveBufferSize max="{RECEIVE_BUFFER_MB} MB"/>'
    "<NackDelay>10 ms</NackDelay><AutoReschedNackDelay>10 ms</AutoReschedNackDelay>"
)
#: One fragment fills one of Cyclone DDS's packets (14 720 bytes) instead of ten that are asked for
#: again one by one: reliable pictures then pass even a receive buffer of Linux's default size.
_FRAGMENTS = "<FragmentSize>14000 B</FragmentSize>"

#: The kernel's IPv4 routes: a heading, then one line for each, with its interface.
_ROUTES = Path("/proc/net/route")


class DomainSettings(NamedTuple):
    """The domain and the network.

    Attributes:
        domain_id: The DDS domain.
        config: Cyclone DDS's configuration: XML, then what CYCLONEDDS_URI says, which wins.
        names_buffer: Whether that says how large a socket's receive buffer is.
    """

    domain_id: int
    config: str
    names_buffer: bool


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
    if not text.isascii() or not text.isdigit() or int(text) > LAST_DOMAIN:
        raise ConfigError(f"ROS_DOMAIN_ID is {text!r}; expected a number, 0 to {LAST_DOMAIN}.")
    reach = environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE") or "SUBNET"
    if reach not in _RANGES:
        raise ConfigError(
            f"ROS_AUTOMATIC_DISCOVERY_RANGE is {reach!r}; allowed is {', '.join(_RANGES)}."
        )
    peers = [peer for peer in environment.get("ROS_STATIC_PEERS", "").split(";") if peer]
    if environment.get("ROS_LOCALHOST_ONLY", "0") not in ("", "0"):
        reach, peers = "LOCALHOST", []
    own = environment.get("CYCLONEDDS_URI", "")
    said = _with_files(own)
    # Cyclone DDS refuses to start when an interface is named twice, and our fragments must fit
    # into the messages that a user made small.
    interfaces = "" if "NetworkInterface" in said else _interfaces(reach, peers)
    fragments = "" if "MaxMessageSize" in said else _FRAGMENTS
    ours = (
        f"<CycloneDDS><Domain><General>{interfaces}{fragments}{_multicast(reach)}</General>"
        f"<Internal>{_RECEIVING}</Internal>{_discovery(reach, peers)}</Domain></CycloneDDS>"
    )
    config = f"{ours},{own}" if own else ours
    return DomainSettings(int(text), config, "SocketReceiveBufferSize" in said)


def _with_files(own: str) -> str:
    """The user's configuration with the text of the files that it names."""
    said = own
    for part in own.split(","):
        try:
            said += Path(part.strip().removeprefix("file://")).read_text(encoding="utf-8")
        except (OSError, ValueError):  # it is XML, or Cyclone DDS will say what is wrong with it
            continue
    return said


def _interfaces(reach: str, peers: list[str]) -> str:
    """Interfaces to use: Cyclone DDS 11 discovers nothing on an interface that it does not use.

    By itself it uses the network card alone, and ROS 2 greets this machine on the loopback.
    """
    card = '<NetworkInterface autodetermine="true"/>' if _has_network() else ""
    loopback = '<NetworkInterface address="127.0.0.1"/>'
    if reach == "LOCALHOST":
        chosen = loopback + (card if peers else "")
    elif reach == "SUBNET" and card:
        chosen = card + loopback
    else:
        return ""
    return f"<Interfaces>{chosen}</Interfaces>"


def _has_network() -> bool:
    """Whether Cyclone DDS would choose another interface than the loopback.

    Where this cannot be known it is left to choose alone: it must not be told of one twice.
    """
    try:
        routes = _ROUTES.read_text(encoding="ascii").splitlines()[1:]
    except OSError:
        return False
    return any(route.split()[0] != "lo" for route in routes)


def _multicast(reach: str) -> str:
    is_off = reach in ("LOCALHOST", "OFF")
    return "<AllowMulticast>false</AllowMulticast>" if is_off else ""


def _discovery(reach: str, peers: list[str]) -> str:
    if reach == "SYSTEM_DEFAULT":
        return ""
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
    return f"<Discovery>{discovery}</Discovery>"
