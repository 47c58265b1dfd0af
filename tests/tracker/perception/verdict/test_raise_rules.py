import numpy as np
import pytest

from tracker.config import Config
from tracker.perception.verdict.raise_rules import image_rule, judge_raised, palm_rule

VGA = (640, 480)


def hand(wrist_y=400.0, tip_y=200.0, thumb_x=250.0, pinky_x=400.0, palm_px=100.0):
    """One hand, shape (1, 21, 2): wrist and middle finger on one column, the root between them."""
    points = np.full((1, 21, 2), 300.0)
    points[0, 0] = (320, wrist_y)
    points[0, 9] = (320, wrist_y - palm_px)
    points[0, 12] = (320, tip_y)
    points[0, 4, 0], points[0, 20, 0] = thumb_x, pinky_x
    return points


def test_algorithm_3_calls_a_high_and_wide_hand_raised():
    # 400 - 200 = 200 of 480 rows: 0.4167; 150 of 640 columns: 0.234.
    raised, measure = image_rule(hand(), VGA, 0.25, 0.15)
    assert raised.tolist() == [True]
    assert measure[0] == pytest.approx(200 / 480)


@pytest.mark.parametrize(
    ("change", "is_raised"),
    [
        ({"tip_y": 279.0}, True),  # 121 / 480 = 0.2521
        ({"tip_y": 280.0}, False),  # 120 / 480 = 0.25, not more than 0.25
        ({"tip_y": 520.0}, False),  # points down
        ({"pinky_x": 347.0}, True),  # 97 / 640 = 0.1516
        ({"pinky_x": 346.0}, False),  # 96 / 640 = 0.15, not more than 0.15
        ({"pinky_x": 150.0}, True),  # the other hand: 100 px to the other side
    ],
    ids=["just high", "not quite high", "down", "just wide", "not quite wide", "mirrored"],
)
def test_algorithm_3_has_sharp_thresholds(change, is_raised):
    assert image_rule(hand(**change), VGA, 0.25, 0.15)[0].tolist() == [is_raised]


def test_algorithm_3_measures_in_shares_of_the_image():
    # The same pixels in an image twice as large are half as high and wide.
    _, small = image_rule(hand(), VGA, 0.25, 0.15)
    raised, large = image_rule(hand(), (1280, 960), 0.25, 0.15)
    assert large[0] == pytest.approx(small[0] / 2)
    assert not raised[0]


def test_algorithm_3_judges_every_hand_of_the_image():
    hands = np.concatenate([hand(), hand(tip_y=390.0), hand(thumb_x=399.0)])
    assert image_rule(hands, VGA, 0.25, 0.15)[0].tolist() == [True, False, False]


def test_section_12_threshold_is_honored():
    # The specification's example configuration asks for 0.3: 120 of 480 px are 0.25, 150 0.3125.
    config = Config(raise_rule="image", hand_raised_threshold=0.3)
    assert judge_raised(hand(tip_y=280.0), VGA, config)[0].tolist() == [False]
    assert judge_raised(hand(tip_y=250.0), VGA, config)[0].tolist() == [True]


@pytest.mark.parametrize(
    ("tip_y", "measure", "is_raised"),
    [(210.0, 1.9, True), (289.0, 1.11, True), (291.0, 1.09, False), (323.0, 0.77, False),
     (590.0, -1.9, False)],
    ids=["open hand", "just up", "not quite up", "fist", "down"],
)  # fmt: skip
def test_palm_rule_measures_in_palm_lengths(tip_y, measure, is_raised):
    raised, measured = palm_rule(hand(tip_y=tip_y), 1.1, np.radians(50))
    assert measured[0] == pytest.approx(measure)
    assert raised.tolist() == [is_raised]


@pytest.mark.parametrize("scale", [0.05, 1.0, 7.0])
def test_palm_rule_holds_at_every_distance(scale):
    raised, measure = palm_rule(hand() * scale, 1.1, np.radians(50))
    assert raised[0]
    assert measure[0] == pytest.approx(2.0)


def test_palm_rule_does_not_ask_for_spread_fingers():
    assert palm_rule(hand(thumb_x=320.0, pinky_x=321.0), 1.1, np.radians(50))[0].tolist() == [True]


def test_palm_rule_of_a_palm_without_length_is_not_raised():
    raised, measure = palm_rule(hand(palm_px=0.0), 1.1, np.radians(50))
    assert not raised[0]
    assert measure[0] == 0.0


def test_the_configured_rule_decides():
    far = hand() * 0.2  # 40 px high: far too small for the rule in shares of the image
    assert judge_raised(far, VGA, Config(raise_rule="palm"))[0].tolist() == [True]
    assert judge_raised(far, VGA, Config(raise_rule="image"))[0].tolist() == [False]
    assert judge_raised(far, VGA, Config(palm_raised_threshold=2.1))[0].tolist() == [False]


@pytest.mark.parametrize("rule", ["palm", "image"])
def test_no_hands_give_no_verdicts(rule):
    raised, measure = judge_raised(np.zeros((0, 21, 2)), VGA, Config(raise_rule=rule))
    assert raised.shape == measure.shape == (0,)


@pytest.mark.parametrize(("lean_deg", "is_raised"), [(0, True), (45, True), (55, False)])
@pytest.mark.parametrize("side", [-1, 1], ids=["to the left", "to the right"])
def test_palm_rule_does_not_call_a_hand_raised_that_lies_on_its_side(lean_deg, is_raised, side):
    # Twice as long as its palm, so it still rises by 2 cos(lean) palms.
    lean = np.radians(side * lean_deg)
    landmarks = np.zeros((1, 21, 2))
    for row, length in [(9, 100.0), (12, 200.0)]:
        landmarks[0, row] = [length * np.sin(lean), -length * np.cos(lean)]
    raised, measure = palm_rule(landmarks, 1.1, np.radians(50))
    assert measure == pytest.approx([2.0 * np.cos(lean)])
    assert raised.tolist() == [is_raised]


@pytest.mark.parametrize(("tip_y", "stays"), [(305.0, True), (315.0, False)], ids=["0.95", "0.85"])
def test_a_palm_that_was_up_stays_up_a_little_lower(tip_y, stays):
    both = np.concatenate([hand(tip_y=tip_y)] * 2)
    raised, _ = judge_raised(both, VGA, Config(raise_rule="palm"), np.array([True, False]))
    assert raised.tolist() == [stays, False]


def test_a_lower_threshold_of_ones_own_holds_for_palms_that_were_up_too():
    config = Config(raise_rule="palm", palm_raised_threshold=0.5)
    assert judge_raised(hand(tip_y=340.0), VGA, config, np.array([True]))[0].tolist() == [True]
