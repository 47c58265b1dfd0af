"""Small ONNX files with the inputs of real pose models, whose answers are always the same."""

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper, numpy_helper

from tracker.config import Config
from tracker.errors import ModelFileError
from tracker.perception.bodies.pose_file import PoseFile, fit


@pytest.fixture
def write(tmp_path):
    """Writes a file that answers the same to any picture; returns its path."""

    def write(shape, answers, *, dtype=TensorProto.FLOAT, name="pose.onnx"):
        nodes = [
            helper.make_node("Constant", [], [key], value=numpy_helper.from_array(value, key))
            for key, value in answers.items()
        ]
        outputs = [
            helper.make_tensor_value_info(key, TensorProto.FLOAT, value.shape)
            for key, value in answers.items()
        ]
        picture = helper.make_tensor_value_info("picture", dtype, shape)
        graph = helper.make_graph(nodes, "pose", [picture], outputs)
        model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)])
        model.ir_version = 8
        onnx.save(model, tmp_path / name)
        return tmp_path / name

    return write


#: Where the person of each file stands in a picture of 640 by 480, and the input's scale.
STANDS_AT = np.array([320.0, 240.0])


def joints(points_px):
    points = np.tile(points_px, (17, 1)).astype(np.float32)
    points[:, 0] += np.arange(17)  # so that a body has an extent
    return np.concatenate([points, np.full((17, 1), 0.9, np.float32)], axis=1)


def rtmo(write):
    boxes = np.array([[[0, 0, 1, 1, 0.9], [0, 0, 1, 1, 0.1]]], np.float32)
    keypoints = np.stack([joints(STANDS_AT), joints((9, 9))])[None]
    return write((1, 3, 640, 640), {"dets": boxes, "keypoints": keypoints})


def yolo(write):
    rows = np.zeros((56, 100), np.float32)
    rows[:5, 7] = [320, 240, 100, 200, 0.9]
    rows[5:, 7] = joints(STANDS_AT).ravel()
    return write((1, 3, 640, 640), {"output0": rows[None]})


def movenet(write, dtype=TensorProto.INT32):
    rows = np.zeros((1, 6, 56), np.float32)
    rows[0, 0, :51] = (joints(STANDS_AT)[:, [1, 0, 2]] / [640, 640, 1]).ravel()
    rows[0, 0, 55] = 0.9
    return write((1, 256, 256, 3), {"output_0": rows}, dtype=dtype)


def movenet_of_bytes(write):
    return movenet(write, TensorProto.UINT8)


def open_file(path, **parameters):
    return PoseFile.open(Config().replace(pose_model=str(path), **parameters))


def people(model, width=640, height=480, *, window=0):
    """Whom a model sees in one of its windows."""
    bgr = np.zeros((height, width, 3), np.uint8)
    return model.around(bgr, model.windows(width, height)[window])


@pytest.mark.parametrize("make", [rtmo, yolo, movenet, movenet_of_bytes])
def test_a_model_of_the_whole_picture_gives_bodies_in_its_pixels(write, make):
    bodies = people(open_file(make(write)))
    assert len(bodies) == 1
    np.testing.assert_allclose(bodies.points_px[0], joints(STANDS_AT)[:, :2], atol=1e-3)
    np.testing.assert_allclose(bodies.score, 0.9)
    assert bodies.age_s.tolist() == [0.0]


def test_a_larger_picture_is_shrunk_and_its_bodies_enlarged(write):
    bodies = people(open_file(rtmo(write)), width=1280, height=960)
    np.testing.assert_allclose(bodies.points_px[0], 2 * joints(STANDS_AT)[:, :2], atol=1e-3)


def test_a_model_for_one_person_looks_at_strip_after_strip(write):
    x, y = np.zeros((1, 17, 384), np.float32), np.zeros((1, 17, 512), np.float32)
    x[0, np.arange(17), 100 + np.arange(17)], y[0, :, 256] = 0.9, 0.9
    path = write((1, 3, 256, 192), {"simcc_x": x, "simcc_y": y})
    model = open_file(path)
    # A strip of 240 by 480 is 256 pixels high there: x = 50 of 192 is 93.75 of the strip.
    for number, left in enumerate((0, 100, 200)):
        (points,) = people(model, window=number).points_px
        np.testing.assert_allclose(points[0], [left + 93.75, 240], atol=1e-3)


def test_an_unsure_person_is_nobody(write):
    assert len(people(open_file(rtmo(write), pose_confidence=0.95))) == 0


def test_points_that_are_no_numbers_are_not_seen(write):
    boxes = np.array([[[0, 0, 1, 1, 0.9]]], np.float32)
    keypoints = joints(STANDS_AT)[None, None].copy()
    keypoints[0, 0, 3, 0] = np.inf
    path = write((1, 3, 640, 640), {"dets": boxes, "keypoints": keypoints})
    bodies = people(open_file(path))
    assert np.flatnonzero(~bodies.is_visible[0]).tolist() == [3]


def test_a_file_of_another_layout_is_refused(write):
    path = write((1, 3, 8, 8), {"classes": np.zeros((1, 1000), np.float32)})
    with pytest.raises(ModelFileError, match=r"pose\.onnx has inputs picture \[1, 3, 8, 8\]"):
        open_file(path)


def test_a_file_with_an_unusual_input_is_refused(write):
    path = write((1, 56, 56, 3), {"out": np.zeros((1, 6, 56), np.float32)}, dtype=TensorProto.BOOL)
    with pytest.raises(ModelFileError, match=r"needs tensor\(bool\)"):
        open_file(path)


def test_a_model_that_does_not_answer_as_its_layout_promises_is_named(write):
    boxes = np.zeros((1, 2, 5), np.float32)
    path = write((1, 3, 640, 640), {"dets": boxes, "keypoints": np.zeros((1, 3, 17, 3), "f4")})
    with pytest.raises(ModelFileError, match=r"looks like RTMO but its output is different"):
        people(open_file(path))


@pytest.mark.parametrize("content", [None, b"text"], ids=["absent", "text"])
def test_a_file_that_is_no_model_is_named_with_the_parameter(tmp_path, content):
    path = tmp_path / "mine.onnx"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ModelFileError, match=r"mine\.onnx.*`pose_model`"):
        open_file(path)


def test_a_picture_is_fitted_into_the_corner_and_the_rest_filled():
    white = np.full((100, 200, 3), 255, np.uint8)
    fitted, per_px = fit(white, (64, 64), 114)
    assert per_px == 0.32
    assert fitted.shape == (64, 64, 3)
    assert (fitted[:32] == 255).all()
    assert (fitted[32:] == 114).all()
