"""Which kinds of sensors are there, by what they measure of a person?"""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class SensorKind(IntEnum):
    """How a measurement's two numbers are read."""

    BEARING_RANGE = 0
    POSITION = 1
    BEARING = 2
    RANGE = 3


#: Shape (4, 2): which of the two numbers a kind does not have; NaN stands there.
ABSENT = np.array([[False, False], [False, False], [False, True], [True, False]])
ABSENT.setflags(write=False)
