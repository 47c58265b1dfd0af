import numpy as np
import pytest

from tracker.errors import RecordingError
from tracker.evaluation.detection.photo_labels import read_labels, read_photos


@pytest.fixture
def labels(tmp_path):
    """Writes labels beside two photos and reads them."""

    def write(text):
        for name in ("a.jpg", "b.jpg"):
            (tmp_path / name).touch()
        (tmp_path / "labels.csv").write_text(text, encoding="utf-8")
        return read_labels(tmp_path)

    return write


def test_rows_of_one_photo_are_its_raised_hands(labels):
    one, other = labels("file,raised,x,y\na.jpg,1,10,20\nb.jpg,0\na.jpg,yes,,\n")
    assert (one.path.name, other.path.name) == ("a.jpg", "b.jpg")
    np.testing.assert_array_equal(one.wrists_px, [(10.0, 20.0), (np.nan, np.nan)])
    assert other.wrists_px.shape == (0, 2)


def test_places_may_be_left_out_and_a_byte_order_mark_does_no_harm(labels):
    (photo,) = labels("\ufefffile, raised\na.jpg, 1\n")
    assert np.isnan(photo.wrists_px).all()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("file,raised\n", "contains no labels"),
        ("name,up\na.jpg,1\n", r"line 1: the columns are name, up; expected file,raised"),
        ("", "line 1: the columns are none"),
        ("file,raised\na.jpg,1\nc.jpg,1\n", r"line 3: there is no photo 'c\.jpg'"),
        ("file,raised\n,1\n", "line 2: there is no photo ''"),
        ("file,raised\na.jpg,maybe\n", "line 2: raised is 'maybe'; expected 1 or 0"),
        ("file,raised\na.jpg\n", "line 2: raised is ''"),
        ("file,raised,x,y\na.jpg,1,7,\n", "line 2: x, y are '7', ''"),
        ("file,raised,x,y\na.jpg,1,-3,4\n", "line 2: x, y are -3, 4"),
        ("file,raised,x,y\na.jpg,1,nan,4\n", "line 2: x, y are nan, 4"),
        ("file,raised\na.jpg,1,5\n", "line 2: more values than the columns"),
        ("file,raised\na.jpg,0\nb.jpg,0\na.jpg,1\n", r"line 4: a\.jpg has raised hands"),
        ("file,raised\na.jpg,1\na.jpg,0\n", r"line 3: a\.jpg has raised hands"),
    ],
)
def test_what_is_off_is_named_with_its_line(labels, text, words):
    with pytest.raises(RecordingError, match=words):
        labels(text)


def test_a_folder_without_labels_says_how_to_write_them(tmp_path):
    with pytest.raises(RecordingError, match=r"labels\.csv: does not exist; write one with"):
        read_labels(tmp_path)


def test_labels_that_are_no_text_are_refused(tmp_path):
    (tmp_path / "labels.csv").write_bytes(b"file,raised\n\xff\xfe\x00,1\n")
    with pytest.raises(RecordingError, match=r"is not a CSV file in UTF-8"):
        read_labels(tmp_path)


def test_attributes_say_more_of_the_photos(labels, tmp_path):
    labels("file,raised\na.jpg,1\nb.jpg,0\n")
    (tmp_path / "attributes.csv").write_text("file,hand,light\na.jpg,fist,\n", encoding="utf-8")
    assert [photo.traits for photo in read_photos(tmp_path)] == [{"hand": "fist"}, {}]


def test_folders_of_photos_are_read_together(tmp_path):
    for name in ("bar", "hall"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "a.jpg").touch()
        (tmp_path / name / "labels.csv").write_text("file,raised\na.jpg,0\n", encoding="utf-8")
    (tmp_path / "attributes.csv").write_text("file,hand\nhall/a.jpg,palm\n", encoding="utf-8")
    bar, hall = read_photos(tmp_path)
    assert bar.traits == {"folder": "bar"}
    assert hall.traits == {"folder": "hall", "hand": "palm"}


def test_attributes_without_files_are_refused(labels, tmp_path):
    labels("file,raised\na.jpg,1\n")
    (tmp_path / "attributes.csv").write_text("photo,hand\na.jpg,fist\n", encoding="utf-8")
    with pytest.raises(RecordingError, match="line 1: there is no column `file`"):
        read_photos(tmp_path)


def test_photos_may_lie_elsewhere(tmp_path):
    (tmp_path / "a.jpg").touch()
    (tmp_path / "labels").mkdir()
    (tmp_path / "labels/labels.csv").write_text(f"file,raised\n{tmp_path / 'a.jpg'},1\n")
    (photo,) = read_photos(tmp_path / "labels")
    assert photo.path.name == "a.jpg"
