"""Which hands call? The evidence of hands and of their owners is weighed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tracker.config import Config
from tracker.containers import (
    BoolArray,
    CameraImage,
    FloatArray,
    Hands,
    PerceptionWork,
    Refusal,
)
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.bodies.owners import (
    arms_without_hand,
    find_owners,
    hand_size_px,
    sure_owners,
)
from tracker.perception.bodies.people_watch import LOOK_PLACES, PeopleWatch
from tracker.perception.detector import NO_HINTS, Hints
from tracker.perception.hands.hand_finder import HandFinder, runs_otherwise
from tracker.perception.pictures import continues
from tracker.perception.pose_hands import draw_hands
from tracker.perception.verdict.belief import CALLS_FROM
from tracker.perception.verdict.evidence import Seen, gather_evidence
from tracker.perception.verdict.memory import HandMemory, RememberedHand
from tracker.perception.verdict.place_prior import PlacePrior
from tracker.perception.verdict.weights import NAMES, log_odds, reasons

#: An arm that was seen so long ago still counts where no hand was found.
_ARM_MAX_AGE_S = 0.2
#: A hand this far below the shoulders, in their widths, does not wave (guess).
_LOW_SHOULDERS = 0.25
#: A hand that is less likely than this to call, for itself, waits for a look at its owner.
_MAY_CALL = -3.25


@dataclass(frozen=True, slots=True, eq=False)
class Weighed:
    """How the last verdict came about; row i of each array is hand i.

    Attributes:
        bodies: Who was known.
        evidence: Shape (H, F), in the order of `weights.NAMES`.
        log_odds: Shape (H,): of this image alone.
        belief: Shape (H,): after it.
        bar: Shape (H,): what was asked for.
    """

    bodies: Bodies
    evidence: FloatArray
    log_odds: FloatArray
    belief: FloatArray
    bar: FloatArray


class CallFinder:
    """A hand detector whose hands are raised where the evidence says that they call.

    With another `raise_rule` the hands' own verdict stays.

    Args:
        hands: Finds hands.
        watch: Finds the people around them; None asks nobody.
        config: The perception and pose groups.
        open_watch: Opens such a watch, where the evidence is asked for later.
    """

    def __init__(
        self,
        hands: HandFinder,
        watch: PeopleWatch | None,
        config: Config,
        open_watch: Callable[[Config], PeopleWatch] | None = None,
    ) -> None:
        self._hands = hands
        self._watch = watch
        self._open_watch = open_watch
        self._config = config
        self._memory = HandMemory()
        self._prior = PlacePrior()
        self._told = NO_HINTS  # for the next image, by what this one shows
        self._last: CameraImage | None = None
        self.weighed: Weighed | None = None

    @property
    def work(self) -> PerceptionWork:
        """Cost of the last image's hands, without bodies."""
        return replace(self._hands.work, place_bar=self._prior.highest)

    def find(self, image: CameraImage, hints: Hints = NO_HINTS) -> Hands:
        """Every hand of the image, in pixels of the full image.

        After those that were found comes a schematic hand for each arm that is up and has none.
        """
        if self._config.raise_rule != "evidence":
            return self._hands.find(image, hints)
        if self._last is not None and not continues(self._last, image):
            self._memory.reset()
        self._last = image
        told, self._told = self._told, NO_HINTS
        told = replace(hints, suggested_px=told.suggested_px, spared=told.spared)
        hands = self._hands.find(image, told)
        bodies = self._look_around(image, hands, is_pressed=hints.model_runs is not None)
        arms = bodies.arms_up & arms_without_hand(hands, bodies)
        arms &= (bodies.age_s <= _ARM_MAX_AGE_S)[:, None]
        person = np.nonzero(arms)[0]
        drawn = draw_hands(bodies, arms, (image.width, image.height), self._config)
        seen_now = bodies.age_s[person] == 0.0
        self._told = replace(self._told, suggested_px=drawn.landmarks_px[seen_now])
        asked = np.zeros(len(hands), dtype=bool)
        if self._watch is not None:
            asked = self._watch.is_asked(hands)
        seen = Seen(
            is_found=np.arange(len(hands) + len(drawn)) < len(hands),
            owner=np.concatenate([find_owners(hands, bodies), person]),
            is_asked=np.append(asked, np.zeros(len(drawn), dtype=bool)),
            swing=np.zeros(len(hands) + len(drawn)),
        )
        return self._weigh(image.stamp_ns, Hands.concatenate(hands, drawn), bodies, seen)

    def _look_around(self, image: CameraImage, hands: Hands, is_pressed: bool) -> Bodies:
        """Who is there; arms are not watched while model runs are counted."""
        if self._watch is None:
            return Bodies.none()
        nothing = np.zeros(len(hands))
        alone = Seen(nothing == 0.0, np.full(len(hands), -1), nothing > 0.0, nothing)
        may_call = log_odds(gather_evidence(hands, Bodies.none(), alone)) > _MAY_CALL
        assert self._hands.seen is not None
        picture = replace(image, bgr=self._hands.seen.tinted_bgr)
        moved_px = self._hands.seen.moved_px
        bodies = self._watch.find(picture, hands, may_call, moved_px, rests=is_pressed)
        if self._watch.looks_next and not is_pressed:
            self._told = replace(self._told, spared=LOOK_PLACES)
        return bodies

    def _weigh(self, stamp_ns: int, hands: Hands, bodies: Bodies, seen: Seen) -> Hands:
        """The hands with the verdict on each."""
        known = self._memory.recognize(stamp_ns, hands, seen.is_found)
        seen = seen._replace(swing=np.array([item.swing() for item in known]))
        evidence = gather_evidence(hands, bodies, seen)
        faint = evidence[:, NAMES.index("faint")]
        for row in np.flatnonzero(~seen.is_found):
            faint[row] = known[row].doubt(stamp_ns, float(faint[row]))
        odds = log_odds(evidence)
        belief = _believe(stamp_ns, known, odds, evidence, bodies, seen)
        begins = np.where([item.calls for item in known], 0.0, CALLS_FROM)
        bar = begins + self._bars(stamp_ns, hands, belief > begins)
        self.weighed = Weighed(bodies, evidence, odds, belief, bar)
        raised = belief > bar
        for item, calls in zip(known, raised.tolist(), strict=True):
            item.calls = calls
        refusal = np.where(odds > 0.0, Refusal.TOO_BRIEF, reasons(evidence))
        refusal = np.where((belief > begins) & ~raised, Refusal.ALWAYS_THERE, refusal)
        # A look around a hand may show a neighbor: where the person is hangs on sure owners alone.
        owner = seen.owner.copy()
        owner[seen.is_found] = sure_owners(hands[seen.is_found], bodies)
        torso_px = np.full((len(hands), 2), np.nan)
        torso_px[owner >= 0] = bodies.torso_px[owner[owner >= 0]]
        seated = np.full(len(hands), np.nan)
        seated[owner >= 0] = bodies.seated[owner[owner >= 0]]
        return replace(
            hands,
            raised=raised,
            raise_measure=1.0 / (1.0 + np.exp(bar - belief)),
            torso_px=torso_px,
            seated=seated,
            refusal=np.where(raised, Refusal.NO_REASON, refusal),
        )

    def _bars(self, stamp_ns: int, hands: Hands, calls: BoolArray) -> FloatArray:
        if not self._config.place_prior:
            return np.zeros(len(hands))
        wrist_px, size_px = hands.wrist_px, hand_size_px(hands)
        self._prior.learn(stamp_ns, wrist_px[calls], size_px[calls])
        return self._prior.bars(stamp_ns, wrist_px, size_px)

    def reset(self) -> None:
        """Forget earlier images."""
        self._last, self._told = None, NO_HINTS
        self._hands.reset()
        self._memory.reset()
        self._prior.reset()
        if self._watch is not None:
            self._watch.reset()

    def configure(self, config: Config) -> None:
        """Take over changed parameters, from the next image on.

        Raises:
            ModelFileError: Other models are needed and cannot be opened; nothing has changed then.
        """
        watch = self._watch
        is_old = watch is None or runs_otherwise(self._config, config)
        if self._open_watch is not None and config.raise_rule == "evidence" and is_old:
            watch = self._open_watch(config)
        self._hands.configure(config)
        self._watch = watch
        if config.raise_rule != self._config.raise_rule:
            self._last, self._told = None, NO_HINTS
            self._memory.reset()
        self._config = config
        if self._watch is not None:
            self._watch.configure(config)


def _believe(
    stamp_ns: int,
    known: list[RememberedHand],
    odds: FloatArray,
    evidence: FloatArray,
    bodies: Bodies,
    seen: Seen,
) -> FloatArray:
    """Shape (H,): what is believed of each hand after an image's evidence."""
    low, palm_low, high, swing = (
        evidence[:, NAMES.index(name)] for name in ("low", "palm_low", "high", "swing")
    )
    # Hands of people who talk go to and fro as well, but below the shoulders.
    waves = np.where(low + palm_low <= _LOW_SHOULDERS, swing, 0.0)
    high = np.maximum(high, waves)
    high[(seen.owner < 0) & (high == 0.0)] = np.nan
    is_old_look = (seen.owner >= 0) & (waves == 0.0)
    is_old_look[is_old_look] = bodies.age_s[seen.owner[is_old_look]] > 0.0
    columns = odds.tolist(), high.tolist(), is_old_look.tolist()
    return np.array(
        [item.weigh(stamp_ns, *told) for item, *told in zip(known, *columns, strict=True)]
    )
