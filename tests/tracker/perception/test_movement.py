import numpy as np

from tracker.perception.movement import Movement


def room(seed=0, noise=3.0):
    """A gray wall, seen by a camera with noise."""
    rng = np.random.default_rng(seed)
    return np.clip(rng.normal(120.0, noise, (480, 640, 3)), 0, 255).astype(np.uint8)


def with_hand(picture, x, y, side=20):
    picture[y : y + side, x : x + side] = 220
    return picture


def test_a_first_picture_tells_nothing():
    assert len(Movement().boxes(room())) == 0


def test_noise_is_no_movement():
    movement = Movement()
    assert not any(len(movement.boxes(room(seed))) for seed in range(10))


def test_a_hand_that_appears_is_boxed():
    movement = Movement()
    movement.boxes(room(0))
    (box,) = movement.boxes(with_hand(room(1), 400, 104))
    assert np.all(box[:2] <= [400, 104])
    assert np.all(box[2:] >= [420, 124])
    assert np.all(box[2:] - box[:2] <= 60)


def test_two_movements_are_two_boxes():
    movement = Movement()
    movement.boxes(room(0))
    assert len(movement.boxes(with_hand(with_hand(room(1), 80, 80), 500, 300))) == 2


def test_a_camera_that_moves_says_nothing():
    movement = Movement()
    picture = np.kron(np.random.default_rng(1).integers(0, 255, (48, 64, 3)), np.ones((10, 10, 1)))
    movement.boxes(picture.astype(np.uint8))
    assert len(movement.boxes(np.roll(picture, 30, axis=1).astype(np.uint8))) == 0


def test_a_picture_of_another_size_begins_anew():
    movement = Movement()
    movement.boxes(room(0))
    assert len(movement.boxes(room(1)[:240, :320])) == 0
    movement.reset()
    assert len(movement.boxes(room(2)[:240, :320])) == 0
