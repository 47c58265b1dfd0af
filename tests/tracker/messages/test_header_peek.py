import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker import CameraImage
from tracker.errors import RecordingError
from tracker.messages import encode
from tracker.messages.header_peek import peek_header
from tracker.messages.types import deserialize


@given(
    st.integers(0, 2**31 * 10**9 - 1), st.text(st.characters(exclude_characters="\0"), max_size=30)
)
def test_the_header_is_the_one_that_decoding_gives(stamp_ns, frame_id):
    image = CameraImage(stamp_ns, frame_id, np.zeros((2, 2, 3), np.uint8))
    message = encode(image)
    header = deserialize(*message).header
    found = peek_header(message.cdr)
    assert found == (stamp_ns, frame_id)
    assert (header.stamp.sec * 10**9 + header.stamp.nanosec, header.frame_id) == found


def test_big_endian_senders_are_understood():
    cdr = b"\0\0\0\0" + struct.pack(">iII", 7, 5, 4) + b"cam\0"
    assert peek_header(cdr) == (7_000_000_005, "cam")


@given(st.binary(max_size=64))
def test_any_bytes_give_a_header_or_an_error_of_ours(data):
    try:
        stamp_ns, _ = peek_header(data)
    except RecordingError:
        return
    assert 0 <= stamp_ns < 2**31 * 10**9


def test_memoryviews_serve_as_well():
    message = encode(CameraImage(3, "cam", np.zeros((2, 2, 3), np.uint8)))
    assert peek_header(memoryview(message.cdr)) == (3, "cam")


def test_a_name_that_goes_beyond_the_bytes_is_refused():
    with pytest.raises(RecordingError, match="frame_id should have 900 bytes"):
        peek_header(b"\0\1\0\0" + struct.pack("<iII", 1, 1, 900) + b"cam\0")
