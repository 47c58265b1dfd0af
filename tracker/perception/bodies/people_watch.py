"""Whose hand is it, and has an arm gone up whose hand was not found? One look in an image.

A person is some nine hands tall: a window of so many lengths of the hand shows the pose models its
owner at any distance, which the picture as a whole does not. The palm model overlooks every other
hand of fifteen pixels, the pose models hardly any of their owners: upright strips of the picture
are looked at in turn, those in which something moved more often.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.config import Config
from tracker.containers import BoolArray, CameraImage, FloatArray, Hands, IntArray
from tracker.perception.bodies.bodies import Bodies, one_row_each
from tracker.perception.bodies.body_look import BodyLook
from tracker.perception.bodies.owners import arms_without_hand, find_owners, hand_size_px
from tracker.perception.pictures import Window, continues, upright_strips
from tracker.perception.search_plan import clip_boxes

#: Sides of the windows, in hand lengths, tried one after the other until one shows the owner; of
#: people as near as one meter the second shows more than the picture holds of their legs.
WINDOW_HANDS = (10.0, 6.0, 16.0)
#: Where the wrist is in a window, in shares of the side from the top.
_WRIST_AT = 0.3
#: Places of the palm search that take as long as a look at a strip.
LOOK_PLACES = 2
#: Bodies seen longer ago than this are forgotten.
FORGET_AFTER_S = 1.2
#: A strip is watched for so long after something moved in it: an arm takes half a second to go
#: up, and not every look shows it.
_WATCH_S = 2.0
#: How often each kind of look is due, s: a hand whose owner is unknown, until every window was
#: tried, and after that; an owner; an arm that is up without a hand; a strip in which something
#: moved, and any strip.
_UNOWNED_S, _IN_VAIN_S, _OWNER_S, _ARM_S, _MOVED_S, _STRIP_S = 0.05, 0.5, 0.5, 0.1, 0.3, 1.0


@dataclass(slots=True)
class _Question:
    """A hand whose owner was searched: where, when, and how often without success."""

    wrist_px: FloatArray
    reach_px: float
    stamp_ns: int
    tries: int


class PeopleWatch:
    """Goes from image to image and looks at what is most overdue."""

    def __init__(self, look: BodyLook) -> None:
        self._look = look
        self.reset()

    def reset(self) -> None:
        """Forget everybody."""
        self._last: CameraImage | None = None
        self._known = Bodies.none()
        self._questions: list[_Question] = []
        self._strips: list[Window] = []
        self._moved_ns = self._looked_ns = np.zeros(0)
        self._strip_ns = 0.0

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on."""
        self._look.configure(config)

    @property
    def looks_next(self) -> bool:
        """Whether a strip is likely to be looked at in the next image."""
        return self._last is not None and self._strip_need(self._last.stamp_ns + 1e8)[0] >= 1.0

    def find(
        self,
        image: CameraImage,
        hands: Hands,
        calling: BoolArray,
        moved_px: FloatArray,
        *,
        rests: bool = False,
    ) -> Bodies:
        """Everybody seen of late; those looked at in this very image have age 0.

        A stamp that jumps back, another frame_id or another size of the image starts anew.

        Args:
            image: The next one.
            hands: Found in it.
            calling: Shape (H,): hands that may call, for themselves; others can wait.
            moved_px: Shape (M, 4): boxes in which something moved.
            rests: Whether strips have to wait, as there is no time.
        """
        if self._last is None or not continues(self._last, image):
            self._begin(image)
        now_ns, passed_ns = image.stamp_ns, image.stamp_ns - (self._last or image).stamp_ns
        self._last = image
        known = self._known.grown_older(passed_ns / 1e9)
        if (known.age_s > FORGET_AFTER_S).any():
            known = known[known.age_s <= FORGET_AFTER_S]
        self._known = known
        self._questions = [
            item for item in self._questions if now_ns - item.stamp_ns <= FORGET_AFTER_S * 1e9
        ]
        self._moved_ns[_nearest_strips(moved_px, self._strips)] = now_ns
        hand_need = self._hand_needs(hands, calling, now_ns)
        body_need = self._body_needs(hands, calling)
        strip_need, strip = self._strip_need(now_ns)
        needs = (hand_need.max(initial=0), body_need.max(initial=0), 0 if rests else strip_need)
        kind = int(np.argmax(needs))
        if needs[kind] < 1.0:
            return self._known
        if kind == 0:
            self._ask(image, hands[[int(hand_need.argmax())]])
        elif kind == 1:
            row = int(body_need.argmax())
            others = np.arange(len(known)) != row
            self._learn(self._look.again(image.bgr, known[[row]]), known[others])
        else:
            self._looked_ns[strip] = self._strip_ns = now_ns
            self._learn(self._look.around(image.bgr, self._strips[strip]), known)
        return self._known

    def is_asked(self, hands: Hands) -> BoolArray:
        """Shape (H,): hands whose owner was looked for in every window."""
        tries = [getattr(self._asked(hand), "tries", 0) for hand in rows_of(hands)]
        return np.array(tries, dtype=np.int64) >= len(WINDOW_HANDS)

    def _begin(self, image: CameraImage) -> None:
        self.reset()
        self._last = image
        self._strips = upright_strips(image.width, image.height)
        self._moved_ns = np.full(len(self._strips), -np.inf)
        self._looked_ns = image.stamp_ns + 1e8 * np.arange(-len(self._strips), 0.0)
        self._strip_ns = image.stamp_ns - 1e9

    def _hand_needs(self, hands: Hands, calling: BoolArray, now_ns: int) -> FloatArray:
        """How overdue a look for the owner of each hand is; 1 is due."""
        owner = find_owners(hands, self._known)
        needs = np.zeros(len(hands))
        for row, hand in enumerate(rows_of(hands)):
            if owner[row] >= 0:
                continue
            question = self._asked(hand)
            if question is None:
                needs[row] = 100.0 if calling[row] else 1.0
                continue
            is_open = question.tries < len(WINDOW_HANDS) and calling[row]
            needs[row] = (now_ns - question.stamp_ns) / 1e9
            needs[row] /= _UNOWNED_S if is_open else _IN_VAIN_S
        return needs

    def _body_needs(self, hands: Hands, calling: BoolArray) -> FloatArray:
        """How overdue another look at each known body is; 1 is due."""
        known = self._known
        if len(known) == 0:
            return np.zeros(0)
        period_s = np.full(len(known), np.inf)
        owner = find_owners(hands, known)
        period_s[owner[owner >= 0]] = 2.0 * _OWNER_S
        period_s[owner[(owner >= 0) & calling]] = _OWNER_S
        arms = arms_without_hand(hands, known) & known.arms_up
        period_s[arms.any(axis=1)] = _ARM_S
        return np.asarray(known.age_s / period_s)

    def _strip_need(self, now_ns: float) -> tuple[float, int]:
        """The strip that is most overdue, and by how much."""
        if len(self._strips) == 0:
            return 0.0, 0
        is_watched = now_ns - self._moved_ns <= _WATCH_S * 1e9
        since_s = (now_ns - self._strip_ns) / 1e9
        period_s = _MOVED_S if is_watched.any() else _STRIP_S
        looked_ns = np.where(is_watched, self._looked_ns, np.inf)
        looked_ns = looked_ns if is_watched.any() else self._looked_ns
        return since_s / period_s, int(np.argmin(looked_ns))

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
        self._learn(self._look.around(image.bgr, window), self._known)
        # The window that showed the owner is tried first the next time.
        tries += int(find_owners(hand, self._known)[0] < 0)
        reach_px = float(hand_size_px(hand)[0])
        self._questions.append(_Question(hand.wrist_px[0], reach_px, image.stamp_ns, tries))

    def _learn(self, seen: Bodies, known: Bodies) -> None:
        seen = Bodies.concatenate(seen[~seen.is_misread], known)
        self._known = seen[one_row_each(seen)]


def window_around(hand: Hands, side_hands: float, image: CameraImage) -> Window:
    """The part of a picture in which the owner of one hand would be, so many hand lengths wide."""
    side_px = side_hands * hand_size_px(hand)[0]
    low = hand.wrist_px[0] - side_px * np.array([0.5, _WRIST_AT])
    (box,) = clip_boxes(np.concatenate([low, low + side_px])[None], (image.width, image.height))
    left, top, right, bottom = box.round().astype(int).tolist()
    return left, top, right - left, bottom - top


def rows_of(hands: Hands) -> list[Hands]:
    """Each hand as a batch of its own."""
    return [hands[[row]] for row in range(len(hands))]


def _nearest_strips(boxes_px: FloatArray, strips: list[Window]) -> IntArray:
    """Shape (B,): the strip in whose middle, more or less, each box lies."""
    strip_px = np.array([left + width / 2 for left, _, width, _ in strips])
    box_px = boxes_px[:, [0, 2]].mean(axis=1)
    return np.asarray(np.abs(box_px[:, None] - strip_px).argmin(axis=1), dtype=np.int64)
