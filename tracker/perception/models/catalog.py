"""Which model files exist, where they come from, and what their inputs and outputs mean.

The weights are Google's, under the Apache License 2.0, and are not part of this project: they are
read out of the `mediapipe` wheel on the user's machine and converted there.
"""

from dataclasses import dataclass, replace

from tracker.errors import ModelFileError

# Raise it with every change that alters the converted files: files of other versions are stale.
CONVERTER_VERSION = 2

WHEEL_REQUIREMENT = "mediapipe==0.10.21"  # the last series that carries the model files
WHEEL_BYTES = 35_622_638  # of the x86-64 Linux wheel for Python 3.11; for progress and messages
LICENSE_NOTE = (
    "Model weights (c) The MediaPipe Authors, Apache License 2.0, "
    "from the PyPI wheel mediapipe 0.10.21"
)


@dataclass(frozen=True, slots=True)
class ModelOutput:
    """One output that the converted model keeps.

    Attributes:
        name: Its name in the ONNX file.
        source_name: Its name in the TFLite file.
    """

    name: str
    source_name: str


@dataclass(frozen=True, slots=True)
class ModelEntry:
    """One model file of the wheel and what becomes of it.

    Attributes:
        name: What the project calls it; the ONNX file is `<name>.onnx`.
        wheel_path: Path of the TFLite file inside the wheel.
        sha256: Hash of that TFLite file, hexadecimal.
        size_px: Side of the square input image the model was trained for.
        input_range: Smallest and largest pixel value expected, for black and white.
        outputs: The outputs to keep, in order; what only feeds others is left out.
        size_is_free: Height and width may be any multiple of 32, not only `size_px`.
        in_bytes: Some of it computes in 8 bits (see `int8`).
    """

    name: str
    wheel_path: str
    sha256: str
    size_px: int
    input_range: tuple[float, float]
    outputs: tuple[ModelOutput, ...]
    size_is_free: bool = False
    in_bytes: bool = False


# Per anchor a box and K keypoints: x, y of the box's center, its width and height, then x, y of
# each keypoint (palm K = 7, pose K = 4); positions count from the anchor's center, all in pixels
# of the input. Scores are logits.
_DETECTOR_OUTPUTS = (ModelOutput("boxes", "Identity"), ModelOutput("scores", "Identity_1"))

# 21 x (x, y, z) in pixels of the input; probability that a hand is there; probability that it is a
# right hand (MediaPipe calls it "Left", as it takes the image for a mirrored one); 21 x (x, y, z)
# in meters around the hand's center.
_HAND_LANDMARK_OUTPUTS = (
    ModelOutput("landmarks", "Identity"),
    ModelOutput("presence", "Identity_1"),
    ModelOutput("handedness", "Identity_2"),
    ModelOutput("world_landmarks", "Identity_3"),
)

# 39 x (x, y, z in pixels of the input, visibility logit, presence logit); probability that a
# person is there; 39 x (x, y, z) in meters around the hips. Two outputs are left out with what
# only they need: the segmentation mask (Identity_2, two thirds of the whole model's time) and the
# heat maps (Identity_3, a tenth of the rest).
_POSE_LANDMARK_OUTPUTS = (
    ModelOutput("landmarks", "Identity"),
    ModelOutput("presence", "Identity_1"),
    ModelOutput("world_landmarks", "Identity_4"),
)

_FLOAT_MODELS = (
    ModelEntry(
        "palm_detection_lite",
        "mediapipe/modules/palm_detection/palm_detection_lite.tflite",
        "e9a4aaddf90dda56a87235303cf00e4c2d3fb28725f68fd88772997dac905c18",
        192,
        (0.0, 1.0),
        _DETECTOR_OUTPUTS,
        size_is_free=True,
    ),
    ModelEntry(
        "palm_detection_full",
        "mediapipe/modules/palm_detection/palm_detection_full.tflite",
        "1b14e9422c6ad006cde6581a46c8b90dd573c07ab7f3934b5589e7cea3f89a54",
        192,
        (0.0, 1.0),
        _DETECTOR_OUTPUTS,
        size_is_free=True,
    ),
    ModelEntry(
        "hand_landmark_lite",
        "mediapipe/modules/hand_landmark/hand_landmark_lite.tflite",
        "048edd3645c9bf7397d19a9f6e3a42957d6e414c9bea6598030a2e9b624156e6",
        224,
        (0.0, 1.0),
        _HAND_LANDMARK_OUTPUTS,
    ),
    ModelEntry(
        "hand_landmark_full",
        "mediapipe/modules/hand_landmark/hand_landmark_full.tflite",
        "11c272b891e1a99ab034208e23937a8008388cf11ed2a9d776ed3d01d0ba00e3",
        224,
        (0.0, 1.0),
        _HAND_LANDMARK_OUTPUTS,
    ),
    ModelEntry(
        "pose_detection",
        "mediapipe/modules/pose_detection/pose_detection.tflite",
        "9ba9dd3d42efaaba86b4ff0122b06f29c4122e756b329d89dca1e297fd8f866c",
        224,
        (-1.0, 1.0),
        _DETECTOR_OUTPUTS,
    ),
    ModelEntry(
        "pose_landmark_full",
        "mediapipe/modules/pose_landmark/pose_landmark_full.tflite",
        "e9a5c5cb17f736fafd4c2ec1da3b3d331d6edbe8a0d32395855aeb2cdfd64b9f",
        256,
        (0.0, 1.0),
        _POSE_LANDMARK_OUTPUTS,
    ),
)

#: Those whose blocks compute in 8 bits as well. The palm models are not among them, since their
#: activations (PReLU) have no kernel in 8 bits, nor the pose landmarks: of real people one in
#: twenty moved by 3 % of half the region, by 2 % still with half of the blocks in 8 bits.
INT8_MODELS = ("hand_landmark_lite", "hand_landmark_full", "pose_detection")
INT8_SUFFIX = "_int8"

MODELS = _FLOAT_MODELS + tuple(
    replace(entry, name=entry.name + INT8_SUFFIX, in_bytes=True)
    for entry in _FLOAT_MODELS
    if entry.name in INT8_MODELS
)


def find_model(name: str) -> ModelEntry:
    """The catalog's entry of a name.

    Raises:
        ModelFileError: There is no such model; the message lists those there are.
    """
    for entry in MODELS:
        if entry.name == name:
            return entry
    known = ", ".join(entry.name for entry in MODELS)
    raise ModelFileError(f"There is no model '{name}'; choose one of {known}.")
