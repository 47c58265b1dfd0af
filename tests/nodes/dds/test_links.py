import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.dds import links
from nodes.dds.links import LinkWatch
from nodes.dds.profiles import DEFAULT, GRAPH
from nodes.dds.sockets import SocketLoad
from nodes.shared.qos import PROFILES
from nodes.shared.topics import Input
from tracker.messages import encode
from tracker.messages.types import BOOL, deserialize

CARELESS = DEFAULT._replace(reliable=False)


@pytest.fixture
def sockets(monkeypatch):
    """What the kernel tells: how many datagrams were dropped; a list of one number."""
    dropped = [5]
    monkeypatch.setattr(links, "own_sockets", lambda: SocketLoad(425_984, dropped[0]))
    return dropped


@pytest.fixture
def heard():
    return []


@pytest.fixture
def node(make_node):
    return make_node("hand_detector")


@pytest.fixture
def images(node, heard):
    return node.subscribe("image_raw", BOOL, heard.append, PROFILES[Input.IMAGES])


@pytest.fixture
def watch(sockets, node, images):
    return LinkWatch(node, {Input.IMAGES: images})


def test_an_input_without_drops_is_told_with_its_publishers_alone(make_node, images, watch, until):
    make_node("camera").publisher("image_raw", BOOL)
    until(lambda: images.publishers == 1)
    link = watch.report()[Input.IMAGES]
    assert (link.publishers, link.refusal, link.loss) == (1, "", "")
    assert link.values["socket_buffer_bytes"] == 425_984
    assert link.silence == "; 1 publisher connected"


def test_dropped_datagrams_let_a_reliable_camera_be_asked_to_send_again(
    make_node, node, images, watch, heard, sockets, until
):
    camera = make_node("camera").publisher("image_raw", BOOL)
    until(lambda: images.publishers == 1)
    sockets[0] += 300
    watch.report()
    until(lambda: images.profile.reliable and camera.subscribers == 1, node)
    link = watch.report()[Input.IMAGES]
    assert link.values["is_reliable"] is True
    assert link.loss == ""
    until(lambda: camera.is_acknowledged(0.0) and images.publishers == 1, node)
    camera.publish(encode(True).cdr)
    until(lambda: heard, node)
    assert [deserialize(BOOL, cdr).data for cdr in heard] == [True]


def test_of_a_best_effort_camera_the_loss_is_told_with_its_remedy_and_passes(
    make_node, node, images, watch, sockets, until
):
    make_node("camera").publisher("image_raw", BOOL, CARELESS)
    until(lambda: images.publishers == 1)
    sockets[0] += 300
    loss = watch.report()[Input.IMAGES].loss
    assert loss.startswith("300 datagrams recently")
    assert "425984 bytes" in loss
    assert "net.core.rmem_max" in loss
    node.spin_once(0.0)
    assert not images.profile.reliable
    for _ in range(9):
        assert watch.report()[Input.IMAGES].loss
    assert watch.report()[Input.IMAGES].loss == ""


def test_a_best_effort_camera_that_comes_later_is_heard_again(
    make_node, node, images, watch, heard, sockets, until
):
    careful = make_node("camera").publisher("image_raw", BOOL)
    until(lambda: images.publishers == 1)
    sockets[0] += 1
    watch.report()
    until(lambda: images.profile.reliable, node)
    careless = make_node("other").publisher("image_raw", BOOL, CARELESS)
    until(lambda: images.refused.times == 1, node)
    watch.report()
    until(lambda: careless.subscribers == careful.subscribers == 1, node)
    careless.publish(encode(False).cdr)
    until(lambda: heard, node)
    watch.report()
    node.spin_once(0.0)
    assert not images.profile.reliable


def test_both_ends_name_the_policy_that_keeps_them_apart(make_node, until):
    node = make_node("hand_detector")
    latched = node.subscribe("x", BOOL, lambda cdr: None, GRAPH)
    publisher = make_node("speaker").publisher("x", BOOL)
    until(lambda: latched.refused.times and publisher.refused.times)
    assert latched.refused == publisher.refused == (1, "durability")
    strict = node.subscribe("y", BOOL, lambda cdr: None)
    careless = make_node("other").publisher("y", BOOL, CARELESS)
    until(lambda: strict.refused.times and careless.refused.times)
    assert strict.refused == careless.refused == (1, "reliability")
    assert links._link(strict).silence == (
        "; 1 offer less reliability than requested; nothing is received from them"
    )
