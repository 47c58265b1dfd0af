"""Requests and replies of a ROS 2 service in the protocol of rmw_cyclonedds.

Two topics, `rq/<name>Request` and `rr/<name>Reply`. Each message begins, behind its encapsulation,
with sixteen bytes that name the client and the request; the reply repeats them.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from cyclonedds.core import Policy
from cyclonedds.internal import SampleInfo
from rosbags.typesys import get_types_from_msg

from nodes.dds.raw import RawReader, RawWriter
from tracker.errors import RecordingError
from tracker.messages.types import deserialize, serialize, typestore

#: Answers a request object with a response object.
Answer = Callable[[Any], Any]

_ENCAPSULATION = b"\x00\x01\x00\x00"
_IDENTITY = slice(4, 20)

#: As in rmw_cyclonedds: how long a reply waits until discovery has found its reader.
_CLIENT_WAIT_S, _CLIENT_POLL_S = 0.1, 0.005

#: Fields of requests and responses; rosbags brings messages only. DDS has no empty types.
_NOTHING = "uint8 structure_needs_at_least_one_member"
_SERVICES = {
    "std_srvs/srv/Trigger": (_NOTHING, "bool success\nstring message"),
    "std_srvs/srv/SetBool": ("bool data", "bool success\nstring message"),
    "rcl_interfaces/srv/DescribeParameters": (
        "string[] names",
        "rcl_interfaces/ParameterDescriptor[] descriptors",
    ),
    "rcl_interfaces/srv/GetParameters": (
        "string[] names",
        "rcl_interfaces/ParameterValue[] values",
    ),
    "rcl_interfaces/srv/GetParameterTypes": ("string[] names", "uint8[] types"),
    "rcl_interfaces/srv/ListParameters": (
        "uint64 DEPTH_RECURSIVE=0\nstring[] prefixes\nuint64 depth",
        "rcl_interfaces/ListParametersResult result",
    ),
    "rcl_interfaces/srv/SetParameters": (
        "rcl_interfaces/Parameter[] parameters",
        "rcl_interfaces/SetParametersResult[] results",
    ),
    "rcl_interfaces/srv/SetParametersAtomically": (
        "rcl_interfaces/Parameter[] parameters",
        "rcl_interfaces/SetParametersResult result",
    ),
}


@lru_cache(maxsize=1)
def register_services() -> None:
    """Teach the typestore the requests and responses that this node answers."""
    for service, halves in _SERVICES.items():
        for half, fields in zip(("Request", "Response"), halves, strict=True):
            name = f"{service}_{half}"
            # rosbags would put "msg" into the name.
            (definition,) = get_types_from_msg(fields, "a/msg/B").values()
            typestore().register({name: definition})


def request_type(service: str) -> str:
    """The message type of a service's requests, as `std_srvs/srv/Trigger_Request`."""
    return f"{service}_Request"


def response_type(service: str) -> str:
    """The message type of a service's replies."""
    return f"{service}_Response"


class Service:
    """One service as a server.

    Args:
        service: Its type, as `std_srvs/srv/Trigger`.
        reader: Of the requests.
        writer: Of the replies.
        answer: Answers them.
    """

    def __init__(self, service: str, reader: RawReader, writer: RawWriter, answer: Answer) -> None:
        self._service = service
        self._reader = reader
        self._writer = writer
        self._answer = answer

    def take(self, cdr: bytes, info: SampleInfo) -> None:
        """Answer one request.

        Raises:
            RecordingError: The bytes are no such request.
        """
        if len(cdr) < _IDENTITY.stop:
            raise RecordingError(f"{len(cdr)} bytes came as a request of {self._service}.")
        request = deserialize(request_type(self._service), cdr[:4] + cdr[_IDENTITY.stop :])
        reply = serialize(self._answer(request))
        self._wait_for_client(info)
        self._writer.write_cdr(_ENCAPSULATION + cdr[_IDENTITY] + reply.cdr[4:])

    def _wait_for_client(self, info: SampleInfo) -> None:
        """A reply that goes before its reader is known would be lost."""
        source = self._reader.get_matched_publication_data(info.publication_handle)
        client = _client_id(source)
        if client is None:
            return
        deadline = time.monotonic() + _CLIENT_WAIT_S
        while time.monotonic() < deadline:
            for handle in self._writer.get_matched_subscriptions():
                if _client_id(self._writer.get_matched_subscription_data(handle)) == client:
                    return
            time.sleep(_CLIENT_POLL_S)


def _client_id(endpoint: Any) -> bytes | None:
    """What rmw_cyclonedds writes into the user data of both ends of a client."""
    if endpoint is None or Policy.Userdata not in endpoint.qos:
        return None
    user_data: bytes = endpoint.qos[Policy.Userdata].data
    for part in user_data.split(b";"):
        key, _, value = part.partition(b"=")
        if key == b"clientid":
            return value
    return None
