from dataclasses import replace

import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception.hands.clearing import NOISE_MIN, measure_noise
from tracker.perception.hands.following import (
    HandFollower,
    drop_known,
    first_of_each_hand,
    regions_of,
)
from tracker.perception.hands.landmarks import Landmarks
from tracker.perception.regions import Regions
from tracker.perception.single_shot import Detections

SIDE_PX = 100.0
NOWHERE = np.zeros((0, 4))

# In sides of the region. The steady landmarks span half a side, a little below the middle, so that
# the region of these landmarks is the very region they were read from.
HAND = np.zeros((21, 2))
HAND[0], HAND[5], HAND[9], HAND[13] = (0, 0.3), (-0.1, -0.2), (0, -0.2), (0.1, -0.2)


def hand_at(center):
    return HAND * SIDE_PX + center


class World:
    """Hands at known places, seen by a searcher and a reader that never err."""

    def __init__(self, *centers):
        self.centers = [np.array(center, float) for center in centers]
        self.score = 0.9
        self.searches = []
        self.hidden_from_search = False

    def find(self, bgr, confidence, *, window=None, shrink=1):
        self.searches.append((confidence, window, shrink))
        if self.hidden_from_search or not self.centers:
            return Detections.none()
        size = SIDE_PX / 2.6
        middle = np.array(self.centers) + np.array([0, size / 2])
        keypoints = np.repeat(middle[:, None], 7, axis=1)
        keypoints[:, 0] += (0, 10)
        keypoints[:, 2] -= (0, 10)
        boxes = np.concatenate([middle - size / 2, middle + size / 2], axis=-1)
        return Detections(boxes, keypoints, np.full(len(boxes), 0.8))

    def read_beside(self, bgr, regions, calls):
        return self.read(regions), [call() for call in calls]

    def read(self, regions):
        points, scores = np.zeros((len(regions), 21, 2)), np.zeros(len(regions))
        for row, center in enumerate(regions.center_px):
            near = [one for one in self.centers if np.linalg.norm(one - center) < 0.3 * SIDE_PX]
            points[row] = hand_at(near[0] if near else center)
            scores[row] = self.score if near else 0.1
        return Landmarks(points, scores, np.full(len(regions), 0.5))


class Follower(HandFollower):
    """Answers with the hands alone; the last rows are kept aside."""

    def step(self, *rest):
        hands, self.rows = super().step(*rest)
        return hands


def follower_of(world):
    return Follower(world, world, world)


def image(stamp_ns=0, frame_id="camera", size=(480, 640)):
    return CameraImage(stamp_ns, frame_id, np.zeros((*size, 3), np.uint8))


def wrists(hands):
    return (hands.points_px[:, 0] - HAND[0] * SIDE_PX).tolist()


def test_every_hand_of_the_first_image_is_found():
    world = World((100, 100), (300, 100), (500, 300))
    hands = follower_of(world).step(image(), Config())
    assert wrists(hands) == [[100, 100], [300, 100], [500, 300]]


@pytest.mark.parametrize("odd", [np.nan, np.inf, 5.0, 5000.0])
def test_what_has_no_extent_or_place_in_the_picture_is_no_hand(odd):
    world = World((100, 100), (300, 100))
    follower, read = follower_of(world), world.read
    follower.step(image(0), Config())

    def bent(regions):
        points_px = read(regions).points_px.copy()
        points_px[1:] = odd
        return replace(read(regions), points_px=points_px)

    world.read = bent
    assert wrists(follower.step(image(1), Config())) == [[100, 100]]


def test_search_rests_while_as_many_hands_are_followed_as_allowed():
    world = World((100, 100), (300, 100))
    follower, config = follower_of(world), Config(max_hands=2)
    for stamp in range(5):
        assert len(follower.step(image(stamp), config)) == 2
    assert len(world.searches) == Config().search_regions_per_frame


def test_search_goes_on_while_fewer_are_followed_and_adds_nobody_twice():
    world = World((100, 100))
    follower, config = follower_of(world), Config(max_hands=2, search_regions_per_frame=1)
    for stamp in range(3):
        assert len(follower.step(image(stamp), config)) == 1
    assert len(world.searches) == 3
    world.centers.append(np.array([300.0, 100.0]))
    assert wrists(follower.step(image(3), config)) == [[100, 100], [300, 100]]


def test_a_followed_hand_is_kept_where_the_search_would_miss_it():
    world = World((100, 100))
    follower = follower_of(world)
    follower.step(image(0), Config())
    world.hidden_from_search = True
    for stamp in range(1, 6):
        world.centers[0] = world.centers[0] + (15, 5)
        assert wrists(follower.step(image(stamp), Config())) == [world.centers[0].tolist()]


def test_followed_hands_keep_their_rows_whatever_the_search_finds_first():
    world = World((100, 100), (300, 100))
    follower = follower_of(world)
    follower.step(image(0), Config())
    world.centers.reverse()
    assert wrists(follower.step(image(1), Config())) == [[100, 100], [300, 100]]


@pytest.mark.parametrize(("confidence", "count"), [(0.55, 1), (0.65, 0)])
def test_a_hand_is_kept_from_tracking_confidence_on(confidence, count):
    world = World((100, 100))
    follower = follower_of(world)
    config = Config(tracking_confidence=confidence)
    follower.step(image(0), config)
    world.score = 0.6
    assert len(follower.step(image(1), config)) == count


def test_a_hand_that_left_makes_room_for_another():
    world = World((100, 100))
    follower, config = follower_of(world), Config(max_hands=1)
    follower.step(image(0), config)
    world.centers = [np.array([400.0, 300.0])]
    assert len(follower.step(image(1), config)) == 0
    assert wrists(follower.step(image(2), config)) == [[400, 300]]


@pytest.mark.parametrize(
    "odd",
    [image(5), image(20, frame_id="other"), image(20, size=(240, 320))],
    ids=["stamp that jumps back", "another camera", "another size"],
)
def test_following_starts_anew_after_a(odd):
    world = World((100, 100))
    follower = follower_of(world)
    assert len(follower.step(image(10), Config())) == 1
    world.hidden_from_search = True
    assert len(follower.step(odd, Config())) == 0


def test_following_starts_anew_after_reset():
    world = World((100, 100))
    follower = follower_of(world)
    follower.step(image(10), Config())
    follower.reset()
    world.hidden_from_search = True
    assert len(follower.step(image(11), Config())) == 0


def test_no_more_hands_than_allowed_even_after_the_limit_is_lowered():
    world = World((100, 100), (300, 100), (500, 300))
    follower = follower_of(world)
    assert len(follower.step(image(0), Config(max_hands=2))) == 2
    assert wrists(follower.step(image(1), Config(max_hands=1))) == [[100, 100]]


def test_parameters_reach_the_search():
    world = World()
    config = Config(
        detection_confidence=0.7,
        piece_confidence=0.4,
        downscale_factor=3,
        search_regions_per_frame=2,
    )
    assert len(follower_of(world).step(image(), config)) == 0
    # The whole frame is shrunk; the first tile is cut from the full image.
    assert world.searches == [(0.7, None, 3), (0.4, (0, 0, 240, 240), 1)]


def test_a_budget_shrinks_the_search_but_leaves_one_place_and_all_hands():
    world = World((100, 100), (300, 100))
    follower, config = follower_of(world), Config(search_regions_per_frame=4)
    for budget, places, hands in [(None, 4, 2), (5, 3, 2), (2, 1, 2)]:
        assert len(follower.step(image(), config, np.zeros((0, 4)), budget)) == 2
        assert (follower.work.places, follower.work.hands) == (places, hands)


def test_an_expected_place_is_searched_soon():
    world = World()
    follower, config = follower_of(world), Config(search_regions_per_frame=2)
    follower.step(image(), config, np.array([[300.0, 50.0, 420.0, 170.0]]))
    whole, (left, *rest) = [window for _, window, _ in world.searches]
    assert whole is None
    assert rest == [50, 120, 120]
    assert 276 <= left <= 324  # it sways


def test_an_expected_place_whose_hand_is_followed_needs_no_search():
    world = World((360, 100))
    follower, config = follower_of(world), Config(search_regions_per_frame=1)
    follower.step(image(0), config)
    for stamp in range(1, 20):
        follower.step(image(stamp), config, np.array([[300.0, 50.0, 420.0, 170.0]]))
    windows = [window for _, window, _ in world.searches if window is not None]
    assert [50, 120, 120] not in [rest for _, *rest in windows]


def test_hands_that_do_not_point_up_are_neither_read_nor_followed():
    def lying(palms):
        keypoints = palms.keypoints_px.copy()
        keypoints[:, 2] = keypoints[:, 0] + (20, -4)  # 79 degrees
        return Detections(palms.boxes_px, keypoints, palms.score)

    world = World((100, 100))
    find = world.find
    world.find = lambda *rest, **more: lying(find(*rest, **more))
    assert len(follower_of(world).step(image(), Config())) == 0
    for all_hands in [Config(search_lean_max_deg=180.0), Config(raise_rule="image")]:
        assert len(follower_of(world).step(image(), all_hands)) == 1


def test_each_hand_knows_its_row_in_the_last_image():
    world = World((100, 100), (300, 100))
    follower = follower_of(world)
    follower.step(image(0), Config())
    assert follower.rows.tolist() == [-1, -1]
    world.centers = [world.centers[1], np.array([500.0, 300.0])]
    follower.step(image(1), Config())
    assert follower.rows.tolist() == [1, -1]


def test_two_regions_that_lead_to_one_hand_give_one_row():
    world = World((100, 100))
    shifted = World((100, 100), (128, 128))  # regions of less than half overlap, one hand
    shifted.read = world.read
    assert wrists(follower_of(shifted).step(image(), Config())) == [[100, 100]]


def test_palms_that_make_no_region_are_passed_over():
    world = World((100, 100))
    world.find = lambda *_, **__: Detections(
        np.array([[5.0, 5, 5, 5], [np.nan] * 4]), np.zeros((2, 7, 2)), np.ones(2)
    )
    assert len(follower_of(world).step(image(), Config())) == 0


def test_found_regions_over_known_ones_are_dropped():
    def regions(*centers):
        return Regions(
            np.array(centers, float), np.full(len(centers), 10.0), np.zeros(len(centers))
        )

    # Shifted by 3 of 10: overlap 70 / 130 = 0.54. By 4: 60 / 140 = 0.43.
    found = regions((3, 0), (4, 0), (40, 0), (43, 0))
    left = drop_known(found, regions((0, 0)))
    assert left.center_px.tolist() == [[4, 0], [40, 0]]


def test_a_smaller_region_within_a_known_hand_is_a_part_of_it():
    known = Regions(np.array([[300.0, 200.0]]), np.array([190.0]), np.zeros(1))
    found = Regions(
        np.array([[310.0, 210.0], [310.0, 210.0], [360.0, 210.0]]),
        np.array([114.0, 150.0, 60.0]),
        np.zeros(3),
    )
    # The second overlaps by 0.62; the third is a smaller hand beside the middle.
    assert drop_known(found, known).side_px.tolist() == [60.0]


def test_an_unsure_palm_counts_where_it_is_small():
    def unsure(size):
        keypoints = np.full((1, 7, 2), 100.0)
        keypoints[0, 0, 1] += size / 2
        box = np.array([[100 - size / 2, 100 - size / 2, 100 + size / 2, 100 + size / 2]])
        return Detections(box, keypoints, np.array([0.4]))

    # Regions of 52 and 78 px; hands of 32 px have 64.
    assert len(regions_of([unsure(20.0)], Config())) == 1
    assert len(regions_of([unsure(30.0)], Config())) == 0


def test_of_the_same_hand_the_surest_row_stays_and_order_is_kept():
    points = np.stack([hand_at((300, 100)), hand_at((100, 100)), hand_at((101, 101))])
    hands = Landmarks(points, np.array([0.6, 0.7, 0.9]), np.zeros(3))
    assert first_of_each_hand(hands).tolist() == [True, False, True]


def test_fingers_taken_for_a_small_hand_are_the_hand_they_belong_to():
    large = hand_at((100, 100))
    points = np.stack([large, HAND * 0.5 * SIDE_PX + (104, 95), HAND * 0.5 * SIDE_PX + (190, 95)])
    hands = Landmarks(points, np.array([0.9, 0.8, 0.7]), np.zeros(3))
    assert first_of_each_hand(hands).tolist() == [True, False, True]


def test_a_hand_read_too_short_from_the_same_wrist_is_the_same_hand():
    short = (hand_at((100, 100)) - (100, 130)) * 0.75 + (103, 129)  # the wrist stays where it is
    points = np.stack([hand_at((100, 100)), short])
    hands = Landmarks(points, np.array([0.9, 0.8]), np.zeros(2))
    assert first_of_each_hand(hands).tolist() == [True, False]


def test_hands_that_clasp_stay_two():
    points = np.stack([hand_at((100, 100)), hand_at((115, 100))])
    hands = Landmarks(points, np.array([0.6, 0.7]), np.zeros(2))
    assert first_of_each_hand(hands).all()


def regions_at(*centers):
    count = len(centers)
    return Regions(np.array(centers, float), np.full(count, SIDE_PX), np.zeros(count))


def test_a_suggested_hand_is_found_without_the_search_and_then_followed():
    world = World((300, 200))
    world.hidden_from_search = True
    follower, config = follower_of(world), Config()
    assert len(follower.step(image(0), config)) == 0
    suggested = regions_at((310, 195), (500, 100))
    hands = follower.step(image(1), config, NOWHERE, None, suggested)
    assert wrists(hands) == [[300, 200]]
    assert follower.rows.tolist() == [-1]
    assert wrists(follower.step(image(2), config)) == [[300, 200]]
    assert follower.rows.tolist() == [0]


def test_a_suggestion_of_a_hand_that_is_followed_or_hangs_down_is_not_read():
    world = World((300, 200))
    follower, config = follower_of(world), Config()
    follower.step(image(0), config)
    hanging = Regions(np.array([[500.0, 200.0]]), np.array([SIDE_PX]), np.array([np.pi]))
    suggested = Regions.concatenate(regions_at((305, 200)), hanging)
    assert len(follower.step(image(1), config, NOWHERE, None, suggested)) == 1
    assert follower.work.hands == 1


def test_a_suggestion_that_is_none_hides_no_palm_at_its_place():
    world = World((300, 200))
    follower = follower_of(world)
    suggested = regions_at((300 + 0.35 * SIDE_PX, 200))
    hands = follower.step(image(0), Config(), NOWHERE, None, suggested)
    assert wrists(hands) == [[300, 200]]


def test_suggestions_and_other_models_take_the_place_of_searches():
    world = World()
    follower, config = follower_of(world), Config(search_regions_per_frame=4)
    follower.step(image(0), config, NOWHERE, None, regions_at((300, 200)), 2)
    assert follower.work.places == 1
    follower.step(image(1), config, NOWHERE, None, None, 9)
    assert follower.work.places == 1
    follower.step(image(2), config)
    assert follower.work.places == 4


class Hazy(World):
    """Reads a hand well only where its region is right to a few pixels."""

    def read(self, regions):
        hands = super().read(regions)
        off = np.linalg.norm(hands.points_px.mean(axis=1) - HAND.mean(axis=0) * SIDE_PX
                             - regions.center_px, axis=-1)  # fmt: skip
        return Landmarks(hands.points_px, np.where(off < 5.0, hands.score, 0.3), hands.right)


def test_a_hand_that_is_nearly_believed_in_is_read_again_from_its_landmarks():
    world = Hazy((300, 200))
    world.hidden_from_search = True
    follower, config = follower_of(world), Config()
    hands = follower.step(image(0), config, NOWHERE, None, regions_at((315, 200)))
    assert wrists(hands) == [[300, 200]]
    assert hands.score.tolist() == [0.9]
    assert follower.work.hands == 2


def test_followed_hands_and_hopeless_ones_are_not_read_again():
    world = World((300, 200))
    follower, config = follower_of(world), Config()
    follower.step(image(0), config)
    world.score = 0.3
    world.hidden_from_search = True
    assert len(follower.step(image(1), config)) == 0
    assert follower.work.hands == 1
    world.score = 0.05
    follower.step(image(2), config, NOWHERE, None, regions_at((300, 200)))
    assert follower.work.hands == 1


class Grainy(World):
    """A reader that knows the hand in smoothed pictures alone."""

    def read_beside(self, bgr, regions, calls):
        self.score = 0.9 if measure_noise(bgr[:, :, 1]) < NOISE_MIN else 0.2
        return super().read_beside(bgr, regions, calls)


def test_a_followed_hand_is_read_once_more_smoothed_where_the_picture_is_noisy():
    follower, config = follower_of(Grainy((300, 200))), Config()
    follower.step(image(0), config)
    grain = np.random.default_rng(5).normal(128.0, 12.0, (480, 640, 3))
    noisy = CameraImage(1, "camera", grain.clip(0, 255).astype(np.uint8))
    assert follower.step(noisy, config).score.tolist() == [0.9]
    assert follower.work.hands == 2
