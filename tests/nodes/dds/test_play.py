import itertools
import threading
import time

import numpy as np
import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.dds import arrival
from nodes.dds.echo import NODE_NAME as ECHOER
from nodes.dds.echo import echo
from nodes.dds.play import NODE_NAME as PLAYER
from nodes.dds.play import play
from nodes.shared.qos import PROFILES
from nodes.shared.topics import Input
from tracker.camera import CameraModel
from tracker.containers import CameraImage, Scan
from tracker.errors import ConfigError, RecordingError
from tracker.geometry import RigidTransform
from tracker.messages import CameraInfo, encode
from tracker.messages.types import BOOL, IMAGE, TF_MESSAGE, deserialize
from tracker.recording import RecordingWriter
from tracker.transforms import StampedTransform

START_NS = 1_700_000_000_000_000_000
STEP_NS = 50_000_000
COUNT = 20


def image(number):
    pixels = np.full((48, 64, 3), number, dtype=np.uint8)
    return CameraImage(START_NS + number * STEP_NS, "camera_link", pixels)


@pytest.fixture
def recording(tmp_path):
    """A second of images at 20 Hz, with a mounting and a few words on topics of their own."""
    path = tmp_path / "short.mcap"
    mounting = StampedTransform(0, "base_link", "camera_link", RigidTransform(), is_static=True)
    with RecordingWriter(path) as writer:
        writer.write("/tf_static", START_NS, mounting)
        for number in range(COUNT):
            writer.write("/image_raw", START_NS + number * STEP_NS, image(number))
        writer.write("/hand_raised", START_NS + COUNT * STEP_NS, True)
    return path


@pytest.fixture
def listener(make_node):
    """A node that spins in a thread of its own."""
    node = make_node("listener")
    thread = threading.Thread(target=node.spin)
    thread.start()
    yield node
    node.stop()
    thread.join()


def hear(node, topic, type_name, item):
    heard, profile = [], PROFILES[item]._replace(depth=1000)
    node.subscribe(topic, type_name, lambda cdr: heard.append((time.monotonic(), cdr)), profile)
    return heard


def test_every_message_goes_out_as_it_was_recorded_and_in_time(recording, listener):
    images = hear(listener, "/image_raw", IMAGE, Input.IMAGES)
    mountings = hear(listener, "/tf_static", TF_MESSAGE, Input.STATIC_TRANSFORMS)
    played = play(recording, rate=2.0)
    assert played.counts == {"/tf_static": 1, "/image_raw": COUNT, "/hand_raised": 1}
    assert [cdr for _, cdr in images] == [encode(image(number)).cdr for number in range(COUNT)]
    assert len(mountings) == 1
    took_s = images[-1][0] - images[0][0]
    assert took_s == pytest.approx((COUNT - 1) * STEP_NS / 1e9 / 2.0, abs=0.15)


def test_an_offset_passes_over_what_is_not_latched(recording, listener):
    images = hear(listener, "/image_raw", IMAGE, Input.IMAGES)
    mountings = hear(listener, "/tf_static", TF_MESSAGE, Input.STATIC_TRANSFORMS)
    played = play(recording, rate=20.0, start_offset_s=0.501)
    assert played.counts["/image_raw"] == len(images) == COUNT - 11
    assert len(mountings) == 1


def test_chosen_topics_under_other_names_with_a_clock(recording, listener):
    images = hear(listener, "/front/image", IMAGE, Input.IMAGES)
    ticks = hear(listener, "/clock", "rosgraph_msgs/msg/Clock", Input.IMAGES)
    played = play(
        recording, rate=10.0, clock=True, topics=["/image_raw"],
        remaps=["/image_raw:=/front/image"],
    )  # fmt: skip
    assert set(played.counts) == {"/image_raw"}
    assert len(images) == COUNT
    stamps = [deserialize("rosgraph_msgs/msg/Clock", cdr).clock for _, cdr in ticks]
    assert [stamp.sec * 10**9 + stamp.nanosec for stamp in stamps] == [
        START_NS + number * STEP_NS for number in range(COUNT)
    ]


def test_a_loop_goes_on_until_it_is_interrupted(recording, listener):
    images = hear(listener, "/image_raw", IMAGE, Input.IMAGES)

    def interrupt(share, count):
        if count > 2.5 * (COUNT + 2):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        play(recording, rate=100.0, loop=True, progress=interrupt)
    assert len(images) > 2 * COUNT * 0.9


def test_quality_of_service_is_as_recorded_or_as_drivers_have_it(recording, make_node, until):
    watcher = make_node("watcher")

    def offered(**options):
        seen = {}

        def look(share, count):
            if count == 10:
                for topic in ("/tf_static", "/image_raw", "/hand_raised"):
                    seen[topic] = watcher.offers(topic, 5.0)[0][1:]

        play(recording, rate=100.0, progress=look, **options)
        until(lambda: not watcher.offers("/image_raw", 0.0))
        return seen

    recorded = offered()
    assert recorded == {
        "/tf_static": (True, True), "/image_raw": (True, False), "/hand_raised": (True, True)
    }  # fmt: skip
    assert offered(best_effort=True) == {**recorded, "/image_raw": (False, False)}


def test_a_recording_that_arrives_leaves_no_doubts_but_of_topics_nobody_wanted(
    recording, listener, monkeypatch
):
    monkeypatch.setattr(arrival, "_LATE_S", 60.0)  # however busy this machine is
    monkeypatch.setattr(arrival, "_CONFIRMED_S", 60.0)
    hear(listener, "/image_raw", IMAGE, Input.IMAGES)
    hear(listener, "/tf_static", TF_MESSAGE, Input.STATIC_TRANSFORMS)
    doubts = play(recording, rate=10.0).doubts
    assert doubts == ["Nobody subscribes to /hand_raised."]


def test_nobody_at_all_is_told_with_what_to_check(recording, domain):
    (doubt,) = play(recording, rate=100.0, delay_s=0.1).doubts
    assert "Nobody subscribes; check ROS_DOMAIN_ID" in doubt


def test_a_subscriber_that_asks_for_more_than_is_offered_is_told(recording, listener):
    hear(listener, "/image_raw", IMAGE, Input.STATIC_TRANSFORMS)
    doubts = play(recording, rate=10.0, topics=["/image_raw"]).doubts
    assert "/image_raw: 1 subscribers request more durability than is offered" in doubts[-1]


def test_datagrams_that_listeners_drop_are_told_with_the_remedy(recording, listener, monkeypatch):
    counts = itertools.count(40, 17)
    monkeypatch.setattr(arrival, "_LATE_S", 60.0)
    monkeypatch.setattr(arrival, "dropped_in_domain", lambda domain_id: next(counts))
    hear(listener, "/image_raw", IMAGE, Input.IMAGES)
    (doubt,) = play(recording, rate=10.0, topics=["/image_raw"]).doubts
    assert doubt.startswith("17 datagrams did not fit")
    assert "net.core.rmem_max" in doubt


def test_what_goes_out_late_is_told(recording, listener):
    hear(listener, "/image_raw", IMAGE, Input.IMAGES)

    def stall(share, count):
        time.sleep(0.6 if count == 3 else 0.0)

    doubts = play(recording, topics=["/image_raw"], progress=stall).doubts
    assert any("Slower than real time" in doubt for doubt in doubts)


@pytest.mark.parametrize("name", [PLAYER, ECHOER])
def test_players_and_listeners_are_hidden_from_ros_2s_lists_as_its_own_helpers_are(name):
    assert name.startswith("_")


def test_what_is_no_ros_2_recording_is_said_anew(tmp_path, listener):
    import cv2

    for number in range(3):
        cv2.imwrite(str(tmp_path / f"{number}.png"), image(50 * number).bgr)
    images = hear(listener, "/image_raw", IMAGE, Input.IMAGES)
    assert play(tmp_path, rate=2.0).counts == {"/image_raw": 3}
    first = deserialize(IMAGE, images[0][1])
    assert (first.width, first.height, first.encoding) == (64, 48, "bgr8")


def test_ros_1_bags_keep_their_intrinsics_and_scans(tmp_path, domain):
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    path = tmp_path / "old.bag"
    said = {
        "/image_raw": image(0),
        "/camera_info": CameraInfo(START_NS, "camera_link", 64, 48, CameraModel(50, 50, 32, 24)),
        "/scan": Scan(START_NS, "laser", -1.0, 1.0, 0.1, 9.0, np.ones(3)),
    }
    with Writer(path) as writer:
        for topic, item in said.items():
            message = encode(item)
            connection = writer.add_connection(topic, message.type_name, typestore=store)
            raw = ros1_bytes(store, message)
            writer.write(connection, START_NS, raw)
    assert play(path, rate=100.0, delay_s=0.1).counts == dict.fromkeys(said, 1)


def ros1_bytes(store, message):
    """What ROS 1 calls the same: with a sequence number, and capital letters in CameraInfo."""
    said = deserialize(*message)

    def convert(value):
        kind = getattr(value, "__msgtype__", None)
        if kind is None:
            return value
        names = store.types[kind].__dataclass_fields__
        fields = {
            name: convert(getattr(value, name, getattr(value, name.lower(), 0)))
            for name in names
            if name != "__msgtype__"
        }
        return store.types[kind](**fields)

    said.header.stamp.nanosec = said.header.stamp.nanosec
    result = convert(said)
    result.header.stamp = store.types["builtin_interfaces/msg/Time"](
        said.header.stamp.sec, said.header.stamp.nanosec
    )
    return store.serialize_ros1(result, message.type_name)


def test_wishes_that_cannot_be_met_are_refused(recording, tmp_path, domain):
    with pytest.raises(ConfigError, match="rate"):
        play(recording, rate=0.0)
    with pytest.raises(ConfigError, match="offset"):
        play(recording, start_offset_s=-1.0)
    with pytest.raises(ConfigError, match="/nothing"):
        play(recording, topics=["/nothing"])
    with RecordingWriter(tmp_path / "empty.mcap"):
        pass
    with pytest.raises(RecordingError, match="nothing to play"):
        play(tmp_path / "empty.mcap")


def test_echo_prints_what_is_said_as_yaml(make_node):
    import yaml

    speaker = make_node("speaker")
    publisher = speaker.publisher("/hand_raised", BOOL, PROFILES[Input.STATIC_TRANSFORMS])
    publisher.publish(encode(True).cdr)
    texts = []
    assert echo("hand_raised", count=1, timeout_s=10.0, write=texts.append) == 1
    assert texts == ["data: true\n---"]
    pixels = speaker.publisher("/image", IMAGE, PROFILES[Input.STATIC_TRANSFORMS])
    pixels.publish(encode(image(3)).cdr)
    echo("/image", count=1, timeout_s=10.0, write=texts.append)
    (said,) = yaml.safe_load_all(texts[1].removesuffix("---"))
    assert said["header"]["frame_id"] == "camera_link"
    assert said["data"] == [3] * 128 + ["..."]


def test_echo_says_when_nobody_speaks(domain):
    with pytest.raises(RecordingError, match="There is no publisher of /nothing"):
        echo("/nothing", timeout_s=0.3)


def test_echo_shows_that_a_message_is_broken_and_goes_on(make_node):
    publisher = make_node("speaker").publisher("/x", IMAGE, PROFILES[Input.STATIC_TRANSFORMS])
    publisher.publish(b"\0\1\0\0\7")
    publisher.publish(encode(image(1)).cdr)
    texts = []
    echo("/x", count=2, timeout_s=10.0, write=texts.append)
    assert texts[0].startswith("# ")
    assert "bgr8" in texts[1]
