from nodes.shared.fault_log import FaultLog

MINUTE_NS = 60_000_000_000


class Said:
    def __init__(self):
        self.texts, self.now_ns = [], 0
        self.log = FaultLog(self.texts.append, lambda: self.now_ns)


def test_a_kind_is_said_at_once_and_then_once_a_minute_with_its_count():
    said = Said()
    for second in range(150):
        said.now_ns = second * 1_000_000_000
        said.log.add("images", f"{second} bytes came for {'x' * (second % 3)!r}")
    assert said.texts == [
        "images: 0 bytes came for ''",
        "images: 60 bytes came for '' (59 more like it before)",
        "images: 120 bytes came for '' (59 more like it before)",
    ]
    assert said.log.total == 150


def test_other_kinds_and_other_inputs_are_said_on_their_own():
    said = Said()
    said.log.add("images", "3 bytes came")
    said.log.add("scan", "3 bytes came")
    said.log.add("images", "the stamp 3.5 s came twice")
    assert len(said.texts) == 3


def test_a_sender_of_ever_new_nonsense_is_remembered_in_bounded_memory():
    said = Said()
    for number in range(10_000):
        letters = "".join(chr(97 + int(digit)) for digit in str(number))
        said.log.add("scan", f"unheard of: {letters}")
    assert len(said.texts) == 33
    assert said.log.total == 10_000
