from types import SimpleNamespace

from tracker.notes import Note, NoteKind
from tracker.problems.scan_use import ScanUse


def image_with(*notes):
    return SimpleNamespace(notes=tuple(Note(kind, text) for kind, text in notes))


def test_a_scanner_that_serves_every_image_needs_no_reason():
    use = ScanUse()
    for _ in range(3):
        use.add(image_with((NoteKind.NO_POSE, "no pose")))
    assert (use.frames, use.used, use.reason()) == (3, 3, "")


def test_the_most_frequent_reason_is_told_in_its_first_words_with_the_remedy():
    use = ScanUse()
    use.add(image_with((NoteKind.NO_SCAN, "no scan was received")))
    for number in range(3):
        use.add(image_with((NoteKind.SCAN_TOO_OLD, f"the nearest is 0.{number + 4} s later")))
    use.add(image_with())
    assert (use.frames, use.used) == (5, 1)
    assert use.reason().startswith("the nearest is 0.4 s later. Do the clocks")
    use.reset()
    assert (use.frames, use.reason()) == (0, "")
