"""A node of ROS 2's graph without ROS: publishers, subscriptions, services, on Cyclone DDS."""

from __future__ import annotations

import os
import threading
from collections import deque
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
    SampleState,
    ViewState,
    WaitSet,
)
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.internal import SampleInfo

from nodes.dds.discovery import Offer, offers
from nodes.dds.endpoints import Publisher, Subscription, TakeFrom
from nodes.dds.environment import domain_settings
from nodes.dds.names import Names, dds_type_name
from nodes.dds.profiles import DEFAULT, GRAPH, SERVICES, endpoint_qos, reliability
from nodes.dds.raw import RawReader, RawTopic, RawWriter
from nodes.dds.services import (
    Answer,
    Service,
    register_services,
    request_type,
    response_type,
)
from nodes.dds.sockets import enlarge_own_sockets
from nodes.shared.qos import Profile
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
        domain_id: The DDS domain it is in.

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
        self.domain_id = settings.domain_id
        _domain(settings.domain_id, settings.config)
        self._participant = _participant(settings.domain_id)
        if not settings.names_buffer:
            enlarge_own_sockets()
        self._writers: list[RawWriter] = []
        self._inputs: list[Subscription] = []
        self._orders = deque[Callable[[], None]]()
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
        return Publisher(topic, type_name, profile, writer)

    def subscribe(
        self, name: str, type_name: str, take: Take, profile: Profile = DEFAULT
    ) -> Subscription:
        """Listen to a topic.

        Args:
            name: Relative, full, or beginning with `~/`; remapped.
            type_name: As `sensor_msgs/msg/Image`.
            take: Gets every message's bytes, in the thread that spins; must be quick.
            profile: Its quality of service.
        """
        reader = self._read(f"rt{self.names.resolve(name)}", type_name, profile)
        return self._listen(reader, profile, lambda cdr, _: take(cdr))

    def listen_again(self, subscription: Subscription, *, reliable: bool) -> None:
        """Ask that what is lost is sent again, or no more; only who offers it is heard then.

        The thread that spins does it. What comes in that moment may be lost.
        """
        self._orders.append(lambda: self._exchange(subscription, reliable))
        self._wake.set(True)

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

        self._listen(reader, profile, take)

    def spin_once(self, timeout_s: float | None = None) -> None:
        """Wait for messages and requests, and hand them over.

        Args:
            timeout_s: Return after it at the latest; None waits until something comes or `stop`.
        """
        endless = 2**62
        self._waitset.wait(endless if timeout_s is None else max(round(timeout_s * 1e9), 0))
        if self._orders:
            self._wake.set(False)
            while self._orders:
                self._orders.popleft()()
        for item in self._inputs:
            for cdr, info in item.reader.take_cdr(item.profile.depth):
                item.take(cdr, info)

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

    def _listen(self, reader: RawReader, profile: Profile, take: TakeFrom) -> Subscription:
        made = Subscription(profile, take, reader, _UNREAD)
        self._waitset.attach(made.arrived)
        self._inputs.append(made)
        self._announce()
        return made

    def _exchange(self, subscription: Subscription, reliable: bool) -> None:
        before = subscription.reader
        profile = subscription.profile._replace(reliable=reliable)
        qos = Qos(reliability(profile), base=before.get_qos())
        self._waitset.detach(subscription.arrived)
        subscription.exchange(RawReader(self._participant, before.topic, qos), profile)
        self._waitset.attach(subscription.arrived)
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
            reader_gid_seq=[_gid(item.reader) for item in self._inputs],
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
