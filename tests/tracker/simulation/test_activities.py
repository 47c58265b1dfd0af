from tracker.simulation.activities import ACTIVITIES, moment_at


def test_moments_follow_each_other_and_come_round_again():
    durations = [moment.duration_s for moment in ACTIVITIES["drink"]]
    starts = [sum(durations[:row]) for row in range(len(durations))]
    middles = [start + span / 2 for start, span in zip(starts, durations, strict=True)]
    assert [moment_at("drink", at_s) for at_s in middles] == list(range(len(durations)))
    assert [moment_at("drink", at_s + 3 * sum(durations)) for at_s in middles] == list(
        range(len(durations))
    )


def test_nobody_s_palm_stays_up_who_does_not_call():
    """Fingers of an open hand beside the body within 30 degrees of upright, a second or longer."""
    for moments in ACTIVITIES.values():
        up_s = 0.0
        for moment in moments * 2:
            hands = [hand for hand in (moment.hand, moment.other) if hand is not None]
            hands = [hand for hand in hands if hand.holds is None and hand.wrist_m[0] > 0.15]
            is_up = any(abs(hand.hand_deg) < 30.0 for hand in hands)
            up_s = up_s + moment.duration_s if is_up else 0.0
            assert up_s < 1.0
