from html.parser import HTMLParser

import numpy as np
import pytest

from tracker import CameraImage, Config
from tracker.containers import PerceptionWork
from tracker.report.history.history import History
from tracker.report.plots.overview import draw_overview
from tracker.report.replay.moments import Moments
from tracker.report.replay.replay_page import ReplayReport
from tracker.report.replay.stage_times import StageTimes

NASTY = "<script>alert(1)</script>.mcap"


def an_image(result):
    return CameraImage(result.stamp_ns, "camera", np.full((480, 640, 3), 90, np.uint8))


def make_page(results, folder, config=None, **words):
    report, history = ReplayReport(config or Config()), History()
    for result in results:
        report.watch(an_image(result), result, 0.02)
        history.write(result)
    draw_overview(history, folder / "overview.png")
    return report.page(NASTY, history, overview=folder / "overview.png", **words)


@pytest.fixture(scope="module")
def page(results, tmp_path_factory):
    return make_page(
        results,
        tmp_path_factory.mktemp("page"),
        Config(processing_rate=7.5),
        problems=("stamps <b>jumped</b>",),
        remarks=("a remark <i>",),
        command="raised-hand replay x",
    )


class Images(HTMLParser):
    def __init__(self, html):
        super().__init__()
        self.alts, self.tags = [], set()
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)
        if tag == "img":
            self.alts.append(dict(attrs)["alt"])


def test_the_page_has_every_chapter_and_picture(page):
    assert [section.title for section in page.sections if section.parts] == [
        "In short", "Map and time line", "People", "Pictures", "Remarks",
        "Time per image", "Settings", "Versions and command",
    ]  # fmt: skip
    shown = Images(page.html())
    assert len(shown.alts) == 1 + 4  # map and time line; four times a hand went up
    # A person's first hand is told once they are confirmed, with their fifth image.
    assert shown.alts[-4:] == ["2.4 s: #1 up", "5.9 s: #2 up", "16.4 s: #4 up", "24.2 s: #1 up"]


def test_what_a_recording_brings_is_escaped(page):
    html = page.html()
    assert not Images(html).tags & {"script", "b", "i"}
    for words in ("&lt;script&gt;", "&lt;b&gt;jumped", "a remark &lt;i&gt;"):
        assert words in html


def test_the_page_is_small(page):
    assert len(page.html().encode()) < 5e6


def test_only_settings_that_differ_are_listed(page):
    (_, table) = next(item for item in page.sections if item.title == "Settings").parts
    assert [row[:3] for row in table.rows] == [("processing_rate", "7.5", "10")]


def test_a_recording_of_nobody_has_a_page_too(tmp_path, result_of):
    page = make_page([result_of(10**9 * second) for second in range(3)], tmp_path)
    assert "Nobody was confirmed" in page.html()
    assert [alt for alt in Images(page.html()).alts if alt.endswith(" s")] == [
        "0.0 s", "1.0 s", "2.0 s",
    ]  # fmt: skip


def test_pictures_of_a_long_recording_are_few_and_spread_over_it(result_of):
    moments = Moments(Config())
    for second in range(100):  # the hand goes up in every second image
        result = result_of(second * 10**9, (1, 1.0, 0.0, second % 2 == 1))
        moments.write(an_image(result), result)
    titles = [picture.title for picture in moments.pictures]
    assert len(titles) <= 8
    assert titles[0] == "1.0 s: #1 up"
    assert float(titles[-1].split(" ")[0]) > 75.0


def test_stage_times_are_told_within_one_percent(result_of):
    times = StageTimes()
    for milliseconds in range(1, 101):
        seconds = milliseconds / 1e3
        work = PerceptionWork(search_s=0.5 * seconds, total_s=0.75 * seconds)
        times.write(result_of(0, work=work), seconds)
    assert times.median_s() == pytest.approx(0.050, rel=0.011)
    rows = {row[0]: [float(cell) for cell in row[1:]] for row in times.table().rows}
    assert rows["the whole image"] == pytest.approx([50.0, 99.0, 100.0], rel=0.011)
    assert rows["ranging and tracking"] == pytest.approx([12.5, 24.75, 25.0], rel=0.011)
