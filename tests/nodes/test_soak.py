"""Long runs in simulated time, as fast as they go: neither memory nor threads grow.

Five minutes by default; SOAK_MINUTES=60 for the hour.
"""

import os
import struct
import threading
from pathlib import Path

import numpy as np
import pytest

from nodes.shared.topics import Input
from tracker import CameraImage
from tracker.geometry import RigidTransform
from tracker.messages import Encoded, encode
from tracker.transforms import StampedTransform

START_NS = 1_000_000_000_000
MINUTES = int(os.environ.get("SOAK_MINUTES", "5"))
PERIOD_NS = 33_333_333


def with_stamp(message, at, stamp_ns):
    """The same message at another time; its stamp stands `at` this byte."""
    cdr = bytearray(message.cdr)
    struct.pack_into("<iI", cdr, at, *divmod(stamp_ns, 10**9))
    return Encoded(message.type_name, bytes(cdr))


def resident_mb():
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return next(int(line.split()[1]) / 1024 for line in status.splitlines() if "VmRSS" in line)


@pytest.mark.slow
@pytest.mark.soak
def test_a_long_run_leaves_no_trace(wire):
    if not Path("/proc/self/status").exists():
        pytest.skip("memory is read from /proc, which is not there")
    wire.published = Nothing()
    wire.detector.stamps_ns = Nothing()
    image = encode(CameraImage(0, "camera_link", np.zeros((48, 64, 3), np.uint8)))
    base = encode(StampedTransform(0, "map", "base_link", RigidTransform()))
    wire.scan(START_NS)
    memory_mb, threads = [], []
    for number in range(MINUTES * 60 * 30):
        stamp_ns = START_NS + number * PERIOD_NS
        wire.core.receive(Input.TRANSFORMS, with_stamp(base, 8, stamp_ns - 1_000_000))
        wire.core.receive(Input.TRANSFORMS, with_stamp(base, 8, stamp_ns + 1_000_000))
        wire.core.receive(Input.IMAGES, with_stamp(image, 4, stamp_ns))
        if number % 3 == 0:
            wire.scan(stamp_ns)
            wire.until(lambda: wire.core.images_waiting == 0)
        if number % 15 == 0:
            wire.core.diagnose()
        if number % 450 == 0:  # somebody breaks something now and then
            wire.core.receive(Input.IMAGES, Encoded(image.type_name, image.cdr[:100]))
            wire.core.receive(Input.TRANSFORMS, Encoded(base.type_name, base.cdr[: number % 60]))
        if number % (MINUTES * 60 * 3) == 0:
            memory_mb.append(resident_mb())
            threads.append(threading.active_count())
    print(np.round(memory_mb, 1), threads, len(wire.logged))
    assert len(set(threads)) == 1
    assert memory_mb[-1] - memory_mb[2] < 4.0  # the first minutes fill what is bounded


class Nothing(list):
    """Forgets what is put into it."""

    def append(self, _):
        pass
