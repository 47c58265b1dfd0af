import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.bodies.body_look import MediapipeLook
from tracker.perception.pose_hands import PoseHands
from tracker.perception.single_shot import Detections
from tracker.simulation import scene_from_mapping
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import CameraView, look_of
from tracker.simulation.rendering.figure import bend_arm
from tracker.simulation.stream import map_from_camera

PHOTOS = Path(__file__).parents[4] / "../shared/data/photos"
MEDIAPIPE = json.loads((Path(__file__).parent / "mediapipe_joints.json").read_text("utf-8"))


class Crowd:
    """People who stand still: a searcher that sees those in its window, and a reader of all."""

    def __init__(self, make, *places, up=()):
        self.bodies = {
            place: make(
                shift_px=(place - 200, 0),
                **({"right_wrist": (148, 60)} if place in up else {}),
            )
            for place in places
        }
        self.windows = []
        self.looks = []

    def find(self, bgr, confidence, *, window):
        self.windows.append(window)
        left, _, width, _ = window
        seen = [place for place in self.bodies if left <= place < left + width]
        keypoints = np.array([[(x, 156.0), (x, 56.0)] for x in seen]).reshape(-1, 2, 2)
        return Detections(np.zeros((len(seen), 4)), keypoints, np.ones(len(seen)))

    def read(self, bgr, regions):
        looked = [round(float(center)) for center in regions.center_px[:, 0]]
        self.looks.append(looked)
        hips = np.stack([regions.center_px, regions.center_px - (0, 100)], axis=1)
        found = [self.bodies.get(place, None) for place in looked]
        known = [body for body in found if body is not None]
        assert len(known) == len(found)
        bodies = Bodies.concatenate(Bodies.none(), *known)
        return replace(bodies, alignment_px=hips)


def image(number, width=640):
    return CameraImage(number * 100_000_000, "", np.zeros((480, width, 3), np.uint8))


def open_finder(crowd, **parameters):
    config = Config().replace(**parameters)
    return PoseHands(MediapipeLook(crowd, crowd, config), config)


def run(crowd, count, **parameters):
    """How many people are seen in each image; both hands of each are."""
    finder = open_finder(crowd, **parameters)
    return [len(finder.find(image(number))) / 2 for number in range(count)]


def test_each_search_looks_at_the_next_strip(body):
    crowd = Crowd(body)
    run(crowd, 6)
    assert [window[0] for window in crowd.windows] == [0, 100, 200, 300, 400, 0]


def test_everybody_known_is_read_in_each_image(body):
    crowd = Crowd(body, 50, 250, 350)
    found = run(crowd, 8)
    assert len(crowd.windows) == 8
    assert found[-1] == 3


def test_somebody_seen_in_two_strips_is_one(body):
    crowd = Crowd(body, 220)  # in three strips
    found = run(crowd, 10)
    assert found[-1] == 1


def test_whom_the_landmarks_lose_is_forgotten(body):
    crowd = Crowd(body, 50)
    finder = open_finder(crowd)
    assert len(finder.find(image(0))) == 2
    crowd.bodies[50] = body(shift_px=(-150, 0), score=0.1)
    assert len(finder.find(image(1))) == 0


@pytest.mark.parametrize("jump", [image(0), image(3, width=320)], ids=["time", "size"])
def test_a_jump_starts_anew(body, jump):
    crowd = Crowd(body, 630)
    finder = open_finder(crowd)
    for number in range(1, 6):
        found = finder.find(image(number))
    assert len(found) == 2
    assert len(finder.find(jump)) == 0
    assert crowd.windows[-1][0] == 0


def test_no_more_people_are_followed_than_hands_allowed(body):
    crowd = Crowd(body, *range(20, 640, 60))
    found = run(crowd, 20, max_hands=4)
    assert found[-1] == 4


@pytest.mark.model
@pytest.mark.parametrize("name", sorted(MEDIAPIPE["photos"]))
def test_joints_lie_where_mediapipe_sees_them(model_store, name):
    path = PHOTOS / name
    if not path.is_file():
        pytest.skip(f"the photo {name} is not here (../shared/data/photos)")
    bgr = cv2.imread(str(path))
    look = MediapipeLook.open(model_store, Config())
    bodies = look.around(bgr, (0, 0, bgr.shape[1], bgr.shape[0]), most=1)
    expected = np.array(MEDIAPIPE["photos"][name])
    error = np.linalg.norm(bodies.points_px[0] - expected, axis=-1)
    # mediapipe refines them by heat maps, a tenth of the model's time that is left out here.
    assert np.median(error) < 0.025 * np.ptp(expected, axis=0).max()


@pytest.fixture(scope="module")
def rendered():
    """Three people at 2 to 3.5 m, the arms of the outer ones up; picture and true wrists."""
    places = [(2.2, 0.75, "right"), (3.0, 0.0, None), (3.5, -1.0, "left")]
    scene = scene_from_mapping(
        {
            "duration_s": 10.0,
            "camera": {"z_m": 1.2},
            "people": [
                {
                    "id": row + 1,
                    "path": [{"x_m": x, "y_m": y}],
                    "hand": hand or "right",
                    "raises": [{"from_s": 0.0, "until_s": 9.0}] if hand else [],
                }
                for row, (x, y, hand) in enumerate(places)
            ],
        }
    )
    view = Viewpoint.of(scene.camera, map_from_camera(scene, 1.0))
    people = people_at(scene, 1.0)
    picture = CameraView(scene, np.random.default_rng(0)).render(view, people)
    wrists = []
    for person, (x, y, hand) in zip(scene.people, places, strict=True):
        side = -1.0 if person.hand == "right" else 1.0
        arm = bend_arm(look_of(person), 1.0 if hand else 0.0, side)
        wrists.append(view.pixels(np.array([x, y - arm.wrist_m[0]]), arm.wrist_m[1]))
    return picture, np.array(wrists), [hand is not None for *_, hand in places]


@pytest.mark.model
def test_raised_arms_of_rendered_people_are_found(model_store, rendered):
    picture, wrists, up = rendered
    finder = PoseHands(MediapipeLook.open(model_store, Config()), Config())
    for number in range(6):
        hands = finder.find(CameraImage(number, "", picture))
    raised = hands[hands.raised]
    raised = raised[np.argsort(raised.wrist_px[:, 0])]
    off = np.linalg.norm(raised.wrist_px - wrists[up], axis=-1)
    assert (off < 0.6 * raised.length_px).all()


@pytest.mark.model
def test_an_empty_room_holds_nobody(model_store):
    finder = PoseHands(MediapipeLook.open(model_store, Config()), Config())
    assert len(finder.find(image(0))) == 0


def test_a_changed_confidence_holds_from_the_next_image_on(body):
    crowd = Crowd(body, 50)
    crowd.bodies[50] = body(shift_px=(-150, 0), score=0.6)
    finder = open_finder(crowd)
    assert len(finder.find(image(0))) == 2
    finder.configure(Config(pose_confidence=0.7))
    assert len(finder.find(image(1))) == 0
