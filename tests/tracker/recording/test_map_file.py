import cv2
import numpy as np
import pytest

from tracker.errors import ConfigError
from tracker.recording import load_map

PLAIN = """image: room.pgm
resolution: 0.05
origin: [-1.0, 2.0, 0.5]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


@pytest.fixture
def write_map(tmp_path):
    """Writes a map of these pixels and this YAML text."""

    def write(pixels, text=PLAIN, name="room.pgm"):
        assert cv2.imwrite(str(tmp_path / name), np.array(pixels))
        (tmp_path / "map.yaml").write_text(text)
        return tmp_path / "map.yaml"

    return write


def gray(*rows):
    return np.array(rows, np.uint8)


def test_a_map_of_map_server_is_read_from_the_bottom_up(write_map):
    grid = load_map(write_map(gray([0, 205, 254], [254, 254, 0])))
    assert (grid.frame_id, grid.resolution_m, grid.origin) == ("map", 0.05, (-1.0, 2.0, 0.5))
    assert grid.cells.tolist() == [[0, 0, 100], [100, -1, 0]]


def test_negate_takes_what_is_bright_for_occupied(write_map):
    grid = load_map(write_map(gray([0, 254]), PLAIN.replace("negate: 0", "negate: 1")))
    assert grid.cells.tolist() == [[0, 100]]


def test_scale_keeps_what_lies_between_the_thresholds(write_map):
    shades = gray([0, 255, round(255 * (1 - 0.423))])
    grid = load_map(write_map(shades, PLAIN + "mode: scale\n"))
    assert grid.cells.tolist() == [[100, 0, 50]]


def test_scale_takes_what_is_transparent_for_unknown(write_map):
    pixels = np.zeros((1, 2, 4), np.uint8)
    pixels[0, 1, 3] = 255
    text = PLAIN.replace("room.pgm", "room.png") + "mode: scale\n"
    assert load_map(write_map(pixels, text, "room.png")).cells.tolist() == [[-1, 100]]


def test_trinary_averages_the_opacity_in_as_map_server_does(write_map):
    pixels = np.full((1, 2, 4), 255, np.uint8)
    pixels[0, 1, 3] = 0  # a quarter darker: between the thresholds
    text = PLAIN.replace("room.pgm", "room.png")
    assert load_map(write_map(pixels, text, "room.png")).cells.tolist() == [[0, -1]]


def test_raw_takes_the_numbers_as_they_are(write_map):
    grid = load_map(write_map(gray([0, 37, 100, 101, 255]), PLAIN + "mode: raw\n"))
    assert grid.cells.tolist() == [[0, 37, 100, -1, -1]]


def test_pictures_of_16_bits_and_colors_are_read_by_their_brightness(write_map):
    text = PLAIN.replace("room.pgm", "room.png")
    deep = np.array([[0, 65535]], np.uint16)
    assert load_map(write_map(deep, text, "room.png")).cells.tolist() == [[100, 0]]
    colors = np.array([[[0, 0, 0], [255, 255, 255], [255, 0, 0]]], np.uint8)
    assert load_map(write_map(colors, text, "room.png")).cells.tolist() == [[100, 0, 100]]


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("resolution: 0.05", "", ["`resolution` is missing"]),
        ("resolution: 0.05", "resolution: 0", ["`resolution` is 0", "greater than 0"]),
        ("[-1.0, 2.0, 0.5]", "[-1.0, 2.0]", ["origin.2", "missing"]),
        ("[-1.0, 2.0, 0.5]", "[.nan, 2.0, 0.0]", ["origin.0", "finite"]),
        ("0.196", "0.7", ["free_thresh is 0.7", "below occupied_thresh, which is 0.65"]),
        ("negate: 0", "mode: gray", ["`mode` is 'gray'", "'trinary', 'scale' or 'raw'"]),
        ("room.pgm", "hall.pgm", ["hall.pgm", "cannot be read"]),
        ("room.pgm", "map.yaml", ["map.yaml", "not a picture", "PGM, PNG or BMP"]),
        (PLAIN, "- 1\n", ["contains no map", "`resolution:`"]),
    ],
    ids=lambda value: value if isinstance(value, str) and len(value) < 20 else None,
)
def test_what_is_wrong_with_a_map_is_named(write_map, before, after, words):
    path = write_map(gray([0, 254]), PLAIN.replace(before, after))
    with pytest.raises(ConfigError) as caught:
        load_map(path)
    assert all(word in str(caught.value) for word in words), str(caught.value)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ConfigError, match=r"nowhere\.yaml"):
        load_map(tmp_path / "nowhere.yaml")
