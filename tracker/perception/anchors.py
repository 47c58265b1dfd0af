"""Where does the palm model's every output row look? The anchors of its single-shot detector."""

from __future__ import annotations

import numpy as np

from tracker.containers import FloatArray

#: (stride in pixels, anchors per cell) of each output map, in the order of the model's rows. The
#: last three maps of the model share stride 16 with two anchors each: six a cell.
PALM_LAYERS = ((8, 2), (16, 6))


def make_anchors(input_px: int, layers: tuple[tuple[int, int], ...] = PALM_LAYERS) -> FloatArray:
    """Centers of all anchors, layer by layer, row by row, the anchors of a cell in succession.

    Args:
        input_px: Side of the square input; a multiple of every stride.
        layers: (stride in pixels, anchors per cell) of each output map.

    Returns:
        Shape (A, 2): x and y in pixels of the input; A is 2016 for 192 px, 1400 for 160 px.

    Source: Liu et al., "SSD: Single Shot MultiBox Detector", ECCV 2016; anchors of fixed size
        as in Bazarevsky et al., "BlazeFace", 2019.
    """
    parts = []
    for stride, per_cell in layers:
        centers = (np.arange(input_px // stride) + 0.5) * stride
        x, y = np.meshgrid(centers, centers)
        parts.append(np.repeat(np.stack([x.ravel(), y.ravel()], axis=-1), per_cell, axis=0))
    return np.concatenate(parts)
