"""How does a body's arm become a hand that the rest of the tracker understands?"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, CameraImage, FloatArray, Hands, Refusal
from tracker.perception.bodies.bodies import ELBOWS, SHOULDERS, WRISTS, Bodies, one_row_each
from tracker.perception.bodies.body_look import BodyLook
from tracker.perception.bodies.owners import head_distance_px
from tracker.perception.detector import NO_HINTS, Hints
from tracker.perception.pictures import continues
from tracker.perception.verdict.raise_rules import judge_raised

#: Adults' palms, from the wrist to the middle finger's root, against the width of the shoulders
#: (guess from anthropometric tables).
_PALM_PER_SHOULDERS = 0.26
#: An open hand in palm lengths from the wrist, (toward the thumb, along the fingers); landmarks in
#: MediaPipe's order (guess at its proportions).
_OPEN_HAND = np.array(
    [
        (0.0, 0.0),
        (0.35, 0.2), (0.6, 0.5), (0.75, 0.8), (0.85, 1.05),
        (0.25, 1.0), (0.28, 1.45), (0.29, 1.7), (0.3, 1.9),
        (0.0, 1.0), (0.0, 1.5), (0.0, 1.8), (0.0, 2.0),
        (-0.22, 0.95), (-0.25, 1.4), (-0.26, 1.68), (-0.27, 1.88),
        (-0.42, 0.85), (-0.48, 1.2), (-0.51, 1.4), (-0.54, 1.58),
    ]
)  # fmt: skip
_NO_HANDS = Hands.none()


class PoseHands:
    """`detector: pose`: every wrist of a pose model is a hand, raised where the arm is.

    One part of the picture is searched in an image; whoever was found is followed, where the
    model can do so without a search.

    Args:
        look: The pose model.
        config: The pose group.
    """

    work = None

    def __init__(self, look: BodyLook, config: Config) -> None:
        self._look = look
        self._config = config
        self.reset()

    def reset(self) -> None:
        """Forget the people of earlier images."""
        self._last: CameraImage | None = None
        self._known = Bodies.none()
        self._looks = 0

    def find(self, image: CameraImage, hints: Hints = NO_HINTS) -> Hands:
        """Hands at the wrists seen in this very image, in pixels of the full image.

        A stamp that jumps back, another frame_id or another size of the image starts anew.
        """
        if self._last is not None and not continues(self._last, image):
            self.reset()
        self._last = image
        windows = self._look.windows(image.width, image.height)
        window = windows[self._looks % len(windows)]
        self._looks += 1
        known = self._known[: self._config.max_hands]
        room = self._config.max_hands - len(known)
        bodies = self._look.around(image.bgr, window, known, room)
        if len(known):
            bodies = Bodies.concatenate(bodies, self._look.again(image.bgr, known))
        bodies = bodies[one_row_each(bodies)]
        self._known = bodies[np.isfinite(bodies.alignment_px).all(axis=(1, 2))]
        arms = bodies.is_visible[:, WRISTS] & np.isfinite(bodies.shoulder_px)[:, None]
        return draw_hands(bodies, arms, (image.width, image.height), self._config)

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on."""
        self._config = config
        self._look.configure(config)


def draw_hands(
    bodies: Bodies, arms: BoolArray, image_size: tuple[int, int], config: Config
) -> Hands:
    """Schematic open hands at the wrists of some arms, with the arm's verdict.

    Only the wrist is known. The rest of the landmarks continues the forearm, in the size that the
    shoulders suggest, so that ranging and drawing find what they know from other hands.

    Args:
        bodies: Who is there.
        arms: Shape (P, 2), left arm first: which arms; their wrists are visible.
        image_size: Width and height of the picture in pixels.
        config: The pose group, and `raise_rule` for what `raise_measure` means.
    """
    if not arms.any():
        return _NO_HANDS
    person, side = np.nonzero(arms)
    wrist = bodies.points_px[person, np.array(WRISTS)[side]]
    fingers = _fingers_direction(bodies)[person, side]
    palm_px = _PALM_PER_SHOULDERS * bodies.shoulder_px[person]
    torso = bodies.torso_px[person]
    # Whether palm or back shows is not known; the thumb is on the body's side either way.
    across = np.stack([-fingers[:, 1], fingers[:, 0]], axis=-1)
    toward_body = np.sum(across * (torso - wrist), axis=-1) >= 0.0
    across = np.where(toward_body[:, None], across, -across)
    axes = np.stack([across, fingers], axis=1)
    landmarks = wrist[:, None] + palm_px[:, None, None] * (_OPEN_HAND @ axes)
    raised = judge_arms(bodies, config)[person, side]
    _, measure = judge_raised(landmarks, image_size, config)
    return Hands(
        landmarks,
        bodies.visibility[person, np.array(WRISTS)[side]],
        side.astype(np.float64),
        raised,
        measure,
        torso,
        refusal=np.where(raised, Refusal.NO_REASON, Refusal.ARM_DOWN),
        seated=bodies.seated[person],
        wrist_only=np.ones(len(raised), dtype=bool),
    )


def _fingers_direction(bodies: Bodies) -> FloatArray:
    """Shape (P, 2, 2): unit vectors along the forearms; up where an elbow is not seen."""
    along = bodies.points_px[:, WRISTS] - bodies.points_px[:, ELBOWS]
    length = np.linalg.norm(along, axis=-1)
    known = bodies.is_visible[:, ELBOWS] & (length > 1.0)
    return np.where(
        known[..., None], along / np.maximum(length, 1.0)[..., None], np.array([0.0, -1.0])
    )


def judge_arms(bodies: Bodies, config: Config) -> BoolArray:
    """Arms whose wrist is well above the shoulder, and not at the head, as with a telephone.

    Shape (P, 2), left arm first; an arm that is not seen is down.
    """
    seen, points = bodies.is_visible, bodies.points_px
    width = bodies.shoulder_px[:, None]
    rise_px = points[:, SHOULDERS, 1] - points[:, WRISTS, 1]
    rise = np.where(seen[:, SHOULDERS] & seen[:, WRISTS], rise_px / width, np.nan)
    head_px = np.stack([head_distance_px(bodies, points[:, wrist]) for wrist in WRISTS], axis=-1)
    is_clear = ~(head_px < config.pose_head_clearance * width)
    return (rise > config.pose_raised_threshold) & is_clear
