"""Raw pictures in real time, between processes, however large the sockets' buffers are."""

import sys
import time

import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.dds.links import LinkWatch
from nodes.shared.qos import PROFILES
from nodes.shared.topics import Input
from tracker.messages.types import IMAGE

pytestmark = pytest.mark.slow

FULL_HD, UHD = 1920 * 1080 * 3, 3840 * 2160 * 3
COUNT, RATE_HZ = 50, 10

SPEAKER = """
import sys, time
from nodes.dds import Node
from nodes.dds.profiles import DEFAULT
count, rate_hz, size, reliable = (int(text) for text in sys.argv[1:])
with Node("camera") as node:
    publisher = node.publisher("image_raw", "sensor_msgs/msg/Image", DEFAULT._replace(reliable=bool(reliable)))
    while not publisher.subscribers:
        time.sleep(0.05)
    time.sleep(0.5)
    for _ in range(count):
        publisher.publish(b"\\0\\1\\0\\0" + bytes(size))
        time.sleep(1 / rate_hz)
    time.sleep(2.0)
"""  # noqa: E501

#: As a ROS 2 node without settings sends.
STRANGER = "<General><FragmentSize>1344 B</FragmentSize></General>"
#: What Linux grants where nobody has raised net.core.rmem_max.
LINUX_DEFAULT = '<Internal><SocketReceiveBufferSize max="212992 B"/></Internal>'


@pytest.fixture
def received(make_node, run, monkeypatch):
    """How many pictures of another process arrive at a node that watches its links."""

    def count(size, *, reliable, buffer="", sender="", rate_hz=RATE_HZ):
        monkeypatch.setenv("CYCLONEDDS_URI", sender)
        camera = run("-c", SPEAKER, COUNT, rate_hz, size, int(reliable), name="camera")
        monkeypatch.setenv("CYCLONEDDS_URI", buffer)
        node, heard = make_node("hand_detector"), []
        images = node.subscribe(
            "image_raw", IMAGE, lambda cdr: heard.append(len(cdr)), PROFILES[Input.IMAGES]
        )
        watch, last_s = LinkWatch(node, {Input.IMAGES: images}), time.monotonic()
        while camera.poll() is None:
            node.spin_once(0.1)
            if time.monotonic() - last_s > 0.5:
                link, last_s = watch.report()[Input.IMAGES], time.monotonic()
                sys.stderr.write(f"{len(heard)} of {COUNT}: {link}\n")
        assert camera.returncode == 0, camera.log()
        assert set(heard) <= {size + 4}
        return len(heard)

    return count


@pytest.mark.parametrize("reliable", [True, False], ids=["reliable", "best effort"])
def test_full_hd_arrives_from_a_camera_without_settings(received, reliable):
    assert received(FULL_HD, reliable=reliable, sender=STRANGER) >= 0.99 * COUNT


def test_full_hd_of_a_reliable_camera_arrives_in_a_buffer_of_linuxs_default_size(received):
    # What comes before the node knows that its socket is too small is lost.
    arrived = received(FULL_HD, reliable=True, buffer=LINUX_DEFAULT)
    assert arrived >= COUNT - 1.5 * RATE_HZ


def test_pictures_larger_than_the_buffer_arrive_reliably(received):
    slow_hz = 4
    arrived = received(UHD, reliable=True, buffer=LINUX_DEFAULT, rate_hz=slow_hz)
    assert arrived >= COUNT - 2 * slow_hz
