import pytest

from tracker.camera import CameraModel, Pinhole
from tracker.config import Config
from tracker.locating.picture_camera import PictureCameras
from tracker.notes import NoteKind


def kinds(found):
    return [note.kind for note in found.notes]


def of(width, height, **parameters):
    return PictureCameras(Config(**parameters)).of(width, height)


def test_the_specification_s_picture_gets_its_intrinsics_as_they_are():
    camera, notes = of(640, 480)
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (460.0, 460.0, 320.0, 240.0)
    assert notes == ()


@pytest.mark.parametrize(
    ("size", "intrinsics"),
    [
        ((320, 240), (230.0, 160.0, 120.0)),
        ((1280, 960), (920.0, 640.0, 480.0)),
        ((1920, 1080), (1380.0, 960.0, 540.0)),  # rows are left out above and below
        ((1080, 1920), (1380.0, 540.0, 960.0)),  # held upright
    ],
)
def test_a_picture_of_another_size_gets_them_scaled_by_its_longer_side(size, intrinsics):
    found = of(*size)
    camera = found.camera
    assert (camera.fx, camera.cx, camera.cy) == pytest.approx(intrinsics)
    assert camera.fy == camera.fx
    (note,) = found.notes
    assert note.kind is NoteKind.INTRINSICS_SCALED
    assert f"from 640x480 to {size[0]}x{size[1]}: fx {intrinsics[0]:.1f}" in note.text


def test_an_offset_of_the_principal_point_stays_that_of_the_lens():
    camera, _ = of(1280, 720, camera_cx=310.0, camera_cy=250.0)
    assert (camera.cx, camera.cy) == (620.0, 380.0)


def test_intrinsics_whose_middle_is_the_picture_s_are_the_picture_s():
    own = {"camera_fx": 1390.0, "camera_fy": 1380.0, "camera_cx": 951.0, "camera_cy": 548.0}
    camera, notes = of(1920, 1080, **own)
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (1390.0, 1380.0, 951.0, 548.0)
    assert notes == ()


def test_their_own_size_decides_where_it_is_given():
    own = {"camera_fx": 1390.0, "camera_fy": 1390.0, "camera_cx": 960.0, "camera_cy": 540.0}
    found = of(640, 360, **own, camera_width=1920, camera_height=1080)
    assert found.camera.fx == pytest.approx(1390 / 3)
    assert kinds(found) == [NoteKind.INTRINSICS_SCALED]


def test_a_size_that_does_not_fit_its_principal_point_is_told():
    found = of(1280, 720, camera_cx=640.0, camera_cy=360.0, camera_width=640, camera_height=360)
    assert kinds(found) == [NoteKind.INTRINSICS_SCALED, NoteKind.PRINCIPAL_POINT_OFF]
    assert "(640.0, 360.0)" in found.notes[1].text
    assert "(320.0, 180.0)" in found.notes[1].text
    assert "camera_width" in found.notes[1].text


def test_camera_info_of_this_size_needs_no_word():
    cameras = PictureCameras(Config())
    calibrated = CameraModel(600.0, 600.0, 400.0, 300.0, (), "", 800, 600)
    cameras.calibrate(calibrated)
    assert cameras.of(800, 600) == (calibrated, ())


def test_camera_info_of_another_size_is_scaled_and_told():
    cameras = PictureCameras(Config())
    cameras.calibrate(CameraModel(600.0, 600.0, 400.0, 300.0, (), "", 800, 600))
    found = cameras.of(400, 300)
    assert found.camera.fx == 300.0
    assert kinds(found) == [NoteKind.INTRINSICS_SCALED]


def test_camera_info_of_another_shape_is_refused_and_the_parameters_serve():
    cameras = PictureCameras(Config())
    cameras.calibrate(CameraModel(600.0, 600.0, 400.0, 300.0, (), "", 800, 600))
    found = cameras.of(800, 450)
    assert found.camera.fx == pytest.approx(460.0 * 800 / 640)
    assert kinds(found) == [NoteKind.CAMERA_INFO_REFUSED, NoteKind.INTRINSICS_SCALED]
    assert found.notes[0].kind.is_fault


@pytest.mark.parametrize(
    ("sized", "middle"), [((1440, 1080), "(720.0, 540.0)"), ((None, None), "(360.0, 270.0)")]
)
def test_a_principal_point_far_off_the_middle_is_told_with_both(sized, middle):
    cameras = PictureCameras(Config())
    cameras.calibrate(CameraModel(500.0, 500.0, 180.0, 135.0, (), "", *sized))
    found = cameras.of(720, 540)
    (note,) = [note for note in found.notes if note.kind is NoteKind.PRINCIPAL_POINT_OFF]
    assert "(180.0, 135.0)" in note.text
    assert middle in note.text
    assert "binning" in note.text


def test_parameters_that_change_serve_until_the_next_camera_info():
    cameras = PictureCameras(Config())
    cameras.calibrate(CameraModel(600.0, 600.0, 320.0, 240.0, (), "", 640, 480))
    cameras.configure(Config(processing_rate=5.0))
    assert cameras.of(640, 480).camera.fx == 600.0
    cameras.configure(Config(camera_fx=470.0))
    assert cameras.of(640, 480).camera.fx == 470.0


def test_rectified_images_have_the_intrinsics_of_their_own():
    lens = (-0.3, 0.1, 0.0, 0.0, 0.0)
    rectified = Pinhole(380.0, 381.0, 330.0, 236.0)
    info = CameraModel(460.0, 460.0, 320.0, 240.0, lens, "plumb_bob", 640, 480, None, rectified)
    cameras = PictureCameras(Config(image_form="rectified"))
    cameras.calibrate(info)
    camera, notes = cameras.of(320, 240)
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (190.0, 190.5, 165.0, 118.0)
    assert camera.distortion == ()
    assert [note.kind for note in notes] == [NoteKind.INTRINSICS_SCALED]


def test_rectified_images_without_their_intrinsics_are_told():
    cameras = PictureCameras(Config(image_form="rectified"))
    cameras.calibrate(CameraModel(460.0, 460.0, 320.0, 240.0, (), "", 640, 480))
    found = cameras.of(640, 480)
    assert kinds(found) == [NoteKind.CAMERA_INFO_REFUSED]
    assert "image_form: raw" in found.notes[0].text


@pytest.mark.parametrize(
    ("topic", "fx"),
    [
        ("/camera/image_rect", 380.0),
        ("image_rect_color/compressed", 380.0),
        ("/rectified/image", 380.0),
        ("/camera/image_raw", 460.0),
        ("/rectangle/image", 460.0),
        ("", 460.0),
    ],
)
def test_the_topic_s_name_tells_whether_images_are_rectified(topic, fx):
    lens, rectified = (-0.3, 0.1, 0.0, 0.0, 0.0), Pinhole(380.0, 381.0, 330.0, 236.0)
    info = CameraModel(460.0, 460.0, 320.0, 240.0, lens, "plumb_bob", 640, 480, None, rectified)
    cameras, raw = PictureCameras(Config(), topic), PictureCameras(Config(image_form="raw"), topic)
    cameras.calibrate(info)
    raw.calibrate(info)
    assert cameras.of(640, 480).camera.fx == fx
    assert raw.of(640, 480).camera.fx == 460.0


def test_a_topic_named_rectified_without_p_has_k():
    cameras = PictureCameras(Config(), "/camera/image_rect")
    cameras.calibrate(CameraModel(460.0, 460.0, 320.0, 240.0, (), "", 640, 480))
    assert cameras.of(640, 480).notes == ()


@pytest.mark.parametrize(
    ("fx", "fy", "lens"),
    [(3e8, 3e8, ()), (3.6, 3.6, ()), (1.0, 1.0, ()), (400.0, 400.0, (8e8,) * 5)],
    ids=["in nanometers", "in millimeters", "none", "a lens without a middle"],
)
def test_intrinsics_that_no_camera_has_are_refused(fx, fy, lens):
    cameras = PictureCameras(Config())
    cameras.calibrate(CameraModel(fx, fy, 320.0, 240.0, lens, "plumb_bob", 640, 480))
    camera, notes = cameras.of(640, 480)
    assert camera.fx == Config().camera_fx
    assert [note.kind for note in notes] == [NoteKind.CAMERA_INFO_REFUSED]


@pytest.mark.parametrize("fx", [180.0, 400.0, 9000.0])
def test_wide_and_narrow_cameras_are_believed(fx):
    cameras = PictureCameras(Config())
    cameras.calibrate(CameraModel(fx, fx, 320.0, 240.0, width=640, height=480))
    assert cameras.of(640, 480).camera.fx == fx
