"""Serialized messages through Cyclone DDS unchanged, for which its API has no call.

Its Python package serializes and deserializes element by element, 76 ms for a 640x480 image, where
the bytes themselves take 1 ms. So this file, and no other, relies on internals of cyclonedds
11.0.1, which the extra `dds` pins:

- To the C layer a sample is a pointer and a length (`cyclonedds.topic.Sample`): the encapsulation
  of four bytes, then the message. `dds_write` takes one, `ddspy_take` gives their bytes.
- What is declared is checked on its way; what follows it is not. So every type is declared as one
  byte, under its real name. Broken messages arrive too, and are counted where they are read.
- DDS would announce that declaration as the type itself, and others who announce the real one
  would refuse us. rmw_cyclonedds announces none, and so do we: the announcement's length, in the C
  structure behind the topic, is set to zero. The structure is recognized by its own contents
  (pointer to our class, length of the announcement) or left alone with an error.

A message from a big-endian machine would be damaged on its way; there are none with ROS 2.
"""

from __future__ import annotations

import ctypes
from typing import Any

from cyclonedds._clayer import ddspy_take
from cyclonedds.core import DDSException, InstanceState, Qos, SampleState, ViewState
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import make_idl_struct
from cyclonedds.idl.types import uint8
from cyclonedds.internal import DDS, SampleInfo
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Sample, Topic

from tracker.errors import ConfigError

_ANY = SampleState.Any | ViewState.Any | InstanceState.Any
_ENCAPSULATION_BYTES = 4
_WORD_BYTES = ctypes.sizeof(ctypes.c_void_p)

#: Within so many words the C structure must name our class; it is the eleventh in 11.0.1.
_WORDS_SEARCHED = 12
#: From that word to the announcement's length: over a word of flags and the pointer to its bytes.
_WORDS_TO_LENGTH = 3

_write_sample = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_int32, ctypes.POINTER(Sample))(
    ("dds_write", DDS._dll_handle)
)
_get_sertype = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_int32, ctypes.POINTER(ctypes.c_void_p))(
    ("dds_get_entity_sertype", DDS._dll_handle)
)


class RawTopic(Topic):  # type: ignore[misc]  # cyclonedds has no types
    """A topic whose type has a name and no contents.

    Args:
        participant: Where.
        name: The topic's name on the wire.
        type_name: The type's, as `std_msgs::msg::dds_::Bool_`.

    Raises:
        ConfigError: The installed cyclonedds is another than this file knows.
    """

    def __init__(self, participant: DomainParticipant, name: str, type_name: str) -> None:
        super().__init__(participant, name, _one_byte(type_name))
        self._hide_type()

    def _hide_type(self) -> None:
        structure = ctypes.c_void_p()
        _get_sertype(self._ref, ctypes.byref(structure))
        start = structure.value or 0
        words = list((ctypes.c_size_t * _WORDS_SEARCHED).from_address(start)) if start else []
        announced = len(self.data_type.__idl__._xt_bytedata[0])
        if id(self.data_type) in words:
            place = start + _WORD_BYTES * (words.index(id(self.data_type)) + _WORDS_TO_LENGTH)
            length = ctypes.c_uint32.from_address(place)
            if length.value == announced:
                length.value = 0
                return
        raise ConfigError(
            "The installed cyclonedds is not the supported version, 11.0.1. Run "
            "pip install '.[dds]' in the project's folder."
        )


class RawWriter(DataWriter):  # type: ignore[misc]  # cyclonedds has no types
    """Writes serialized messages."""

    def __init__(self, participant: DomainParticipant, topic: RawTopic, qos: Qos) -> None:
        super().__init__(participant, topic, qos)

    def write_cdr(self, cdr: bytes) -> bool:
        """Send one message; other threads run meanwhile.

        Args:
            cdr: Encapsulation and message.

        Returns:
            Whether it went: False when a slow reliable reader left no room in time.

        Raises:
            DDSException: Cyclone DDS refused it.
        """
        # RTPS counts in words of four bytes, and Cyclone DDS reads to the end of the last one.
        size = max(len(cdr), _ENCAPSULATION_BYTES + 1)
        padded = cdr.ljust(size + -size % 4, b"\0")
        sample = Sample(ctypes.cast(ctypes.c_char_p(padded), ctypes.c_void_p), len(padded))
        status = _write_sample(self._ref, ctypes.byref(sample))
        if status < 0 and status != DDSException.DDS_RETCODE_TIMEOUT:
            raise DDSException(status, f"a message of {len(cdr)} bytes was not sent")
        return int(status) >= 0

    def wait_for_acknowledgments(self, timeout_s: float) -> bool:
        """Whether every reliable reader confirms all that was written, within a time.

        `wait_for_acks` of cyclonedds 11.0.1 ends in an AttributeError when the time is over.
        """
        return int(self._wait_for_acks(self._ref, round(timeout_s * 1e9))) >= 0


class RawReader(DataReader):  # type: ignore[misc]  # cyclonedds has no types
    """Reads serialized messages."""

    def __init__(self, participant: DomainParticipant, topic: RawTopic, qos: Qos) -> None:
        super().__init__(participant, topic, qos)

    def take_cdr(self, count: int) -> list[tuple[bytes, SampleInfo]]:
        """Messages that have come, the oldest first, each with where it is from.

        Args:
            count: At most so many.

        Raises:
            DDSException: Cyclone DDS refused.
        """
        taken: Any = ddspy_take(self._ref, _ANY, count)
        if isinstance(taken, int):
            raise DDSException(taken, "messages could not be taken")
        return [(cdr, info) for cdr, info in taken if info.valid_data]


def _one_byte(type_name: str) -> type:
    # A new class for each topic: Cyclone DDS shares the C structure between topics of one class,
    # and would look for the announcement that is hidden by then.
    one_byte: type = make_idl_struct(
        type_name.rsplit("::", 1)[-1], type_name.replace("::", "."), {"first_byte": uint8}
    )
    return one_byte
