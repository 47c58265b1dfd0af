from xml.etree import ElementTree

import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

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


LOOPBACK = {"address": "127.0.0.1"}


def test_localhost_listens_on_the_loopback_where_ros_2_greets_it():
    assert interfaces({}) == [LOOPBACK]
    peers = {"ROS_STATIC_PEERS": "10.0.0.2"}
    assert interfaces(peers) == [LOOPBACK, {"autodetermine": "true"}]
    assert interfaces({**peers, "ROS_LOCALHOST_ONLY": "1"}) == [LOOPBACK]
    assert interfaces({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}) == []


@pytest.mark.parametrize(
    ("uri", "named"),
    [
        ("file:///etc/cyclone.xml", []),
        ('<General><Interfaces><NetworkInterface name="lo"/></Interfaces></General>', []),
        ("<Internal><SocketReceiveBufferSize min='4MB'/></Internal>", [LOOPBACK]),
    ],
    ids=["in a file", "named", "another setting"],
)
def test_interfaces_are_left_to_a_user_who_may_have_named_them(uri, named):
    assert interfaces({"CYCLONEDDS_URI": uri}) == named


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


def test_the_users_own_configuration_comes_last_and_alone_in_the_system_default():
    uri = "file:///etc/cyclone.xml"
    assert domain_settings({"CYCLONEDDS_URI": uri}).config.endswith(f"</CycloneDDS>,{uri}")
    alone = {"CYCLONEDDS_URI": uri, "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"}
    assert domain_settings(alone).config == uri


@pytest.mark.parametrize("text", ["-1", "233", "7x", "²"])
def test_a_domain_that_is_none_is_refused(text):
    with pytest.raises(ConfigError, match="ROS_DOMAIN_ID"):
        domain_settings({"ROS_DOMAIN_ID": text})


def test_an_unknown_range_is_refused():
    with pytest.raises(ConfigError, match="LOCALHOST"):
        domain_settings({"ROS_AUTOMATIC_DISCOVERY_RANGE": "localhost"})
