"""Which sign does a hand show in one image? A small network says so.

`benchmarks/fit_gestures.py` fitted it to drawn hands alone (`tracker.simulation.hand_signs`, seed
1701).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from tracker.containers import FloatArray
from tracker.gesture import Gesture
from tracker.perception.gestures.shape import hand_shape, thumb_rise

#: What the columns of `sign_probabilities` mean: the signs of one image are the first codes.
SIGNS = tuple(Gesture)[: Gesture.THUMB_DOWN + 1]
#: The network knows a closed hand with its thumb stretched, this column; whether the thumb points
#: up or down is seen in the picture. Halfway is this much of straight up, 45 degrees ...
THUMB, _UPRIGHT = int(Gesture.THUMB_UP), np.sqrt(0.5)
#: ... and so fast it becomes sure beyond: at 30 degrees .93 (guess).
_SHARPNESS = 16.0
_WEIGHTS_FILE = Path(__file__).with_name("signs.npz")


@dataclass(frozen=True, slots=True, eq=False)
class SignNetwork:
    """Two hidden layers of hyperbolic tangents, and a softmax over NONE to THUMB.

    Attributes:
        weights: Shapes (40, A), (A, B) and (B, 6).
        biases: Shapes (A,), (B,) and (6,).
    """

    weights: tuple[FloatArray, ...]
    biases: tuple[FloatArray, ...]

    def hidden(self, shapes: FloatArray) -> list[FloatArray]:
        """What each layer gets, from shapes (H, 40): the shapes, then both hidden layers."""
        layers = [shapes]
        for weight, bias in zip(self.weights[:-1], self.biases[:-1], strict=True):
            layers.append(np.tanh(layers[-1] @ weight + bias))
        return layers

    def probabilities(self, shapes: FloatArray) -> FloatArray:
        """Shape (H, 6): of NONE, PALM, FIST, POINT, VICTORY and a stretched thumb."""
        return self.softmax(self.hidden(shapes)[-1])

    def softmax(self, last: FloatArray) -> FloatArray:
        """The probabilities that the last hidden layer, shape (H, B), leads to."""
        odds = last @ self.weights[-1] + self.biases[-1]
        odds = np.exp(odds - odds.max(axis=-1, keepdims=True))
        return np.asarray(odds / odds.sum(axis=-1, keepdims=True))

    def save(self, path: Path) -> None:
        """Write the weights, in single precision."""
        np.savez(path, *(part.astype(np.float32) for part in (*self.weights, *self.biases)))

    @staticmethod
    def load(path: Path = _WEIGHTS_FILE) -> SignNetwork:
        """Read the weights that `save` wrote."""
        with np.load(path) as file:
            parts = [file[name].astype(np.float64) for name in file.files]
        half = len(parts) // 2
        return SignNetwork(tuple(parts[:half]), tuple(parts[half:]))


@lru_cache(maxsize=1)
def sign_network() -> SignNetwork:
    """The network that comes along."""
    return SignNetwork.load()


def sign_probabilities(landmarks_px: FloatArray, network: SignNetwork | None = None) -> FloatArray:
    """How probably each hand shows each of `SIGNS`, shape (H, 7).

    Args:
        landmarks_px: Shape (H, 21, 2): x to the right, y down, in MediaPipe's order.
        network: By default the one that comes along.
    """
    network = network or sign_network()
    told = network.probabilities(hand_shape(landmarks_px))
    rise = thumb_rise(landmarks_px)
    up, down = (1.0 / (1.0 + np.exp(_SHARPNESS * (_UPRIGHT - way))) for way in (rise, -rise))
    thumb = told[:, THUMB]
    aside = told[:, 0] + thumb * np.maximum(1.0 - up - down, 0.0)
    return np.column_stack([aside, told[:, 1:THUMB], thumb * up, thumb * down])
