import threading

import pytest

from tracker.perception.abreast import Abreast


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_what_calls_return_comes_in_their_order(threads):
    calls = [lambda number=number: number for number in range(7)]
    assert Abreast(threads).run(calls) == list(range(7))


def test_two_threads_do_two_calls_at_once():
    both_are_here = threading.Barrier(2, timeout=5.0)
    assert sorted(Abreast(2).run([both_are_here.wait, both_are_here.wait])) == [0, 1]


def test_the_caller_works_as_well():
    both_are_here = threading.Barrier(2, timeout=5.0)

    def who() -> int:
        both_are_here.wait()
        return threading.get_ident()

    assert threading.get_ident() in Abreast(2).run([who, who])


def test_one_call_wakes_nobody():
    assert Abreast(4).run([threading.get_ident]) == [threading.get_ident()]


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("bad", [0, 1, 2])
def test_what_one_call_raises_is_raised(threads, bad):
    calls = [lambda number=number: 1 / (number - bad) for number in range(3)]
    with pytest.raises(ZeroDivisionError):
        Abreast(threads).run(calls)


def test_after_an_error_others_can_run():
    abreast = Abreast(2)
    with pytest.raises(ZeroDivisionError):
        abreast.run([lambda: 1 / 0, lambda: 1 / 0])
    assert abreast.run([lambda: 1, lambda: 2]) == [1, 2]


def test_an_error_waits_for_all_other_calls():
    begun, go_on, ended = threading.Barrier(3, timeout=5.0), threading.Event(), []

    def fail():
        begun.wait()
        threading.Timer(0.1, go_on.set).start()
        raise ZeroDivisionError

    def last():
        begun.wait()
        go_on.wait(5.0)
        ended.append(True)

    with pytest.raises(ZeroDivisionError):
        Abreast(3).run([last, fail, last])
    assert ended == [True, True]


def test_a_forked_process_has_threads_of_its_own(monkeypatch):
    abreast = Abreast(2)
    abreast.run([int, int])
    abreast._helpers.shutdown()  # a fork leaves the threads behind
    monkeypatch.setattr("tracker.perception.abreast.os.getpid", lambda: -1)
    both_are_here = threading.Barrier(2, timeout=5.0)
    assert sorted(abreast.run([both_are_here.wait, both_are_here.wait])) == [0, 1]
