from tracker.waiting import IMAGES_KEPT, ImageQueue, Verdict, WaitingImage

PERIOD_NS = 100_000_000


def image(number, since_ns=0):
    return WaitingImage(10**12 + number * PERIOD_NS, "camera", since_ns, lambda: None)


def numbers(images):
    return [(image.stamp_ns - 10**12) // PERIOD_NS for image in images]


def test_ready_images_leave_in_order_up_to_the_first_that_is_not():
    queue = ImageQueue(10.0)
    for number in range(5):
        assert queue.offer(image(number)) is Verdict.ADMITTED
    ready = queue.take(lambda one: one.stamp_ns != image(3).stamp_ns, at_most=9)
    assert numbers(ready) == [0, 1, 2]
    assert (len(queue), queue.lost) == (2, 0)


def test_of_more_than_may_be_taken_the_newest_count_and_the_others_are_lost():
    queue = ImageQueue(10.0)
    for number in range(5):
        queue.offer(image(number))
    assert numbers(queue.take(lambda one: True, at_most=2)) == [3, 4]
    assert (len(queue), queue.lost) == (0, 3)


def test_of_too_many_images_the_oldest_give_way_and_are_counted():
    queue = ImageQueue(10.0)
    for number in range(IMAGES_KEPT + 3):
        queue.offer(image(number))
    assert (len(queue), queue.lost) == (IMAGES_KEPT, 3)


def test_a_full_queue_hands_out_its_first_image_instead_of_losing_it():
    queue = ImageQueue(10.0)
    for number in range(IMAGES_KEPT - 1):
        queue.offer(image(number))
    assert queue.next(lambda one: False) is None
    queue.offer(image(IMAGES_KEPT - 1))
    assert queue.next(lambda one: False).stamp_ns == image(0).stamp_ns
    assert queue.lost == 0


def test_images_of_the_time_before_a_jump_are_dropped():
    queue = ImageQueue(10.0)
    queue.offer(image(1000))
    assert queue.offer(image(0)) is Verdict.ODD
    assert queue.offer(image(1)) is Verdict.JUMPED_BACK
    assert numbers(queue.take(lambda one: True, at_most=9)) == [1]


def test_after_a_reset_any_stamp_is_believed():
    queue = ImageQueue(10.0)
    queue.offer(image(1000))
    queue.reset()
    assert len(queue) == 0
    assert queue.offer(image(0)) is Verdict.ADMITTED
