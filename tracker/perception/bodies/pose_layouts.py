"""Input and output of pose models, in four usual layouts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tracker.errors import ModelFileError
from tracker.perception.bodies.bodies import Bodies, Joint
from tracker.perception.regions import box_overlap, first_of_each

#: Name and shape of an input or output; -1 for a dimension that is free.
Shapes: TypeAlias = Mapping[str, tuple[int, ...]]
Outputs: TypeAlias = Mapping[str, NDArray[np.float32]]

JOINTS = len(Joint)
#: Boxes that overlap more than this are the same person; usual for YOLO-pose.
_SAME_PERSON_OVERLAP = 0.65
#: The surest rows of YOLO-pose; among the rest is nobody.
_YOLO_ROWS = 300
#: Mean and spread of ImageNet's colors, red, green, blue, with which RTMPose was trained.
_IMAGENET_MEAN, _IMAGENET_STD = (123.675, 116.28, 103.53), (58.395, 57.12, 57.375)
UNDERSTOOD = (
    "RTMO (outputs [1, N, 5] and [1, N, 17, 3]), RTMPose (simcc_x and simcc_y, [1, 17, bins]), "
    "MoveNet MultiPose ([1, 6, 56]) and YOLO-pose ([1, 56, N])"
)


@dataclass(frozen=True, slots=True)
class PoseLayout:
    """What is known of a family of pose models.

    Attributes:
        name: As people call it.
        channels_first: The input is (1, 3, height, width) instead of (1, height, width, 3).
        rgb: Red comes first; otherwise blue.
        mean: Taken off each channel (0 to 255) ...
        std: ... before it is divided by this.
        fill: Gray of what the picture leaves free, 0 to 255.
        input_px: Width and height where the file leaves them free.
        one_person: The model takes one person for granted and wants to look at strips.
        decode: Outputs and size of the input to bodies in pixels of the input.
    """

    name: str
    channels_first: bool
    rgb: bool
    mean: tuple[float, float, float]
    std: tuple[float, float, float]
    fill: int
    input_px: tuple[int, int]
    one_person: bool
    decode: Callable[[Outputs, tuple[int, int]], Bodies]

    def input_size(self, shape: Sequence[int]) -> tuple[int, int]:
        """Width and height of the input, from its shape in the file."""
        height, width = shape[2:4] if self.channels_first else shape[1:3]
        usual = self.input_px
        return (width if width > 0 else usual[0], height if height > 0 else usual[1])

    def pack(self, bgr: NDArray[np.uint8], dtype: Any) -> NDArray[Any]:
        """A picture of the input's size as the model's input, shape (1, ...)."""
        picture = bgr[..., ::-1] if self.rgb else bgr
        if np.issubdtype(dtype, np.integer):
            numbers = picture.astype(dtype)
        else:
            numbers = ((picture - np.array(self.mean)) / np.array(self.std)).astype(dtype)
        if self.channels_first:
            numbers = numbers.transpose(2, 0, 1)
        return np.ascontiguousarray(numbers[None])


def recognize(origin: str, inputs: Shapes, outputs: Shapes) -> PoseLayout:
    """Tell the family of a model by its inputs and outputs; `origin` is its name, for the message.

    Raises:
        ModelFileError: It is none of those understood; the message lists what was found.
    """
    layout = _layout_of(outputs)
    wanted = (None, 3, None, None) if layout and layout.channels_first else (None, None, None, 3)
    if layout and len(inputs) == 1 and all(_fits(shape, wanted) for shape in inputs.values()):
        return layout
    found = " and ".join(
        f"{word} " + ", ".join(f"{name} {list(shape)}" for name, shape in side.items())
        for word, side in (("inputs", inputs), ("outputs", outputs))
    )
    raise ModelFileError(
        f"{origin} has {found}: this is not a supported layout of a pose model. Give "
        f"`pose_model` a "
        f"file of {UNDERSTOOD}."
    )


def _layout_of(outputs: Shapes) -> PoseLayout | None:
    shapes = sorted(outputs.values(), key=len)
    for layout, wanted in (
        (RTMPOSE, [(1, JOINTS, None)] * 2),
        (MOVENET, [(1, 6, 5 + 3 * JOINTS)]),
        (YOLO, [(1, 5 + 3 * JOINTS, None)]),
        (RTMO, [(1, None, 5), (1, None, JOINTS, 3)]),
    ):
        is_named = layout is not RTMPOSE or set(outputs) == {"simcc_x", "simcc_y"}
        if is_named and len(shapes) == len(wanted) and all(map(_fits, shapes, wanted)):
            return layout
    return None


def _fits(shape: tuple[int, ...], wanted: tuple[int | None, ...]) -> bool:
    """Whether a shape fits the expected one, where both are known."""
    return len(shape) == len(wanted) and all(
        size in (want, -1) or want is None for size, want in zip(shape, wanted, strict=True)
    )


def _decode_rtmo(outputs: Outputs, _: tuple[int, int]) -> Bodies:
    """Boxes with a score (x, y, x, y, score) and joints (x, y, visibility), already sorted out."""
    people, joints = sorted(
        (array[0].astype(np.float64) for array in outputs.values()), key=np.ndim
    )
    return Bodies.seen_now(joints[..., :2], joints[..., 2], people[:, 4])


def _decode_rtmpose(outputs: Outputs, size: tuple[int, int]) -> Bodies:
    """One person: for each joint a curve over the columns and one over the rows."""
    points, peaks = [], []
    for name, pixels in zip(("simcc_x", "simcc_y"), size, strict=True):
        curve = outputs[name][0].astype(np.float64)
        points.append(curve.argmax(axis=-1) * (pixels / curve.shape[-1]))
        peaks.append(curve.max(axis=-1))
    visibility = np.clip(np.minimum(*peaks), 0.0, 1.0)
    return Bodies.seen_now(
        np.stack(points, axis=-1)[None], visibility[None], visibility.mean(keepdims=True)
    )


def _decode_movenet(outputs: Outputs, size: tuple[int, int]) -> Bodies:
    """Joints (y, x, visibility) in shares of the input, then a box and its score."""
    rows = next(iter(outputs.values()))[0].astype(np.float64)
    joints = rows[:, : 3 * JOINTS].reshape(-1, JOINTS, 3)
    return Bodies.seen_now(joints[..., [1, 0]] * np.array(size), joints[..., 2], rows[:, -1])


def _decode_yolo(outputs: Outputs, _: tuple[int, int]) -> Bodies:
    """Columns: box (center, width, height), score, joints (x, y, visibility); overlaps remain."""
    rows = next(iter(outputs.values()))[0].astype(np.float64).T
    rows = rows[np.argsort(-rows[:, 4], kind="stable")[:_YOLO_ROWS]]
    boxes = np.concatenate(
        [rows[:, :2] - rows[:, 2:4] / 2, rows[:, :2] + rows[:, 2:4] / 2], axis=-1
    )
    same = box_overlap(boxes, boxes) > _SAME_PERSON_OVERLAP
    keep = first_of_each(same, range(len(rows)))
    joints = rows[keep, 5:].reshape(-1, JOINTS, 3)
    return Bodies.seen_now(joints[..., :2], joints[..., 2], rows[keep, 4])


_AS_IT_IS = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
RTMO = PoseLayout("RTMO", True, False, *_AS_IT_IS, 114, (640, 640), False, _decode_rtmo)
RTMPOSE = PoseLayout(
    "RTMPose", True, True, _IMAGENET_MEAN, _IMAGENET_STD, 0, (192, 256), True, _decode_rtmpose
)
MOVENET = PoseLayout(
    "MoveNet MultiPose", False, True, *_AS_IT_IS, 0, (256, 256), False, _decode_movenet
)
YOLO = PoseLayout(
    "YOLO-pose", True, True, _AS_IT_IS[0], (255.0,) * 3, 114, (640, 640), False, _decode_yolo
)
