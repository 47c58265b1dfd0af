"""Do the bodies agree with the hands? Poses refuse hands at the head and add arms that are up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TypeAlias

import numpy as np

from tracker.config import Config
from tracker.containers import (
    BoolArray,
    CameraImage,
    FloatArray,
    Hands,
    ImageArray,
    IntArray,
    PerceptionWork,
    Refusal,
)
from tracker.perception.arm_watch import LOOK_PLACES, ArmWatch, hands_of_arms
from tracker.perception.bodies import Bodies
from tracker.perception.body_detector import BodyDetector
from tracker.perception.detector import GuidedDetector, HandDetector, PiecewiseDetector
from tracker.perception.gray import tint_gray
from tracker.perception.head_memory import HeadMemory
from tracker.perception.owner_finder import OwnerFinder
from tracker.perception.pose_hands import draw_hands
from tracker.perception.pose_rules import (
    VOUCHING_WRIST_SHOULDERS,
    arms_without_hand,
    clearance_of,
    find_owners,
    hands_at_head,
    hands_at_rest,
    hands_below_shoulders,
    hands_on_faces,
    judge_arms,
)

#: Bodies seen longer ago than this say nothing any more: an arm goes up or down in half of it
#: (guess).
_BODY_MAX_AGE_S = 1.0

#: A hand that is not even up for itself: the bodies' reasons come after these.
_BY_RULE = (Refusal.NOT_UP, Refusal.LEANS, Refusal.CLOSED)

_AtHead: TypeAlias = Callable[[Hands, Bodies, IntArray, FloatArray], BoolArray]


class SecondOpinion:
    """A hand detector whose answers are weighed against body poses.

    Args:
        hands: Finds hands.
        bodies: Finds people, in its own time.
        config: The pose group.
        watch: Finds people whose arm may have gone up; None for nobody.
    """

    def __init__(
        self,
        hands: HandDetector,
        bodies: BodyDetector,
        config: Config,
        watch: ArmWatch | None = None,
    ) -> None:
        self._hands = hands
        self._watch = watch
        self._is_pressed = False
        self._bodies = bodies
        self._config = config
        self._memory = HeadMemory()

    @property
    def work(self) -> PerceptionWork:
        """What the hands of the last image cost; the bodies are not counted."""
        return self._hands.work if isinstance(self._hands, PiecewiseDetector) else PerceptionWork()

    @property
    def seen(self) -> ImageArray | None:
        """The last image as the hands' models saw it, where they tell."""
        return self._hands.seen if isinstance(self._hands, PiecewiseDetector) else None

    def expect(self, boxes_px: FloatArray) -> None:
        """Where raised hands are likelier; told to a hand detector that can be told."""
        if isinstance(self._hands, PiecewiseDetector):
            self._hands.expect(boxes_px)

    def set_budget(self, runs: int | None) -> None:
        """How many model runs the hands of an image may take; arms are not watched then."""
        self._is_pressed = runs is not None
        if isinstance(self._hands, PiecewiseDetector):
            self._hands.set_budget(runs)

    def find(self, image: CameraImage) -> Hands:
        """Every hand of the image, in pixels of the full image."""
        hands = self._hands.find(image)
        if self._config.raise_rule == "image" and self._config.pose_opinion == "veto":
            return hands  # the specification's rule stays what it is
        seen = image.bgr if self.seen is None else self.seen
        image = replace(image, bgr=tint_gray(seen))
        if isinstance(self._bodies, OwnerFinder):
            self._bodies.expect(hands)
        bodies = self._bodies.find(image)
        if isinstance(self._bodies, OwnerFinder):
            patience_s = unowned_patience_s(hands, image.height, self._config)
            is_waiting = self._bodies.still_looking(hands, patience_s)
            refusal = np.where(hands.raised & is_waiting, Refusal.OWNER_UNKNOWN, hands.refusal)
            hands = replace(hands, raised=hands.raised & ~is_waiting, refusal=refusal)
        self._watch_arms(image, hands, bodies[bodies.age_s == 0.0])
        at_head = partial(self._memory.judge, image.stamp_ns)
        return weigh_opinions(hands, bodies, _size(image), self._config, at_head)

    def _watch_arms(self, image: CameraImage, hands: Hands, seen: Bodies) -> None:
        """Tell the hand detector where hands are missing, and to make room for the next look."""
        if self._watch is None or not isinstance(self._hands, GuidedDetector):
            return
        rests = self._is_pressed or len(seen) > 0
        seen = Bodies.concatenate(seen, self._watch.find(image, rests=rests))
        self._hands.suggest(hands_of_arms(hands, seen, _size(image), self._config))
        if self._watch.looks_next and not self._is_pressed:
            self._hands.spare(LOOK_PLACES)

    def reset(self) -> None:
        """Forget earlier images."""
        if self._watch is not None:
            self._watch.reset()
        self._hands.reset()
        self._bodies.reset()
        self._memory.reset()

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on.

        Raises:
            ModelFileError: As the hand detector's; nothing has changed then.
        """
        self._hands.configure(config)
        self._bodies.configure(config)
        self._config = config


def _size(image: CameraImage) -> tuple[int, int]:
    return image.width, image.height


def unowned_patience_s(hands: Hands, height_px: int, config: Config) -> FloatArray:
    """For how long each hand waits for an owner, shape (H,): a small unsure one for ever.

    A large one counts at once, unless the lower edge of the picture cuts its forearm off: people
    who talk near the camera show their palms there for a moment.
    """
    is_cut_off = hands.wrist_px[:, 1] + hands.length_px > height_px
    patience_s = np.where(hands.score < config.raised_score_min, np.inf, config.unowned_patience_s)
    return np.where(is_cut_off | (hands.length_px < config.owner_hand_px), patience_s, 0.0)


def weigh_opinions(
    hands: Hands,
    bodies: Bodies,
    image_size: tuple[int, int],
    config: Config,
    at_head: _AtHead = hands_at_head,
) -> Hands:
    """Hands as they are after the bodies have been heard.

    Args:
        hands: What the hand models found.
        bodies: Who is there, not all of them looked at just now.
        image_size: Width and height of the picture in pixels.
        config: `pose_opinion` and what it needs.
        at_head: Says which hands are at the head; it may remember earlier images.

    Returns:
        The same hands, those at their owner's head, below the shoulders or in a lap not raised,
        pending ones raised if they are the hands of somebody and none of these. With
        `pose_opinion: full` they have their owners' torsos, and after them comes a schematic hand
        for each arm that is up in this very image and has none. A look at one hand alone, as with
        `veto`, may take a neighbor for its owner, and where the hand is shall not hang on that.
    """
    bodies = bodies[bodies.age_s <= _BODY_MAX_AGE_S]
    owner = find_owners(hands, bodies)
    clearance = clearance_of(hands, config.hand_head_clearance)
    rise_min = config.hand_shoulder_rise_min
    reasons = {
        Refusal.AT_HEAD: at_head(hands, bodies, owner, clearance),
        Refusal.BELOW_SHOULDERS: hands_below_shoulders(hands, bodies, owner, rise_min),
        Refusal.AT_REST: hands_at_rest(hands, bodies, owner),
        Refusal.ON_FACE: hands_on_faces(hands, bodies, owner),
    }
    of_body = np.select(list(reasons.values()), list(reasons), Refusal.NO_REASON)
    refused = of_body != Refusal.NO_REASON
    vouched = hands.pending & (find_owners(hands, bodies, VOUCHING_WRIST_SHOULDERS) >= 0)
    raised = (hands.raised | vouched) & ~refused
    refusal = np.where(refused & ~np.isin(hands.refusal, _BY_RULE), of_body, hands.refusal)
    hands = replace(hands, raised=raised, refusal=np.where(raised, 0, refusal))
    if config.pose_opinion != "full":
        return hands
    torso = np.full((len(hands), 2), np.nan)
    torso[owner >= 0] = bodies.torso_px[owner[owner >= 0]]
    hands = replace(hands, torso_px=torso)
    raised, _ = judge_arms(bodies, config)
    arms = raised & arms_without_hand(hands, bodies) & (bodies.age_s == 0.0)[:, None]
    return Hands.concatenate(hands, draw_hands(bodies, arms, image_size, config))
