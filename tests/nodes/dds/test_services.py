import struct

import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.dds.services import register_services
from tracker.messages import type_hash
from tracker.messages.types import build

TRIGGER = "std_srvs/srv/Trigger"
SET_BOOL = "std_srvs/srv/SetBool"


def request(client, number, body):
    return b"\0\1\0\0" + struct.pack("<Qq", client, number) + body


@pytest.fixture
def ask(make_node, until):
    """A client spelled out byte by byte, as rmw_cyclonedds has them."""
    client = make_node("client")

    def connect(name, service, server):
        replies = []
        identity = "clientid=0.1;"
        reader = client._read(f"rr{name}Reply", f"{service}_Response", _services(), identity)
        client._listen(reader, _services(), lambda cdr, _: replies.append(cdr))
        writer = client._write(f"rq{name}Request", f"{service}_Request", _services(), identity)

        def send(cdr):
            until(lambda: writer.get_publication_matched_status().current_count)
            writer.write_cdr(cdr)

        return send, replies, lambda count: until(lambda: len(replies) == count, server, client)

    return connect


def _services():
    from nodes.dds.profiles import SERVICES

    return SERVICES


def test_a_reply_repeats_client_and_number_and_holds_the_answer(make_node, ask):
    server = make_node("hand_detector")
    server.serve(
        "~/release_customer",
        TRIGGER,
        lambda _: build(f"{TRIGGER}_Response", success=True, message="ok"),
    )
    send, replies, wait = ask("/hand_detector/release_customer", TRIGGER, server)
    send(request(0xFEDCBA9876543210, 42, b"\0"))
    wait(1)
    head = b"\0\1\0\0" + struct.pack("<Qq", 0xFEDCBA9876543210, 42)
    body = b"\1\0\0\0" + struct.pack("<I", 3) + b"ok\0"
    assert replies == [(head + body).ljust(32, b"\0")]


def test_a_request_is_read_behind_the_identity(make_node, ask):
    server, asked = make_node("hand_detector"), []

    def answer(request):
        asked.append(request.data)
        return build(f"{SET_BOOL}_Response", success=True)

    server.serve("~/enable", SET_BOOL, answer)
    send, _, wait = ask("/hand_detector/enable", SET_BOOL, server)
    send(request(1, 1, b"\1"))
    wait(1)
    send(request(1, 2, b"\0"))
    wait(2)
    assert asked == [True, False]


def test_a_broken_request_is_complained_about_and_the_next_one_served(make_node, ask):
    complaints = []
    server = make_node("hand_detector", complain=complaints.append)
    service = "rcl_interfaces/srv/GetParameters"
    server.serve("~/get", service, lambda _: build(f"{service}_Response"))
    send, replies, wait = ask("/hand_detector/get", service, server)
    send(b"\0\1\0\0\1")
    send(request(1, 1, struct.pack("<I", 2**31)))  # so many names, and none follows
    send(request(1, 2, struct.pack("<I", 0)))
    wait(1)
    assert len(complaints) == 2
    assert all("/hand_detector/get" in text for text in complaints)
    assert replies[0][4:20] == struct.pack("<Qq", 1, 2)


@pytest.mark.parametrize(
    ("name", "digits"),
    [
        # As ROS 2 Jazzy has them (std_srvs/srv/Trigger.json).
        (f"{TRIGGER}_Request", "d010825374ce8918e72bfd826c82603e60f45419e932ea976f807b74a863a199"),
        (
            f"{TRIGGER}_Response",
            "2d946c21e2fc3f1e9ca6986a8191d85fcc70097a8bb7771a053564bc47009cdf",
        ),
    ],
)
def test_requests_and_responses_have_ros_2s_own_hashes(name, digits):
    register_services()
    assert type_hash(name) == f"RIHS01_{digits}"
