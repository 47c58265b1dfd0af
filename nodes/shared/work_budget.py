"""How many model runs may an image take? Fewer while the node is close to too slow."""

from __future__ import annotations

from tracker.containers import PerceptionWork

#: Shares of the time between two images: above the first the budget shrinks, below the second it
#: grows again. Wide apart, since one run more must not lead from the second to the first.
_TOO_BUSY, _AT_EASE = 0.8, 0.5


class WorkBudget:
    """Follows the measured times; counted in model runs, as `Hints.model_runs`."""

    def __init__(self) -> None:
        self._runs: int | None = None

    def after(self, work: PerceptionWork, busy_share: float, most_places: int) -> int | None:
        """The budget for the next image.

        Args:
            work: What perception did for the last one.
            busy_share: Of the time between two images, that the last ones took on average.
            most_places: That are searched where nothing presses.

        Returns:
            Model runs; None where nothing presses.
        """
        if busy_share > _TOO_BUSY:
            self._runs = max(1, work.places + work.hands - 1)
        elif busy_share < _AT_EASE and self._runs is not None:
            self._runs += 1
            if work.places >= most_places:
                self._runs = None
        return self._runs
