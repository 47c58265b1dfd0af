"""Which gestures are there?"""

from __future__ import annotations

from enum import IntEnum


class Gesture(IntEnum):
    """What a hand says: by its shape in one image, and the last three over some time.

    Codes stand in `Hands.gesture` and `Tracks.gesture`. NONE is everything else, and whatever
    nobody is sure of.
    """

    NONE = 0
    PALM = 1
    FIST = 2
    POINT = 3
    VICTORY = 4
    THUMB_UP = 5
    THUMB_DOWN = 6
    WAVE = 7
    STOP = 8
    COME = 9

    @property
    def word(self) -> str:
        """As parameters and messages name it: `thumb_up`."""
        return self.name.lower()

    @property
    def label(self) -> str:
        """For people: `thumb up`."""
        return self.word.replace("_", " ")


def gestures_named(words: str) -> tuple[Gesture, ...]:
    """The gestures of words separated by commas, as `palm, fist`; all of them for `all`.

    Raises:
        ValueError: A word is none of them.
    """
    if words.strip() == "all":
        return tuple(Gesture)
    known = {gesture.word: gesture for gesture in Gesture if gesture is not Gesture.NONE}
    names = [word.strip() for word in words.split(",")]
    if unknown := [name for name in names if name not in known]:
        raise ValueError(
            f"{unknown[0]!r} is not a gesture; allowed is all, or some of {', '.join(known)} "
            "separated by commas"
        )
    return tuple(known[name] for name in names)
