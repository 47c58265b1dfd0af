import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.containers import View
from tracker.service import Command, Verb

ANNA, BERT = (2.0, 0.0), (3.0, 1.5)
ALL_AROUND = View(np.zeros(3), 2 * np.pi, 8.0)


@pytest.fixture
def room(make_room):
    return make_room(calls_wait=True)


def test_a_call_waits_after_the_hand_has_fallen(room):
    room.run(1, {1: ANNA}, up=[1])
    now = room.run(300, {1: ANNA})
    (anna,) = now.waiting
    assert (anna.id, anna.is_up) == (1, False)
    assert anna.called_ns == 10**12 + 100_000_000
    assert now.selected_id == 1


def test_a_hand_that_goes_up_again_is_the_same_call(room):
    room.run(1, {1: ANNA}, up=[1])
    room.run(5, {1: ANNA})
    (anna,) = room.run(1, {1: ANNA}, up=[1]).callers
    assert anna.called_ns == 10**12 + 100_000_000
    assert anna.raised_since_ns == 10**12 + 6_100_000_000


def test_a_hand_that_was_up_for_a_moment_is_no_call_that_waits(room):
    assert len(room.run(0.3, {1: ANNA}, up=[1]))
    assert not len(room.run(0.1, {1: ANNA}))


def test_without_calls_wait_only_a_hand_that_is_up_is_selected_and_calls_are_kept(make_room):
    room = make_room()
    room.run(1, {1: ANNA, 2: BERT}, up=[1, 2])
    now = room.run(1, {1: ANNA, 2: BERT}, up=[2])
    assert now.selected_id == 2
    now = room.run(1, {1: ANNA, 2: BERT})
    assert now.selected_id is None
    assert room.states == {1: "waiting", 2: "waiting"}


@pytest.mark.parametrize(
    ("selection", "order"), [("first", [2, 1]), ("newest", [1, 2]), ("nearest", [1, 2])]
)
def test_the_policy_orders_those_who_wait(make_room, selection, order):
    room = make_room(selection=selection)
    room.run(1, {1: ANNA, 2: BERT}, up=[2])
    room.run(1, {1: ANNA, 2: BERT}, up=[1])
    room.run(1, {1: ANNA, 2: BERT})
    assert [caller.id for caller in room.keeper.now.waiting] == order


@pytest.mark.parametrize("calls_wait", [True, False])
def test_a_hand_that_is_up_does_not_jump_the_queue(make_room, calls_wait):
    people = {1: ANNA, 2: BERT, 3: (4.0, -1.0)}
    room = make_room(calls_wait=calls_wait)
    for track_id in people:
        room.run(1, people, up=[track_id])
    room.say("serve 1")
    room.run(5, people)
    room.say("served 1")
    for up in ([3], [2, 3]):  # 2 is next, even after raising the hand once more and later
        now = room.run(1, people, up=up)
        assert [caller.id for caller in now.waiting] == [2, 3]


def test_everybody_is_served_once_in_order(room):
    people = {1: ANNA, 2: BERT}
    room.run(1, people, up=[1])
    room.run(1, people, up=[2])
    served = []
    while (selected := room.keeper.now.selected_id) is not None:
        assert room.say(f"serve {selected}").is_done
        room.run(11, people)
        assert room.say(f"served {selected}").is_done
        room.run(1, people)
        served.append(selected)
    assert served == [1, 2]
    assert room.states == {2: "served", 1: "served"}


def test_who_keeps_the_hand_up_after_being_served_has_not_called_again(room):
    room.run(1, {1: ANNA}, up=[1])
    room.say("served 1")
    room.run(5, {1: ANNA}, up=[1])
    room.run(1, {1: ANNA})
    room.since_ns.clear()
    assert room.run(1, {1: ANNA}, up=[1]).selected_id is None  # it was down for a second only
    room.run(3, {1: ANNA})
    (anna,) = room.run(1, {1: ANNA}, up=[1]).waiting
    assert anna.called_ns == room.stamp_ns - 900_000_000


def test_somebody_being_served_keeps_number_and_place_while_out_of_sight_for_minutes(room):
    room.run(1, {1: ANNA}, up=[1])
    room.say("serve 1")
    now = room.run(240, {})
    assert (now.selected.id, now.selected.xy_m, now.selected.track_id) == (1, ANNA, None)
    assert now.selected_track_id is None
    now = room.run(1, {7: (2.2, 0.1)})  # back from the bar; the tracker has another identity now
    assert (now.selected.id, now.selected.track_id) == (1, 7)
    assert now.selected.xy_m == (2.2, 0.1)


def test_one_being_served_is_found_again_among_bystanders(room):
    room.run(1, {1: ANNA}, up=[1])
    room.say("serve 1")
    room.run(60, {})
    assert room.keeper.wants_bystanders
    assert room.run(1, {-4: (2.1, 0.0)}).selected.track_id == -4
    assert room.run(1, {9: (2.1, 0.0)}, up=[9]).selected.track_id == 9
    assert room.states == {1: "being_served"}


def test_a_person_who_is_lost_for_five_seconds_keeps_the_call(room):
    room.run(1, {1: ANNA, 2: BERT}, up=[1, 2])
    room.run(5, {2: BERT})
    now = room.run(1, {2: BERT, 3: (2.0, 0.2)}, up=[3])
    assert room.states == {1: "waiting", 2: "waiting"}
    assert now.find(1).track_id == 3


def test_somebody_who_appears_elsewhere_is_somebody_else(room):
    room.run(1, {1: ANNA}, up=[1])
    room.run(5, {})
    room.run(1, {2: (4.0, 2.0)}, up=[2])
    assert room.states == {1: "waiting", 2: "waiting"}


def test_ten_callers_at_once_are_ten_calls_and_keep_their_numbers_when_all_are_lost(room):
    people = {one: (1.0 + 0.7 * (one % 5), 0.7 * (one // 5)) for one in range(1, 11)}
    room.run(1, people, up=list(people))
    room.run(3, {})
    moved = {one + 20: (x + 0.1, y - 0.1) for one, (x, y) in people.items()}
    now = room.run(1, moved)
    assert {caller.id: caller.track_id for caller in now.callers} == {
        one: one + 20 for one in people
    }
    assert now.selected_id == 1


def test_everybody_leaves_and_the_list_empties(room):
    room.scan_view = ALL_AROUND
    room.run(1, {1: ANNA, 2: BERT}, up=[1, 2])
    room.run(59, {})
    assert room.states == {1: "waiting", 2: "waiting"}
    assert room.run(3, {}).selected_id is None
    assert room.states == {1: "gone", 2: "gone"}
    assert not len(room.run(62, {}))


def test_a_place_that_the_scan_does_not_see_is_not_missed(room):
    room.scan_view = View(np.array([0.0, 0.0, np.pi]), np.pi / 2, 8.0)  # it looks backwards
    room.run(1, {1: ANNA}, up=[1])
    room.run(600, {})
    assert room.states == {1: "waiting"}


def test_a_call_that_nobody_answers_expires(make_room):
    room = make_room(call_expiry_s=20.0)
    room.run(1, {1: ANNA}, up=[1])
    room.run(19, {1: ANNA})
    assert room.states == {1: "waiting"}
    room.run(2, {1: ANNA})
    assert room.states == {1: "gone"}


def test_the_last_one_served_by_command_is_selected(room):
    people = {1: ANNA, 2: BERT}
    room.run(1, people, up=[1, 2])
    room.say("serve 1")
    room.say("serve 2")
    assert room.keeper.now.selected_id == 2
    room.run(2, people)
    room.say("serve 1")  # the delivery
    assert room.run(2, people).selected_id == 1
    assert room.states == {1: "being_served", 2: "being_served"}


def test_who_is_told_to_wait_comes_after_the_others(room):
    people = {1: ANNA, 2: BERT}
    room.run(1, people, up=[1, 2])
    room.say("serve 1")
    room.run(1, people)
    assert room.say("wait 1").text == "customer 1 waits behind the others"
    assert room.keeper.now.selected_id == 2
    assert list(room.states) == [2, 1]


def test_release_without_a_number_lets_the_selected_one_go(room):
    room.run(1, {1: ANNA, 2: BERT}, up=[1, 2])
    assert room.say("release").text == "customer 1 is released"
    assert room.run(1, {1: ANNA, 2: BERT}, up=[1, 2]).selected_id == 2
    assert not room.say("release 1").is_done


def test_who_is_ignored_never_calls_again(room):
    room.run(1, {1: ANNA}, up=[1])
    room.say("ignore 1")
    room.run(100, {1: ANNA})
    room.run(5, {1: ANNA}, up=[1])
    assert room.states == {1: "ignored"}
    assert room.keeper.now.selected_id is None


def test_clear_ends_every_call_and_hands_that_are_up_do_not_count(room):
    room.run(1, {1: ANNA, 2: BERT}, up=[1, 2])
    assert room.say("clear").text == "2 calls ended"
    assert room.run(5, {1: ANNA, 2: BERT}, up=[1, 2]).waiting == ()
    room.run(3, {1: ANNA, 2: BERT})
    assert [caller.id for caller in room.run(1, {1: ANNA, 2: BERT}, up=[2]).waiting] == [2]


def test_an_unknown_number_is_refused_with_those_on_the_list(room):
    room.run(1, {1: ANNA, 2: BERT}, up=[1, 2])
    answer = room.say("serve 7")
    assert not answer.is_done
    assert answer.text == "no customer has the number 7; on the list: 1, 2"


def test_the_same_frames_give_the_same_list(make_room):
    def day():
        room = make_room(calls_wait=True)
        room.run(1, {1: ANNA, 2: BERT}, up=[2])
        room.run(4, {1: ANNA}, up=[1])
        room.run(2, {5: BERT})
        return room.keeper.now

    assert day() == day()


def test_a_list_that_is_kept_goes_on_in_another_tracker():
    noise = 0.05**2 * np.eye(2)
    first = PersonTracker(Config(calls_wait=True))
    for number in range(10):
        first.step(number * 100_000_000, Measurements.cartesian([ANNA, BERT], noise))
    first.calls.obey(Command(Verb.SERVE, 2))
    second = PersonTracker(Config(calls_wait=True))
    second.restore(type(first.calls.now).from_json(first.calls.now.to_json()))
    for number in range(30, 40):
        second.step(number * 100_000_000, Measurements.cartesian([BERT, (1.0, -2.0)], noise))
    now = second.calls.now
    assert [(item.id, item.state.value) for item in now.callers] == [
        (2, "being_served"), (1, "waiting"), (4, "waiting"),
    ]  # fmt: skip
    assert now.selected.track_id == 3
