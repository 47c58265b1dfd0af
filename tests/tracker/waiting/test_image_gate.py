from tracker.waiting.image_gate import ImageGate, Verdict

MS = 1_000_000


def test_of_thirty_images_a_second_ten_are_admitted():
    gate = ImageGate(10.0)
    verdicts = [gate.judge(round(i * 1e9 / 30)) for i in range(300)]
    assert verdicts.count(Verdict.ADMITTED) == 100
    assert verdicts.count(Verdict.NOT_DUE) == 200


def test_a_stamp_that_does_not_advance_is_named():
    gate = ImageGate(10.0)
    assert [gate.judge(5 * MS) for _ in range(3)] == [
        Verdict.ADMITTED, Verdict.REPEATED, Verdict.REPEATED,
    ]  # fmt: skip


def test_the_second_image_of_an_earlier_time_is_admitted_as_such():
    gate = ImageGate(10.0)
    for stamp_ms in (9000, 9100):
        gate.judge(stamp_ms * MS)
    verdicts = [gate.judge(stamp_ms * MS) for stamp_ms in (0, 33, 67, 100, 133)]
    assert verdicts == [
        Verdict.ODD, Verdict.JUMPED_BACK, Verdict.NOT_DUE, Verdict.NOT_DUE,
        Verdict.ADMITTED,
    ]  # fmt: skip


def test_an_image_out_of_order_is_passed_over_without_a_jump():
    gate = ImageGate(30.0)
    stamps_ms = (0, 33, 67, 50, 100, 133)
    verdicts = [gate.judge(stamp_ms * MS) for stamp_ms in stamps_ms]
    assert verdicts[3] is Verdict.LATE
    assert verdicts[:3] + verdicts[4:] == [Verdict.ADMITTED] * 5
