"""What is remembered of earlier images and scans: furniture, owners of hands, who sits."""

from __future__ import annotations

from dataclasses import dataclass, field

from tracker.ranging.ownership import Ownership
from tracker.ranging.postures import Postures
from tracker.ranging.scan.background import Background


@dataclass(slots=True)
class Memory:
    """Goes from image to image with what ranging remembers.

    Attributes:
        background: Which places hold furniture.
        ownership: Whose hands there are.
        postures: Who was seen to sit.
    """

    background: Background = field(default_factory=Background)
    ownership: Ownership = field(default_factory=Ownership)
    postures: Postures = field(default_factory=Postures)

    def reset(self) -> None:
        """Forget everything."""
        self.background.reset()
        self.ownership.reset()
        self.postures.reset()
