import pytest

from tracker.compiling.loops import LOOPS, loop, maker, step


@pytest.mark.parametrize("decorate", [step, loop, maker])
def test_a_decorated_function_is_the_plain_one(decorate):
    def double(number):
        return 2.0 * number

    assert decorate(double) is double
    LOOPS.pop(double)


def test_only_a_maker_counts_who_holds_its_arrays():
    def work():
        return None

    options = []
    for decorate in (step, loop, maker):
        decorate(work)
        options.append(LOOPS.pop(work))
    assert [each.get("_nrt", True) for each in options] == [False, False, True]
