"""Whose hand is it that is about to count as raised? A look around that hand, and only then.

A person is some nine hands tall: a window of so many lengths of the hand shows the pose models its
owner at any distance, which the picture as a whole does not, and costs nothing while no hand is
up.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, CameraImage, FloatArray, Hands, ImageArray
from tracker.perception.bodies import HEAD, Bodies, one_row_each
from tracker.perception.models import ModelStore
from tracker.perception.palm_search import Window
from tracker.perception.pictures import continues
from tracker.perception.pose_file import PoseFile
from tracker.perception.pose_landmarks import PoseReader
from tracker.perception.pose_rules import VOUCHING_WRIST_SHOULDERS, find_owners
from tracker.perception.pose_search import PoseSearch
from tracker.perception.search_plan import clip_boxes

#: Sides of the windows, in hand lengths, tried one after the other until one shows the owner; of
#: people as near as one meter the second shows more than the picture holds of their legs.
WINDOW_HANDS = (10.0, 6.0, 16.0)
#: Where the wrist is in a window, in shares of the side from the top.
_WRIST_AT = 0.3
#: A hand whose owner is known, or was looked for in every window, is asked about again after so
#: long; bodies count for a second.
_AGAIN_S = 0.5
#: People of a window whose joints are read, the surest first.
_READS = 2
#: Bodies seen longer ago than this are forgotten.
_FORGET_AFTER_S = 1.0

Look = Callable[[ImageArray, Window], Bodies]


@dataclass(frozen=True, slots=True)
class _Question:
    """A hand that was asked about: where, when, without owner since when, windows tried."""

    wrist_px: FloatArray
    reach_px: float
    stamp_ns: int
    unowned_ns: int
    tries: int


class OwnerFinder:
    """Looks for the owners of raised hands, one hand in an image, those never asked about first.

    Args:
        look: Everybody whom a pose model sees in a window of a picture.
    """

    def __init__(self, look: Look) -> None:
        self._look = look
        self._hands = Hands.none()
        self._last: CameraImage | None = None
        self._known = Bodies.none()
        self._questions: list[_Question] = []

    def expect(self, hands: Hands) -> None:
        """Look for the owners of these in the next image, in which they were found."""
        self._hands = hands

    def find(self, image: CameraImage) -> Bodies:
        """Everybody seen of late around a raised hand.

        A stamp that jumps back, another frame_id or another size of the image starts anew.
        """
        hands, self._hands = self._hands, Hands.none()
        if self._last is None or not continues(self._last, image):
            self.reset()
        passed_ns = image.stamp_ns - (self._last or image).stamp_ns
        self._last = image
        known = self._known.grown_older(passed_ns / 1e9)
        self._known = known[known.age_s <= _FORGET_AFTER_S]
        self._questions = [
            question
            for question in self._questions
            if image.stamp_ns - question.stamp_ns <= _FORGET_AFTER_S * 1e9
        ]
        up = hands[hands.raised | hands.pending]
        due_s = [self._due_s(hand, image.stamp_ns) for hand in rows_of(up)]
        if max(due_s, default=0.0) > 0.0:
            self._ask(image, up[[int(np.argmax(due_s))]])
        return self._known

    def still_looking(self, hands: Hands, patience_s: FloatArray) -> BoolArray:
        """Whose owners are neither known nor given up?

        Args:
            hands: As told to `expect` for the last image.
            patience_s: Shape (H,): for how long each is looked for, beyond every window once.

        Returns:
            Shape (H,).
        """
        return np.array(
            [self._is_open(*pair) for pair in zip(rows_of(hands), patience_s, strict=True)],
            dtype=bool,
        )

    def reset(self) -> None:
        """Forget everybody."""
        self._last = None
        self._known = Bodies.none()
        self._questions = []

    def configure(self, config: Config) -> None:
        """Nothing of it is decided here."""

    def _due_s(self, hand: Hands, stamp_ns: int) -> float:
        """How urgent it is to ask about a hand: not at all if this is not above 0."""
        question = self._asked(hand)
        if question is None:
            return np.inf
        waited_s = (stamp_ns - question.stamp_ns) / 1e9
        return waited_s if self._is_open(hand) else waited_s - _AGAIN_S

    def _is_open(self, hand: Hands, patience_s: float = 0.0) -> bool:
        """Whether its owner is unknown, and was not looked for in every window and long enough."""
        question = self._asked(hand)
        if question is None or self._last is None:
            return True
        looked_s = (self._last.stamp_ns - question.unowned_ns) / 1e9
        is_given_up = question.tries >= len(WINDOW_HANDS) and looked_s >= patience_s
        return not is_given_up and self._is_unowned(hand)

    def _is_unowned(self, hand: Hands) -> bool:
        # Whoever's head is not seen cannot tell whether the hand is at it.
        known = self._known[self._known.is_visible[:, HEAD].any(axis=1)]
        return bool(find_owners(hand, known, VOUCHING_WRIST_SHOULDERS)[0] < 0)

    def _asked(self, hand: Hands) -> _Question | None:
        apart_px = [np.linalg.norm(hand.wrist_px[0] - item.wrist_px) for item in self._questions]
        if not apart_px or min(apart_px) > self._questions[int(np.argmin(apart_px))].reach_px:
            return None
        return self._questions[int(np.argmin(apart_px))]

    def _ask(self, image: CameraImage, hand: Hands) -> None:
        last = self._asked(hand)
        self._questions = [item for item in self._questions if item is not last]
        tries = 0 if last is None else last.tries
        window = window_around(hand, WINDOW_HANDS[tries % len(WINDOW_HANDS)], image)
        seen = Bodies.concatenate(self._look(image.bgr, window), self._known)
        seen = seen[~seen.is_misread]
        self._known = seen[one_row_each(seen)]
        is_unowned = self._is_unowned(hand)
        tries += int(is_unowned)  # the window that showed the owner is tried first the next time
        unowned_ns = image.stamp_ns if last is None or not is_unowned else last.unowned_ns
        reach_px = float(hand.length_px[0])
        self._questions.append(
            _Question(hand.wrist_px[0], reach_px, image.stamp_ns, unowned_ns, tries)
        )


def window_around(hand: Hands, side_hands: float, image: CameraImage) -> Window:
    """The part of a picture in which the owner of a hand would be.

    Args:
        hand: One.
        side_hands: Of the window before it is cut to the picture, in lengths of the hand.
        image: The picture.
    """
    side_px = side_hands * hand.length_px[0]
    low = hand.wrist_px[0] - side_px * np.array([0.5, _WRIST_AT])
    (box,) = clip_boxes(np.concatenate([low, low + side_px])[None], (image.width, image.height))
    left, top, right, bottom = box.round().astype(int).tolist()
    return left, top, right - left, bottom - top


def rows_of(hands: Hands) -> list[Hands]:
    """Each hand as a batch of its own."""
    return [hands[[row]] for row in range(len(hands))]


def mediapipe_look(store: ModelStore, config: Config) -> Look:
    """A look with MediaPipe's pose models.

    Raises:
        ModelFileError: A model file is absent or unusable; the message says how to fetch it.
        ConfigError: ONNX Runtime has no such execution provider.
    """
    threads, provider = config.inference_threads, config.execution_provider
    searcher = PoseSearch.open(store, threads=threads, provider=provider)
    reader = PoseReader.open(store, threads=threads, provider=provider)

    def look(bgr: ImageArray, window: Window) -> Bodies:
        regions = searcher.find(bgr, window, config.pose_confidence)[:_READS]
        bodies, _ = reader.read(bgr, regions)
        return bodies[bodies.score >= config.pose_confidence]

    return look


def file_look(config: Config) -> Look:
    """A look with the pose model in the user's own file.

    Raises:
        ModelFileError: The file is absent, no ONNX file, or of no layout that is understood.
        ConfigError: ONNX Runtime has no such execution provider.
    """
    model = PoseFile.open(Path(config.pose_model), config)

    def look(bgr: ImageArray, window: Window) -> Bodies:
        bodies = model.look(bgr, window)
        return bodies[bodies.score >= config.pose_confidence]

    return look
