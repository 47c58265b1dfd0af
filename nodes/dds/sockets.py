"""Do UDP sockets drop datagrams? Linux counts them for each socket."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from nodes.dds.environment import RECEIVE_BUFFER_MB

#: One line for each UDP socket of this machine, below a heading; these columns of it count.
_SOCKETS = Path("/proc/net/udp")
_ADDRESS, _INODE, _DROPS = 1, 9, -1
#: Of this process; a socket is a link to "socket:[inode]".
_OPEN_FILES = Path("/proc/self/fd")

#: A domain's ports, as DDSI-RTPS has them.
_FIRST_PORT, _PORTS_PER_DOMAIN = 7400, 250
_WANTED_BYTES = RECEIVE_BUFFER_MB * 1024 * 1024

#: SO_RCVBUFFORCE of Linux, which Python does not name: SO_RCVBUF beyond net.core.rmem_max.
_FORCE = 33

#: Lets the kernel grant the receive buffer that is asked for.
SYSCTL = f"sudo sysctl -w net.core.rmem_max={_WANTED_BYTES}"


class SocketLoad(NamedTuple):
    """How the sockets of this process fare.

    Attributes:
        buffer_bytes: The smallest receive buffer that the kernel granted, its own bookkeeping
            included (the kernel doubles what it grants); 0 where it cannot be known.
        dropped: Datagrams that found their buffer full, since the sockets are open.
    """

    buffer_bytes: int
    dropped: int

    @property
    def remedy(self) -> str:
        """What helps when datagrams are dropped."""
        if self.buffer_bytes >= _WANTED_BYTES:
            return "this computer is too busy to receive so much"
        return f"{SYSCTL}, then start again"


def own_sockets() -> SocketLoad:
    """The load of this process' sockets; zeros where the system does not tell."""
    sizes, dropped = [], 0
    for twin, drops in _own_sockets():
        sizes.append(twin.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF))
        dropped += drops
    return SocketLoad(min(sizes, default=0), dropped)


def enlarge_own_sockets() -> None:
    """Give this process' sockets the receive buffer that is wanted, as far as it may.

    Cyclone DDS asks for it within net.core.rmem_max, 0.2 MB by default. Who may administer the
    network, as root, may go beyond.
    """
    for twin, _ in _own_sockets():
        with suppress(OSError):
            twin.setsockopt(socket.SOL_SOCKET, _FORCE, _WANTED_BYTES)


def dropped_in_domain(domain_id: int) -> int:
    """Datagrams dropped by all processes of this machine that are in a DDS domain now."""
    first = _FIRST_PORT + _PORTS_PER_DOMAIN * domain_id
    ports = range(first, first + _PORTS_PER_DOMAIN)
    return sum(drops for port, _, drops in _udp_sockets() if port in ports)


def _own_sockets() -> Iterator[tuple[socket.socket, int]]:
    """Each UDP socket of this process, as long as it is looked at, with its dropped datagrams."""
    files = dict(_own_files())
    for _, inode, drops in _udp_sockets():
        if inode in files:
            with suppress(OSError), socket.socket(fileno=os.dup(files[inode])) as twin:
                yield twin, drops


def _own_files() -> Iterator[tuple[str, int]]:
    """Inode and number of every open socket."""
    try:
        numbers = os.listdir(_OPEN_FILES)
    except OSError:
        return
    for number in numbers:
        try:
            kind, _, inode = os.readlink(_OPEN_FILES / number).partition(":")
        except OSError:  # closed meanwhile
            continue
        if kind == "socket":
            yield inode.strip("[]"), int(number)


def _udp_sockets() -> Iterator[tuple[int, str, int]]:
    """Port, inode and dropped datagrams of every UDP socket of this machine."""
    try:
        lines = _SOCKETS.read_text(encoding="ascii").splitlines()[1:]
    except OSError:
        return
    for line in lines:
        columns = line.split()
        port = int(columns[_ADDRESS].rpartition(":")[2], 16)
        yield port, columns[_INODE], int(columns[_DROPS])
