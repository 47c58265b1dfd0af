import numpy as np
import pytest

from tracker.errors import ModelFileError
from tracker.perception.bodies.pose_layouts import MOVENET, RTMO, RTMPOSE, YOLO, recognize

PICTURE = {"input": (1, 3, 640, 640)}


@pytest.mark.parametrize(
    ("layout", "inputs", "outputs"),
    [
        (RTMO, PICTURE, {"dets": (1, 20, 5), "keypoints": (1, 20, 17, 3)}),
        (RTMO, {"x": (-1, 3, 640, 640)}, {"keypoints": (-1, -1, 17, 3), "dets": (-1, -1, 5)}),
        (RTMPOSE, {"x": (1, 3, 256, 192)}, {"simcc_x": (1, 17, 384), "simcc_y": (1, 17, 512)}),
        (RTMPOSE, {"x": (-1, 3, 256, 192)}, {"simcc_x": (-1, 17, 384), "simcc_y": (-1, -1, -1)}),
        (MOVENET, {"input": (1, 256, 256, 3)}, {"output_0": (1, 6, 56)}),
        (MOVENET, {"input": (1, -1, -1, 3)}, {"output_0": (1, 6, 56)}),
        (YOLO, PICTURE, {"output0": (1, 56, 8400)}),
        (YOLO, {"images": (-1, 3, -1, -1)}, {"output0": (-1, 56, -1)}),
    ],
)
def test_a_layout_is_recognized_by_inputs_and_outputs(layout, inputs, outputs):
    assert recognize("model.onnx", inputs, outputs) is layout


@pytest.mark.parametrize(
    ("inputs", "outputs"),
    [
        (PICTURE, {"boxes": (1, 8400, 85)}),
        (PICTURE, {"output0": (1, 56, 8400), "masks": (1, 32, 160, 160)}),
        (PICTURE, {"dets": (1, 20, 5), "keypoints": (1, 20, 133, 3)}),
        (PICTURE, {"output_0": (1, 6, 56)}),  # MoveNet's picture has its channels last
        ({"a": (1, 3, 640, 640), "b": (1, 2)}, {"output0": (1, 56, 8400)}),
        (PICTURE, {}),
    ],
    ids=["detector", "two outputs", "whole body", "channels", "two inputs", "nothing"],
)
def test_another_layout_is_refused_with_what_was_found_and_what_is_understood(inputs, outputs):
    with pytest.raises(ModelFileError) as caught:
        recognize("model.onnx", inputs, outputs)
    message = str(caught.value)
    assert "\n" not in message
    for name, shape in {**inputs, **outputs}.items():
        assert f"{name} {list(shape)}" in message
    for family in ("RTMO", "RTMPose", "MoveNet MultiPose", "YOLO-pose"):
        assert family in message


def joints_at(x, y, visibility=0.9):
    return np.stack([np.full(17, x), np.full(17, y), np.full(17, visibility)], axis=-1)


def test_rtmo_gives_boxes_with_scores_and_joints_in_pixels():
    outputs = {
        "keypoints": np.stack([joints_at(10, 20), joints_at(30, 40)])[None],
        "dets": np.array([[[0, 0, 9, 9, 0.8], [0, 0, 9, 9, 0.2]]], np.float32),
    }
    bodies = RTMO.decode(outputs, (640, 640))
    np.testing.assert_allclose(bodies.points_px[:, 5], [[10, 20], [30, 40]])
    np.testing.assert_allclose(bodies.score, [0.8, 0.2])
    np.testing.assert_allclose(bodies.visibility, 0.9)


def test_rtmpose_gives_a_curve_for_columns_and_rows():
    x, y = np.zeros((1, 17, 384), np.float32), np.zeros((1, 17, 512), np.float32)
    x[0, :, 100], y[0, :, 300] = 0.9, 0.7
    bodies = RTMPOSE.decode({"simcc_x": x, "simcc_y": y}, (192, 256))
    np.testing.assert_allclose(bodies.points_px[0, 3], [50, 150])  # two bins a pixel
    np.testing.assert_allclose(bodies.visibility, 0.7)
    np.testing.assert_allclose(bodies.score, [0.7])


def test_movenet_gives_shares_of_the_input_rows_first():
    rows = np.zeros((1, 6, 56), np.float32)
    rows[0, 0, :51] = joints_at(0.25, 0.5)[:, [0, 1, 2]].ravel()
    rows[0, 0, 55] = 0.6
    bodies = MOVENET.decode({"output_0": rows}, (256, 192))
    np.testing.assert_allclose(bodies.points_px[0, 0], [0.5 * 256, 0.25 * 192])
    np.testing.assert_allclose(bodies.score, [0.6, 0, 0, 0, 0, 0], atol=1e-6)


def test_yolo_gives_columns_whose_overlaps_are_one_person():
    rows = np.zeros((4, 56), np.float32)
    for row, (x, score) in zip(rows, [(100, 0.5), (102, 0.9), (400, 0.7), (0, 0.0)], strict=True):
        row[:5] = x, 200, 80, 160, score
        row[5:] = joints_at(x, 200).ravel()
    bodies = YOLO.decode({"output0": rows.T[None]}, (640, 640))
    np.testing.assert_allclose(bodies.score[:2], [0.9, 0.7])
    np.testing.assert_allclose(bodies.points_px[:2, 0, 0], [102, 400])
    assert (bodies.score[2:] == 0.0).all()


def test_pictures_are_packed_as_each_family_was_trained():
    blue = np.zeros((4, 6, 3), np.uint8)
    blue[..., 0] = 255
    rtmo = RTMO.pack(blue, np.float32)
    assert rtmo.shape == (1, 3, 4, 6)
    assert rtmo[0, :, 0, 0].tolist() == [255, 0, 0]
    yolo = YOLO.pack(blue, np.float32)
    assert yolo[0, :, 0, 0].tolist() == [0, 0, 1]
    movenet = MOVENET.pack(blue, np.int32)
    assert movenet.shape == (1, 4, 6, 3)
    assert movenet.dtype == np.int32
    assert movenet[0, 0, 0].tolist() == [0, 0, 255]
    rtmpose = RTMPOSE.pack(blue, np.float32)
    np.testing.assert_allclose(
        rtmpose[0, :, 0, 0], [-123.675 / 58.395, -116.28 / 57.12, (255 - 103.53) / 57.375]
    )


def test_free_dimensions_take_the_usual_size():
    assert YOLO.input_size((1, 3, -1, -1)) == (640, 640)
    assert RTMPOSE.input_size((-1, 3, 256, 192)) == (192, 256)
    assert MOVENET.input_size((1, 192, -1, 3)) == (256, 192)
