"""A node of ROS 2's graph without ROS: publishers, subscriptions, services, on Cyclone DDS."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from cyclonedds.core import (
    DDSException,
    Entity,
    GuardCondition,
    InstanceState,
    Policy,
    Qos,
    ReadCondition,
    SampleState,
    ViewState,
    WaitSet,
)
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.internal import SampleInfo

from nodes.dds.discovery import Offer, offers
from nodes.dds.environment import domain_settings
from nodes.dds.names import Names, dds_type_name
from nodes.dds.profiles import DEFAULT, GRAPH, SERVICES, endpoint_qos
from nodes.dds.raw import RawReader, RawTopic, RawWriter
from nodes.dds.services import (
    Answer,
    Service,
    register_services,
    request_type,
    response_type,
)
from nodes.qos import Profile
from tracker.closing import Closing
from tracker.errors import ConfigError, RecordingError
from tracker.messages import type_hash
from tracker.messages.types import build, serialize

_GRAPH_TOPIC = "ros_discovery_info"
_GRAPH_TYPE = "rmw_dds_common/msg/ParticipantEntitiesInfo"

_UNREAD = ViewState.Any | InstanceState.Any | SampleState.NotRead

#: The domains of this process, which Cyclone DDS keeps as well; they end with it.
_DOMAINS: dict[int, Domain] = {}

#: Takes a serialized message.
Take = Callable[[bytes], None]


class Publisher:
    """Sends serialized messages to one topic. Made by `Node.publisher`.

    Attributes:
        topic: Its full name.
        type_name: As `std_msgs/msg/Bool`.
        lost: Messages that a slow reliable reader left no room for.
    """

    def __init__(self, topic: str, type_name: str, writer: RawWriter) -> None:
        self.topic = topic
        self.type_name = type_name
        self.lost = 0
        self._writer = writer

    def publish(self, cdr: bytes) -> None:
        """Send one message, serialized with its encapsulation; from any thread."""
        if not self._writer.write_cdr(cdr):
            self.lost += 1

    @property
    def subscribers(self) -> int:
        """How many readers it has now."""
        return int(self._writer.get_publication_matched_status().current_count)


class Node(Closing):
    """A node that ROS 2's tools show as one of theirs; a context manager.

    Args:
        name: Its name, unless remapped.
        namespace: Its namespace, unless remapped.
        remaps: Rules `from:=to`; see `Names`.
        environment: Names the domain; by default the process' own variables.
        complain: Told of requests that make no sense; they get no answer.

    Attributes:
        names: Its names.

    Raises:
        ConfigError: A name or a variable is none, or Cyclone DDS cannot start.
    """

    def __init__(
        self,
        name: str,
        *,
        namespace: str = "/",
        remaps: Iterable[str] = (),
        environment: Mapping[str, str] | None = None,
        complain: Callable[[str], None] = lambda text: None,
    ) -> None:
        self._complain = complain
        self.names = Names(name, namespace, remaps)
        settings = domain_settings(os.environ if environment is None else environment)
        _domain(settings.domain_id, settings.config)
        self._participant = _participant(settings.domain_id)
        self._writers: list[RawWriter] = []
        self._readers: list[RawReader] = []
        self._inputs: list[tuple[RawReader, int, Callable[[bytes, SampleInfo], None]]] = []
        self._waitset = WaitSet(self._participant)
        self._wake = GuardCondition(self._participant)
        self._waitset.attach(self._wake)
        self._stopped = threading.Event()
        register_services()
        self._graph = self._write(_GRAPH_TOPIC, _GRAPH_TYPE, GRAPH)
        self._announce()

    def publisher(self, name: str, type_name: str, profile: Profile = DEFAULT) -> Publisher:
        """Announce a topic that this node publishes.

        Args:
            name: Relative, full, or beginning with `~/`; remapped.
            type_name: As `std_msgs/msg/Bool`; known to `tracker.messages`.
            profile: Its quality of service.
        """
        topic = self.names.resolve(name)
        writer = self._write(f"rt{topic}", type_name, profile)
        self._writers.append(writer)
        self._announce()
        return Publisher(topic, type_name, writer)

    def subscribe(self, name: str, type_name: str, take: Take, profile: Profile = DEFAULT) -> None:
        """Listen to a topic.

        Args:
            name: Relative, full, or beginning with `~/`; remapped.
            type_name: As `sensor_msgs/msg/Image`.
            take: Gets every message's bytes, in the thread that spins; must be quick.
            profile: Its quality of service.
        """
        reader = self._read(f"rt{self.names.resolve(name)}", type_name, profile)
        self._listen(reader, profile.depth, lambda cdr, _: take(cdr))

    def offers(self, name: str, timeout_s: float) -> list[Offer]:
        """Who publishes a topic; waits for the first one until `timeout_s`."""
        return offers(self._participant, self.names.resolve(name), timeout_s)

    def serve(self, name: str, service: str, answer: Answer, profile: Profile = SERVICES) -> None:
        """Answer a service.

        Args:
            name: Relative, full, or beginning with `~/`; remapped.
            service: Its type, one of those in `nodes.dds.services`.
            answer: Makes the response object of a request object, in the thread that spins.
            profile: Its quality of service.
        """
        full = self.names.resolve(name)
        # Tells clients which reader and writer belong together.
        identity = f"serviceid={self._participant.guid.hex}.{len(self._inputs)};"
        writer = self._write(f"rr{full}Reply", response_type(service), profile, identity)
        reader = self._read(f"rq{full}Request", request_type(service), profile, identity)
        self._writers.append(writer)
        server = Service(service, reader, writer, answer)

        def take(cdr: bytes, info: SampleInfo) -> None:
            try:
                server.take(cdr, info)
            except RecordingError as error:
                self._complain(f"{full}: {error}")

        self._listen(reader, profile.depth, take)

    def spin_once(self, timeout_s: float | None = None) -> None:
        """Wait for messages and requests, and hand them over.

        Args:
            timeout_s: Return after it at the latest; None waits until something comes or `stop`.
        """
        endless = 2**62
        self._waitset.wait(endless if timeout_s is None else max(round(timeout_s * 1e9), 0))
        for reader, depth, take in self._inputs:
            for cdr, info in reader.take_cdr(depth):
                take(cdr, info)

    def spin(self) -> None:
        """Hand over messages and requests until `stop`."""
        while not self._stopped.is_set():
            self.spin_once()

    def stop(self) -> None:
        """End `spin`; from any thread."""
        self._stopped.set()
        self._wake.set(True)

    def close(self) -> None:
        """Leave the graph; nothing can be published from then on."""
        self.stop()
        # Deletes what is inside too, whoever still names it.
        self._participant.__del__()

    def _listen(
        self, reader: RawReader, depth: int, take: Callable[[bytes, SampleInfo], None]
    ) -> None:
        condition = ReadCondition(reader, _UNREAD)
        self._waitset.attach(condition)
        self._readers.append(reader)
        self._inputs.append((reader, depth, take))
        self._announce()

    def _write(
        self, topic: str, type_name: str, profile: Profile, identity: str = ""
    ) -> RawWriter:
        qos = _qos(type_name, profile, identity)
        return RawWriter(self._participant, self._topic(topic, type_name), qos)

    def _read(self, topic: str, type_name: str, profile: Profile, identity: str = "") -> RawReader:
        qos = _qos(type_name, profile, identity)
        return RawReader(self._participant, self._topic(topic, type_name), qos)

    def _topic(self, topic: str, type_name: str) -> RawTopic:
        return RawTopic(self._participant, topic, dds_type_name(type_name))

    def _announce(self) -> None:
        """Say which readers and writers are this node's: DDS knows no nodes."""
        node = build(
            "rmw_dds_common/msg/NodeEntitiesInfo",
            node_namespace=self.names.namespace,
            node_name=self.names.node_name,
            reader_gid_seq=[_gid(reader) for reader in self._readers],
            writer_gid_seq=[_gid(writer) for writer in self._writers],
        )
        said = build(_GRAPH_TYPE, gid=_gid(self._participant), node_entities_info_seq=[node])
        self._graph.write_cdr(serialize(said).cdr)


def _domain(domain_id: int, config: str) -> None:
    """Configure a domain, once in a process: Cyclone DDS has one configuration for each."""
    if domain_id in _DOMAINS:
        return
    try:
        _DOMAINS[domain_id] = Domain(domain_id, config)
    except (DDSException, UnicodeEncodeError) as error:
        raise ConfigError(
            f"Cyclone DDS cannot open domain {domain_id} ({error}); check CYCLONEDDS_URI."
        ) from error


def _participant(domain_id: int) -> DomainParticipant:
    try:
        return DomainParticipant(domain_id, Qos(Policy.Userdata(b"enclave=/;")))
    except DDSException as error:
        raise ConfigError(
            f"Cyclone DDS cannot join domain {domain_id} ({error}); check the network interface, "
            "CYCLONEDDS_URI and how many nodes are running."
        ) from error


def _qos(type_name: str, profile: Profile, identity: str) -> Qos:
    return endpoint_qos(profile, f"{identity}typehash={type_hash(type_name)};")


def _gid(entity: Entity) -> Any:
    return build("rmw_dds_common/msg/Gid", data=np.frombuffer(entity.guid.bytes, dtype=np.uint8))
