"""The connection of one input: publishers, and why nothing is received."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from tracker.wording import counted


class Link(NamedTuple):
    """The connection to who publishes an input.

    Attributes:
        publishers: How many are connected.
        refusal: Why others are not, in words; empty if there are none.
        loss: Why part of what comes is lost, in words; empty if nothing is known to be.
        values: Numbers for /diagnostics.
    """

    publishers: int
    refusal: str = ""
    loss: str = ""
    values: Mapping[str, object] = {}

    @property
    def silence(self) -> str:
        """Why nothing comes, to follow the words that say so."""
        if self.publishers == 0:
            return f"; {self.refusal}" if self.refusal else ", which has no publisher"
        why = self.loss or self.refusal
        return f"; {counted(self.publishers, 'publisher')} connected" + (
            f", but {why}" if why else ""
        )
