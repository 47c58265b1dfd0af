"""Has an arm gone up whose hand was not found? A look at the people around what has moved.

The palm model overlooks every other hand of fifteen pixels, the pose models hardly any of their
owners: these are ten times as tall. A forearm tells where its hand is, how large and how turned,
and that is all the landmark model needs.
"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, Hands, IntArray
from tracker.perception.bodies import WRISTS, Bodies
from tracker.perception.movement import Movement
from tracker.perception.owner_finder import Look
from tracker.perception.palm_search import Window
from tracker.perception.pictures import continues
from tracker.perception.pose_hands import draw_hands
from tracker.perception.pose_rules import arms_without_hand, hands_at_head, hands_below_shoulders
from tracker.perception.strips import upright_strips

#: A strip is watched for so long after something moved in it: an arm takes half a second to go
#: up, and not every look shows it.
WATCH_S = 2.0
#: One image of so many, at most, is looked at: of 300 drawn hands at five meters every third finds
#: 273, every fifth 268, at the same cost, since a look takes the place of searches.
LOOK_PERIOD = 3
#: Places of the palm search that take as long as a look.
LOOK_PLACES = 2


class ArmWatch:
    """Goes from image to image; looks at one upright strip in some, the least lately seen first.

    Args:
        look: Everybody whom a pose model sees in a window of a picture.
    """

    _last: CameraImage | None
    _next: int | None
    _since_look: int
    _moved_ns: FloatArray
    _looked_ns: FloatArray

    def __init__(self, look: Look) -> None:
        self._look = look
        self._movement = Movement()
        self.reset()

    @property
    def looks_next(self) -> bool:
        """Whether it wants to look at the next image; that costs as much as `LOOK_PLACES`."""
        return self._next is not None

    def find(self, image: CameraImage, *, rests: bool = False) -> Bodies:
        """Who is seen where something moved of late; nobody in most images.

        A stamp that jumps back, another frame_id or another size of the image starts anew.

        Args:
            image: The next one.
            rests: Whether a look has to wait, as other models are at work.
        """
        if self._last is None or not continues(self._last, image):
            self.reset()
        strips = upright_strips(image.width, image.height)
        if self._last is None:
            self._moved_ns = np.full(len(strips), -np.inf)
            self._looked_ns = self._moved_ns.copy()
        self._last = image
        self._since_look += 1
        seen = Bodies.none()
        if self._next is not None and not rests:
            seen = self._look(image.bgr, strips[self._next])
            self._looked_ns[self._next] = image.stamp_ns
            self._since_look = 0
        moved_px = self._movement.boxes(image.bgr)
        self._moved_ns[_nearest_strips(moved_px, strips)] = image.stamp_ns
        self._next = self._choose(image.stamp_ns)
        return seen

    def reset(self) -> None:
        """Forget what moved."""
        self._movement.reset()
        self._last = None
        self._moved_ns = self._looked_ns = np.zeros(0)
        self._since_look = LOOK_PERIOD
        self._next = None

    def _choose(self, stamp_ns: int) -> int | None:
        """The strip to look at in the next image."""
        is_watched = stamp_ns - self._moved_ns <= WATCH_S * 1e9
        if self._since_look < LOOK_PERIOD - 1 or not is_watched.any():
            return None
        return int(np.argmin(np.where(is_watched, self._looked_ns, np.inf)))


def hands_of_arms(
    hands: Hands, bodies: Bodies, image_size: tuple[int, int], config: Config
) -> FloatArray:
    """Where hands would be that were not found, and that their owners' poses would not refuse.

    Args:
        hands: Those that were found.
        bodies: Who is there.
        image_size: Width and height of the picture in pixels.
        config: What poses refuse.

    Returns:
        Landmarks of open hands that go on where the forearms end, shape (G, 21, 2).
    """
    arms = bodies.is_visible[:, WRISTS] & np.isfinite(bodies.shoulder_px)[:, None]
    arms &= arms_without_hand(hands, bodies)
    drawn = draw_hands(bodies, arms, image_size, config)
    owner: IntArray = np.nonzero(arms)[0]
    refused = hands_at_head(drawn, bodies, owner, config.hand_head_clearance)
    refused |= hands_below_shoulders(drawn, bodies, owner, config.hand_shoulder_rise_min)
    return drawn.landmarks_px[~refused]


def _nearest_strips(boxes_px: FloatArray, strips: list[Window]) -> IntArray:
    """Shape (B,): the strip in whose middle, more or less, each box lies."""
    strip_px = np.array([left + width / 2 for left, _, width, _ in strips])
    box_px = boxes_px[:, [0, 2]].mean(axis=1)
    return np.asarray(np.abs(box_px[:, None] - strip_px).argmin(axis=1), dtype=np.int64)
