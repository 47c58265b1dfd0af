import socket
from contextlib import closing

import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.dds import sockets
from nodes.dds.sockets import SocketLoad, dropped_in_domain, enlarge_own_sockets, own_sockets

SMALL = 8192

pytestmark = pytest.mark.skipif(
    not sockets._SOCKETS.exists(), reason="this system does not tell what its sockets drop"
)


@pytest.fixture
def small_socket():
    """Bound to any port, with a receive buffer of a few datagrams."""
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as made:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SMALL)
        yield made


def flood(receiver):
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as sender:
        for _ in range(100):
            sender.sendto(bytes(1000), receiver.getsockname())


def test_datagrams_without_room_are_counted_with_the_smallest_buffer(small_socket):
    small_socket.bind(("127.0.0.1", 0))
    before = own_sockets()
    flood(small_socket)
    after = own_sockets()
    assert 80 < after.dropped - before.dropped < 100
    granted = small_socket.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)
    assert after.buffer_bytes == before.buffer_bytes == granted


def test_a_domain_is_told_by_its_ports(small_socket, domain):
    small_socket.bind(("127.0.0.1", 7400 + 250 * domain + 249))
    before = dropped_in_domain(domain), dropped_in_domain(domain + 1)
    flood(small_socket)
    assert dropped_in_domain(domain) - before[0] > 80
    assert dropped_in_domain(domain + 1) == before[1]


def test_a_buffer_is_enlarged_as_far_as_this_user_may(small_socket):
    small_socket.bind(("127.0.0.1", 0))
    enlarge_own_sockets()
    assert own_sockets().buffer_bytes in (2 * SMALL, 2 * 32 * 1024 * 1024)


def test_a_system_that_does_not_tell_gives_zeros(monkeypatch, tmp_path):
    monkeypatch.setattr(sockets, "_SOCKETS", tmp_path / "none")
    assert own_sockets() == SocketLoad(0, 0)
    assert dropped_in_domain(0) == 0


def test_the_remedy_fits_what_was_granted():
    assert "net.core.rmem_max=33554432" in SocketLoad(425_984, 9).remedy
    assert "too busy" in SocketLoad(67_108_864, 9).remedy
