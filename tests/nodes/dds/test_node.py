import os
import subprocess
import sys
import time

import numpy as np
import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from cyclonedds.builtin import (
    BuiltinDataReader,
    BuiltinTopicDcpsParticipant,
    BuiltinTopicDcpsPublication,
)
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import make_idl_struct
from cyclonedds.idl.types import float64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from nodes.dds.profiles import DEFAULT, GRAPH
from nodes.shared.qos import PROFILES
from nodes.shared.topics import Input
from tracker.containers import CameraImage
from tracker.errors import ConfigError
from tracker.messages import encode
from tracker.messages.types import BOOL, IMAGE, deserialize

GRAPH_TYPE = "rmw_dds_common/msg/ParticipantEntitiesInfo"
SENSORS = PROFILES[Input.IMAGES]


def an_image(seed=1, shape=(480, 640, 3)):
    pixels = np.random.default_rng(seed).integers(0, 255, shape, dtype=np.uint8)
    return encode(CameraImage(123_456_789_012, "camera_link", pixels)).cdr


def test_an_image_arrives_byte_by_byte(make_node, until):
    speaker, listener = make_node("speaker"), make_node("listener")
    heard = []
    listener.subscribe("image_raw", IMAGE, heard.append, SENSORS)
    publisher = speaker.publisher("image_raw", IMAGE)
    until(lambda: publisher.subscribers == 1)
    publisher.publish(an_image())
    until(lambda: heard, listener)
    assert heard == [an_image()]


def test_who_comes_late_still_hears_what_is_latched_and_only_the_last(make_node, until):
    publisher = make_node("speaker").publisher("hand_raised", BOOL, GRAPH)
    publisher.publish(encode(False).cdr)
    publisher.publish(encode(True).cdr)
    listener, heard = make_node("listener"), []
    listener.subscribe("hand_raised", BOOL, heard.append, GRAPH)
    until(lambda: heard, listener)
    assert [deserialize(BOOL, cdr).data for cdr in heard] == [True]


def test_a_best_effort_reader_hears_a_reliable_writer_and_the_other_way_not(make_node, until):
    node = make_node("all")
    picky, easy = [], []
    node.subscribe("x", BOOL, picky.append, DEFAULT)
    node.subscribe("x", BOOL, easy.append, DEFAULT._replace(reliable=False))
    careless = node.publisher("x", BOOL, DEFAULT._replace(reliable=False))
    careful = node.publisher("x", BOOL)
    until(lambda: careless.subscribers == 1 and careful.subscribers == 2)
    careless.publish(encode(True).cdr)
    careful.publish(encode(False).cdr)
    until(lambda: len(easy) == 2 and len(picky) == 1, node)
    assert not deserialize(BOOL, picky[0]).data


@pytest.mark.parametrize("cdr", [b"", b"\0", b"\0\1\0\0", b"\0\1\0\0\7", b"\xff" * 9], ids=repr)
def test_bytes_that_are_no_message_arrive_too_and_break_nothing(make_node, until, cdr):
    node, heard = make_node("all"), []
    node.subscribe("x", IMAGE, heard.append, SENSORS)
    publisher = node.publisher("x", IMAGE)
    until(lambda: publisher.subscribers == 1)
    if cdr[:1] != b"\xff":  # of an encapsulation that DDS does not know
        publisher.publish(cdr)
        until(lambda: len(heard) == 1, node)
        assert heard[0].startswith(cdr)
    publisher.publish(an_image(shape=(2, 2, 3)))
    until(lambda: heard and heard[-1] == an_image(shape=(2, 2, 3)), node)


def test_the_graph_names_the_node_and_each_of_its_endpoints(make_node, until):
    node = make_node("hand_detector", namespace="/robot")
    heard = []
    watcher = make_node("watcher")
    reader = watcher._read("ros_discovery_info", GRAPH_TYPE, GRAPH)
    watcher._listen(reader, GRAPH, lambda cdr, _: heard.append(deserialize(GRAPH_TYPE, cdr)))
    node.publisher("hand_raised", BOOL)
    node.subscribe("/image_raw", IMAGE, lambda cdr: None)

    def entities():
        return [
            found
            for message in heard
            for found in message.node_entities_info_seq
            if found.node_name == "hand_detector"
            and len(found.reader_gid_seq) == len(found.writer_gid_seq) == 1
        ]

    until(entities, watcher)
    found = entities()[-1]
    assert found.node_namespace == "/robot"
    (endpoint,) = publications(watcher, "rt/robot/hand_raised")
    assert bytes(found.writer_gid_seq[0].data) == endpoint.key.bytes


def test_participant_and_endpoints_say_what_ros_looks_for(make_node, until):
    node, watcher = make_node("hand_detector"), make_node("watcher")
    node.publisher("hand_raised", BOOL)
    until(lambda: publications(watcher, "rt/hand_raised"))
    (endpoint,) = publications(watcher, "rt/hand_raised")
    assert endpoint.type_name == "std_msgs::msg::dds_::Bool_"
    # The hash is ROS 2 Jazzy's own, as `ros2 topic info -v` prints it.
    assert endpoint.qos[Policy.Userdata].data == (
        b"typehash=RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9;"
    )
    assert endpoint.type_id is None
    participants = BuiltinDataReader(watcher._participant, BuiltinTopicDcpsParticipant).read(100)
    told = [item.qos for item in participants if item.key == endpoint.participant_key]
    assert [qos[Policy.Userdata].data for qos in told] == [b"enclave=/;"]


def test_others_who_announce_the_real_type_are_understood(make_node, until):
    """A stranger with cyclonedds' own types, which it announces in full."""
    node, heard = make_node("listener"), []
    node.subscribe("p", "geometry_msgs/msg/Point", heard.append)
    publisher = node.publisher("q", "geometry_msgs/msg/Point")
    stranger = DomainParticipant(int(os.environ["ROS_DOMAIN_ID"]))
    fields = {"x": float64, "y": float64, "z": float64}
    kind = make_idl_struct("Point_", "geometry_msgs.msg.dds_.Point_", fields)
    qos = Qos(
        Policy.Reliability.Reliable(0), Policy.DataRepresentation(use_cdrv0_representation=True)
    )
    writer = DataWriter(stranger, Topic(stranger, "rt/p", kind), qos=qos)
    reader = DataReader(stranger, Topic(stranger, "rt/q", kind), qos=qos)
    until(lambda: writer.get_publication_matched_status().current_count == 1)
    until(lambda: publisher.subscribers == 1)
    writer.write(kind(1.0, -2.5, 3e300))
    until(lambda: heard, node)
    point = deserialize("geometry_msgs/msg/Point", heard[0])
    assert (point.x, point.y, point.z) == (1.0, -2.5, 3e300)
    publisher.publish(heard[0])
    said = []
    until(lambda: said.extend(reader.take()) or said)
    assert said == [kind(1.0, -2.5, 3e300)]


def test_offers_tell_type_and_quality_of_service(make_node):
    make_node("speaker").publisher("hand_raised", BOOL, GRAPH)
    offers = make_node("watcher").offers("hand_raised", 10.0)
    assert offers == [(BOOL, True, True)]
    assert make_node("third").offers("nothing", 0.0) == []


def test_a_configuration_that_is_none_is_refused(monkeypatch, domain, capfd):
    from nodes.dds import Node

    monkeypatch.setenv("CYCLONEDDS_URI", "<CycloneDDS><Nonsense/></CycloneDDS>")
    monkeypatch.setenv("ROS_DOMAIN_ID", "102")  # a domain has one configuration in a process
    with pytest.raises(ConfigError, match="CYCLONEDDS_URI"):
        Node("x")
    capfd.readouterr()  # Cyclone DDS complains by itself as well


def test_spin_ends_by_stop_from_another_thread(make_node):
    import threading

    node = make_node("x")
    threading.Timer(0.1, node.stop).start()
    began_s = time.monotonic()
    node.spin()
    assert time.monotonic() - began_s < 5.0


SPEAKER = """
import sys, time
from nodes.dds import Node
from tracker.messages import encode
with Node("speaker") as node:
    publisher = node.publisher("hand_raised", "std_msgs/msg/Bool")
    sys.stdin.readline()
    publisher.publish(encode(True).cdr)
    sys.stdin.readline()
"""


def test_processes_meet_on_the_loopback_interface_and_leave_cleanly(make_node, until):
    node, heard = make_node("listener"), []
    node.subscribe("hand_raised", BOOL, heard.append)
    child = subprocess.Popen(
        [sys.executable, "-c", SPEAKER], stdin=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    until(lambda: node.offers("hand_raised", 0.1), timeout_s=30.0)
    child.stdin.write("\n")
    child.stdin.flush()
    until(lambda: heard, node)
    _, complaints = child.communicate("\n", timeout=30.0)
    assert (child.returncode, complaints) == (0, "")
    until(lambda: not node.offers("hand_raised", 0.0))


def publications(node, topic):
    reader = BuiltinDataReader(node._participant, BuiltinTopicDcpsPublication)
    return [endpoint for endpoint in reader.read(1000) if endpoint.topic_name == topic]
