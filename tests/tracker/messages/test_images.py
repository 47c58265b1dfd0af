from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from rosbags.image import message_to_cvimage
from rosbags.typesys import Stores, get_typestore

from tracker.errors import RecordingError
from tracker.messages.encodings import ENCODINGS
from tracker.messages.images import picture_from_compressed, picture_from_image

_CHANNELS = {
    "bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4, "mono8": 1, "8UC1": 1, "8UC3": 3,
    "yuv422": 2, "yuv422_yuy2": 2,
    "bayer_rggb8": 1, "bayer_bggr8": 1, "bayer_gbrg8": 1, "bayer_grbg8": 1,
}  # fmt: skip


def image(encoding, height, width, data, step=None, is_bigendian=0):
    step = len(data) // max(height, 1) if step is None else step
    return SimpleNamespace(
        encoding=encoding, height=height, width=width, data=data, step=step,
        is_bigendian=is_bigendian,
    )  # fmt: skip


def bgr_from_image(message):
    return picture_from_image(message).bgr


def random_pixels(encoding, height=6, width=8):
    rng = np.random.default_rng(4)
    return rng.integers(0, 256, (height, width * _CHANNELS[encoding]), dtype=np.uint8)


@pytest.mark.parametrize("encoding", [name for name in _CHANNELS if not name.startswith("8U")])
def test_tightly_packed_images_decode_as_rosbags_image_does(encoding):
    pixels = random_pixels(encoding)
    store = get_typestore(Stores.ROS2_JAZZY)
    stamp = store.types["builtin_interfaces/msg/Time"](sec=1, nanosec=2)
    message = store.types["sensor_msgs/msg/Image"](
        header=store.types["std_msgs/msg/Header"](stamp=stamp, frame_id="camera"),
        height=6, width=8, encoding=encoding, is_bigendian=0, step=pixels.shape[1],
        data=pixels.reshape(-1),
    )  # fmt: skip

    expected = message_to_cvimage(message, "bgr8")

    np.testing.assert_array_equal(bgr_from_image(message), expected)


@pytest.mark.parametrize("encoding", list(_CHANNELS))
def test_padding_at_the_end_of_rows_changes_nothing(encoding):
    pixels = random_pixels(encoding)
    padded = np.pad(pixels, ((0, 0), (0, 5)), constant_values=99)

    tight = bgr_from_image(image(encoding, 6, 8, pixels.reshape(-1)))
    loose = bgr_from_image(image(encoding, 6, 8, padded.reshape(-1)))
    short = bgr_from_image(image(encoding, 6, 8, padded.reshape(-1)[:-5], step=padded.shape[1]))

    np.testing.assert_array_equal(loose, tight)
    np.testing.assert_array_equal(short, tight)


def test_pure_colors_come_out_as_themselves():
    def first_pixel(encoding, *values):
        data = bytes(values)
        width = len(data) // _CHANNELS[encoding]
        return bgr_from_image(image(encoding, 1, width, data))[0, 0].tolist()

    assert first_pixel("bgr8", 1, 2, 3) == [1, 2, 3]
    assert first_pixel("rgb8", 1, 2, 3) == [3, 2, 1]
    assert first_pixel("bgra8", 1, 2, 3, 99) == [1, 2, 3]
    assert first_pixel("rgba8", 1, 2, 3, 99) == [3, 2, 1]
    assert first_pixel("mono8", 7) == [7, 7, 7]
    # Y = 81, U = 90, V = 240 is red in BT.601; the order is U Y V Y here and Y U Y V there.
    np.testing.assert_allclose(first_pixel("yuv422", 90, 81, 240, 81), [0, 0, 255], atol=2)
    np.testing.assert_allclose(first_pixel("yuv422_yuy2", 81, 90, 81, 240), [0, 0, 255], atol=2)


def test_a_red_scene_through_a_bayer_pattern_is_red():
    pattern = np.zeros((8, 8), dtype=np.uint8)
    pattern[::2, ::2] = 200  # rggb: red at even rows and columns
    middle = picture_from_image(image("bayer_rggb8", 8, 8, pattern.reshape(-1))).bgr[3:5, 3:5]
    assert middle[..., 2].min() == 200
    assert middle[..., :2].max() == 0


@pytest.mark.parametrize("is_bigendian", [0, 1])
def test_mono16_keeps_the_more_significant_byte(is_bigendian):
    values = np.array([[0x1234, 0xABCD]], dtype=">u2" if is_bigendian else "<u2")
    gray = bgr_from_image(image("mono16", 1, 2, values.tobytes(), is_bigendian=is_bigendian))
    assert gray[0, :, 0].tolist() == [0x12, 0xAB]


def test_a_bgr_image_is_not_copied():
    pixels = random_pixels("bgr8")
    assert np.shares_memory(bgr_from_image(image("bgr8", 6, 8, pixels.reshape(-1))), pixels)


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (image("bgr8", 0, 0, b""), "0x0"),
        (image("bgr8", 2, 0, b"", step=0), "0x2"),
        (image("bgr8", 2, 2, b"123456789", step=6), "expected 12"),
        (image("bgr8", 2, 2, bytes(13), step=6), "brings 13 bytes"),
        (image("bgr8", 2, 2, bytes(10), step=5), "at least 6"),
        (image("bgr8", 2**32 - 1, 2**32 - 1, bytes(10), step=2**32 - 1), "4294967295"),
        (image("bgr8", 2**25, 1, bytes(10), step=3), "expected 100663296"),
        (image("nv12", 2, 2, bytes(5), step=2), "expected 6"),
        (image("i420", 0, 2, b"", step=2), "0"),
        (image("jpeg2000", 2, 2, bytes(12)), "jpeg2000"),
        (image("", 2, 2, bytes(12)), "supported are bgr8"),
        (image("32FC1", 1, 1, bytes(4)), "32FC1"),
        (image("yuv422", 1, 3, bytes(6)), "3x1"),
    ],
    ids=[
        "no pixels", "no columns", "too few bytes", "too many bytes", "short step", "huge",
        "many rows", "too little color", "no rows of planes", "unknown", "unnamed", "depth",
        "odd width",
    ],
)  # fmt: skip
def test_images_that_cannot_be_are_refused_with_their_sizes(message, words):
    with pytest.raises(RecordingError, match=words):
        bgr_from_image(message)


@pytest.mark.parametrize("suffix", [".jpg", ".png"])
def test_compressed_images_decode_in_color_and_gray(suffix):
    color = np.full((20, 30, 3), (10, 100, 200), dtype=np.uint8)
    gray = np.full((20, 30), 77, dtype=np.uint8)
    for picture, expected in ((color, (10, 100, 200)), (gray, (77, 77, 77))):
        data = cv2.imencode(suffix, picture)[1].tobytes()
        decoded = picture_from_compressed(SimpleNamespace(format=suffix, data=data)).bgr
        assert decoded.shape == (20, 30, 3)
        np.testing.assert_allclose(decoded[10, 10], expected, atol=3)


@pytest.mark.parametrize("data", [b"", b"\xff\xd8 no picture", bytes(100)])
def test_broken_compressed_images_are_refused(data):
    with pytest.raises(RecordingError, match="'jpeg'"):
        picture_from_compressed(SimpleNamespace(format="jpeg", data=data))


# ---- every other encoding, against its definition

HEIGHT, WIDTH = 12, 20


def yuv_picture(seed=3):
    """Brightness, u and v of blocks of 2x2 pixels, and the picture OpenCV makes of them."""
    rng = np.random.default_rng(seed)
    light = rng.integers(16, 236, (HEIGHT, WIDTH), dtype=np.uint8)
    u, v = rng.integers(40, 216, (2, HEIGHT // 2, WIDTH // 2), dtype=np.uint8)
    packed = np.concatenate([light.ravel(), u.ravel(), v.ravel()])
    bgr = cv2.cvtColor(packed.reshape(-1, WIDTH), cv2.COLOR_YUV2BGR_I420)
    return light, u, v, bgr


def wide(plane, down, across):
    return plane.repeat(down, 0).repeat(across, 1)


def in_turn(*planes):
    return np.stack(planes, -1).reshape(len(planes[0]), -1)


def planes_of(encoding):
    """The planes that an encoding is made of, as (rows, bytes), in order."""
    light, u, v, _ = yuv_picture()
    u422, v422 = wide(u, 2, 1), wide(v, 2, 1)
    u444, v444 = wide(u, 2, 2), wide(v, 2, 2)
    return {
        "nv12": [light, in_turn(u, v)],
        "nv21": [light, in_turn(v, u)],
        "nv16": [light, in_turn(u422, v422)],
        "nv61": [light, in_turn(v422, u422)],
        "nv24": [light, in_turn(u444, v444)],
        "nv42": [light, in_turn(v444, u444)],
        "i420": [light, u, v],
        "yuv420p": [light, u, v],
        "yv12": [light, v, u],
        "yuv422p": [light, u422, v422],
        "yuv444p": [light, u444, v444],
        "uyvy": [in_turn(u422, light[:, ::2], v422, light[:, 1::2])],
        "vyuy": [in_turn(v422, light[:, ::2], u422, light[:, 1::2])],
        "yuy2": [in_turn(light[:, ::2], u422, light[:, 1::2], v422)],
        "yvyu": [in_turn(light[:, ::2], v422, light[:, 1::2], u422)],
    }[encoding]


YUV = ["nv12", "nv21", "nv16", "nv61", "nv24", "nv42", "i420", "yuv420p", "yv12", "yuv422p",
       "yuv444p", "uyvy", "vyuy", "yuy2", "yvyu"]  # fmt: skip


@pytest.mark.parametrize("encoding", YUV)
def test_every_order_of_brightness_and_color_gives_the_same_picture(encoding):
    planes = planes_of(encoding)
    data = np.concatenate([plane.ravel() for plane in planes])
    message = image(encoding, HEIGHT, WIDTH, data, step=planes[0].shape[1])
    np.testing.assert_allclose(bgr_from_image(message), yuv_picture()[3], atol=1)


@pytest.mark.parametrize("encoding", YUV)
def test_padding_of_planes_changes_nothing(encoding):
    planes = planes_of(encoding)
    step = planes[0].shape[1] + 12
    padded = [
        np.pad(
            plane,
            ((0, 0), (0, 12 * plane.shape[1] // planes[0].shape[1])),
            constant_values=99,
        )
        for plane in planes
    ]
    data = np.concatenate([plane.ravel() for plane in padded])
    for sent in (data, data[: -(padded[-1].shape[1] - planes[-1].shape[1]) or None]):
        message = image(encoding, HEIGHT, WIDTH, sent, step=step)
        np.testing.assert_allclose(bgr_from_image(message), yuv_picture()[3], atol=1)


@pytest.mark.parametrize("step", [0, WIDTH * 3 // 2, WIDTH * 2])
def test_a_step_that_counts_the_colors_too_is_seen_through(step):
    data = np.concatenate([plane.ravel() for plane in planes_of("nv12")])
    message = image("nv12", HEIGHT, WIDTH, data, step=step)
    np.testing.assert_allclose(bgr_from_image(message), yuv_picture()[3], atol=1)


def test_pictures_of_an_odd_size_have_colors_to_the_edge():
    light = np.full((5, 7), 81, np.uint8)
    u, v = np.full((3, 4), 90, np.uint8), np.full((3, 4), 240, np.uint8)
    data = np.concatenate([light.ravel(), in_turn(u, v).ravel()])
    found = bgr_from_image(image("nv12", 5, 7, data, step=7))
    assert found.shape == (5, 7, 3)
    np.testing.assert_allclose(found.reshape(-1, 3), [[0, 0, 255]] * 35, atol=2)


@pytest.mark.parametrize("encoding", ["RGB8", "Mono8", "NV12", "BAYER_RGGB8", "YUYV", "8uc3"])
def test_names_in_any_case_are_known(encoding):
    size = 16 * 16 * 3
    known = image(encoding.lower(), 16, 16, bytes(size), step=0)
    step = {"rgb8": 48, "8uc3": 48, "yuyv": 32}.get(encoding.lower(), 16)
    rows = 24 if encoding == "NV12" else 16
    known.data = bytes(range(256)) * 3
    known.data = known.data[: step * rows]
    other = SimpleNamespace(**{**vars(known), "encoding": encoding})
    np.testing.assert_array_equal(bgr_from_image(other), bgr_from_image(known))


@pytest.mark.parametrize("bits", [10, 12, 14, 16])
@pytest.mark.parametrize("is_bigendian", [0, 1])
@pytest.mark.parametrize(
    "encoding", ["mono16", "16UC1", "rgb16", "bgr16", "rgba16", "bgra16", "16UC3", "16UC4"]
)
def test_numbers_of_any_depth_show_what_eight_bits_show(encoding, is_bigendian, bits):
    name = encoding.lower().replace("16uc", "8uc").replace("16", "8")
    channels = ENCODINGS[name].channels
    small = np.random.default_rng(bits).integers(0, 256, (6, 8 * channels), dtype=np.uint8)
    small[0, 0] = 255
    large = (small.astype(np.uint16) << (bits - 8)).astype(">u2" if is_bigendian else "<u2")
    found = picture_from_image(image(encoding, 6, 8, large.tobytes(), is_bigendian=is_bigendian))
    np.testing.assert_array_equal(found.bgr, bgr_from_image(image(name, 6, 8, small.ravel())))
    assert (f"taken for one of {bits} bits" in found.remark) is (bits < 16)


@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
@pytest.mark.parametrize("bits", [12, 16])
def test_mosaics_of_16_bits_are_those_of_8(pattern, bits):
    small = np.random.default_rng(1).integers(0, 256, (8, 10), dtype=np.uint8)
    small[3, 3] = 255
    large = small.astype("<u2") << (bits - 8)
    found = bgr_from_image(image(f"bayer_{pattern}16", 8, 10, large.tobytes()))
    expected = bgr_from_image(image(f"bayer_{pattern}8", 8, 10, small.ravel()))
    np.testing.assert_array_equal(found, expected)


def test_a_depth_that_is_named_is_no_guess():
    values = np.full((4, 6), 512, "<u2")
    found = picture_from_image(image("mono12", 4, 6, values.tobytes()))
    assert (found.bgr.max(), found.remark) == (32, "")


def test_opacity_tells_nothing_about_the_depth():
    values = np.full((2, 2, 4), 1000, "<u2")
    values[..., 3] = 65535
    found = picture_from_image(image("rgba16", 2, 2, values.tobytes()))
    assert found.bgr.max() == 250
    assert "10 bits" in found.remark


def test_a_jpeg_in_an_image_message_is_read():
    data = cv2.imencode(".jpg", np.full((20, 30, 3), 130, np.uint8))[1].tobytes()
    found = bgr_from_image(image("jpeg", 20, 30, data, step=30))
    assert (found.shape, int(found.mean())) == ((20, 30, 3), 130)


def test_a_png_of_16_bits_is_as_bright_as_its_sensor_saw():
    values = np.full((20, 30), 2000, np.uint16)
    values[0, 0] = 4095
    message = SimpleNamespace(
        format="mono16; png compressed", data=cv2.imencode(".png", values)[1].tobytes()
    )
    found = picture_from_compressed(message)
    assert found.bgr[10, 10].tolist() == [125, 125, 125]
    assert "12 bits" in found.remark


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("16UC1; compressedDepth png", "depth image"),
        ("32FC1; compressedDepth rvl", "depth image"),
        ("h264", "video stream"),
        ("theora", "video stream"),
    ],
)
def test_compressed_messages_that_are_no_pictures_are_refused_by_name(name, words):
    with pytest.raises(RecordingError, match=words) as caught:
        picture_from_compressed(SimpleNamespace(format=name, data=b"123"))
    assert name in str(caught.value)


def test_a_raw_image_beyond_the_limit_is_refused():
    message = image("mono8", 10, 10, bytes(100))
    assert picture_from_image(message, max_pixels=100).bgr.shape == (10, 10, 3)
    with pytest.raises(RecordingError, match=r"10x10 pixels; at most 99 .*picture_max_pixels"):
        picture_from_image(message, max_pixels=99)
