from xml.etree import ElementTree

import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.dds import environment as reads
from nodes.dds.environment import domain_settings
from tracker.errors import ConfigError


def xml(environment):
    config = domain_settings(environment).config
    return ElementTree.fromstring(config.split("</CycloneDDS>")[0] + "</CycloneDDS>")


def test_without_any_variable_the_subnet_of_domain_0_is_met():
    settings = domain_settings({})
    assert settings.domain_id == 0
    assert "AllowMulticast" not in settings.config
    assert "<Peers>" not in settings.config


def test_localhost_greets_this_machine_without_multicast():
    tree = xml({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_DOMAIN_ID": "7"})
    assert tree.findtext(".//AllowMulticast") == "false"
    assert [peer.get("address") for peer in tree.iter("Peer")] == ["localhost"]


def interfaces(environment):
    tree = xml({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", **environment})
    return [item.attrib for item in tree.iter("NetworkInterface")]


LOOPBACK, CARD = {"address": "127.0.0.1"}, {"autodetermine": "true"}


@pytest.fixture
def routes(tmp_path, monkeypatch):
    """What the kernel tells of its routes: one through a network card."""
    path = tmp_path / "route"
    path.write_text("Iface\tDestination\tGateway\nwlan0\t000200C0\t00000000\n")
    monkeypatch.setattr(reads, "_ROUTES", path)
    return path


def test_localhost_listens_on_the_loopback_where_ros_2_greets_it(routes):
    assert interfaces({}) == [LOOPBACK]
    peers = {"ROS_STATIC_PEERS": "10.0.0.2"}
    assert interfaces(peers) == [LOOPBACK, CARD]
    assert interfaces({**peers, "ROS_LOCALHOST_ONLY": "1"}) == [LOOPBACK]


SUBNET = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}


def test_the_subnet_also_listens_on_the_loopback_where_tools_on_localhost_are(routes):
    assert interfaces(SUBNET) == [CARD, LOOPBACK]
    for reach in ("OFF", "SYSTEM_DEFAULT"):
        assert interfaces({"ROS_AUTOMATIC_DISCOVERY_RANGE": reach}) == []


@pytest.mark.parametrize("told", ["Iface\tDestination\n", None], ids=["no route", "unknown"])
def test_without_a_network_the_loopback_is_not_named_twice(routes, told):
    routes.unlink() if told is None else routes.write_text(told)
    assert interfaces(SUBNET) == []
    assert interfaces({"ROS_STATIC_PEERS": "10.0.0.2"}) == [LOOPBACK]


def in_a_file(tmp_path, words):
    path = tmp_path / "cyclone.xml"
    path.write_text(words)
    return [words, f"file://{path}", str(path), f"<Tracing/>,file://{path}"]


def test_interfaces_are_left_to_a_user_who_names_them(tmp_path):
    named = '<General><Interfaces><NetworkInterface name="lo"/></Interfaces></General>'
    other = "<Internal><SocketReceiveBufferSize min='4MB'/></Internal>"
    for uri in in_a_file(tmp_path, named):
        assert interfaces({"CYCLONEDDS_URI": uri}) == []
    for uri in in_a_file(tmp_path, other):
        assert interfaces({"CYCLONEDDS_URI": uri}) == [LOOPBACK]


def test_room_for_raw_pictures_is_asked_for_in_every_range():
    for reach in ("SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT"):
        tree = xml({"ROS_AUTOMATIC_DISCOVERY_RANGE": reach})
        assert tree.find(".//SocketReceiveBufferSize").attrib == {"max": "32 MB"}
        assert tree.findtext(".//FragmentSize") == "14000 B"


def test_fragments_are_left_small_for_a_user_who_made_messages_small(tmp_path):
    for uri in in_a_file(tmp_path, "<General><MaxMessageSize>1400B</MaxMessageSize></General>"):
        assert xml({"CYCLONEDDS_URI": uri}).find(".//FragmentSize") is None


def test_localhost_only_wins_over_range_and_peers():
    tree = xml({"ROS_LOCALHOST_ONLY": "1", "ROS_STATIC_PEERS": "10.0.0.2"})
    assert [peer.get("address") for peer in tree.iter("Peer")] == ["localhost"]


def test_static_peers_are_greeted_and_cannot_break_the_configuration():
    tree = xml({"ROS_STATIC_PEERS": 'robot.local;"><Evil/>;'})
    assert [peer.get("address") for peer in tree.iter("Peer")] == ["robot.local", '"><Evil/>']


def test_off_hides_behind_a_tag_of_its_own():
    tree = xml({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF", "ROS_STATIC_PEERS": "10.0.0.2"})
    assert tree.findtext(".//Tag").startswith("ros_discovery_off_")
    assert list(tree.iter("Peer")) == []


def test_the_users_own_configuration_comes_last():
    uri = "file:///etc/cyclone.xml"
    assert domain_settings({"CYCLONEDDS_URI": uri}).config.endswith(f"</CycloneDDS>,{uri}")


def test_the_system_default_leaves_discovery_to_cyclone_dds():
    tree = xml({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT", "ROS_STATIC_PEERS": "a"})
    assert tree.find(".//Discovery") is None
    assert tree.find(".//AllowMulticast") is None


@pytest.mark.parametrize("text", ["-1", "233", "7x", "²"])
def test_a_domain_that_is_none_is_refused(text):
    with pytest.raises(ConfigError, match="ROS_DOMAIN_ID"):
        domain_settings({"ROS_DOMAIN_ID": text})


def test_an_unknown_range_is_refused():
    with pytest.raises(ConfigError, match="LOCALHOST"):
        domain_settings({"ROS_AUTOMATIC_DISCOVERY_RANGE": "localhost"})
