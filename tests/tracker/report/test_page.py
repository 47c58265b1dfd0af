from html.parser import HTMLParser

import numpy as np
import pytest
from matplotlib.figure import Figure
from rich.table import Table as RichTable

from tracker.errors import RecordingError
from tracker.report.page import Facts, Gallery, Page, Picture, Section, Table, Text

NASTY = "<script>alert('1')</script> & \"quotes\""


class Parsed(HTMLParser):
    """Tags with their attributes, and the words between them."""

    def __init__(self, html):
        super().__init__()
        self.tags, self.words = [], []
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.words.append(data)

    def all(self, name):
        return [attributes for tag, attributes in self.tags if tag == name]


def a_plot(form="svg"):
    figure = Figure(figsize=(2, 1))
    figure.add_subplot().plot([0, 1], [0, 1])
    return Picture.plot(figure, NASTY, form)


@pytest.fixture
def page():
    """Every kind of part, every text of it nasty."""
    photo = Picture.photo(np.zeros((960, 1280, 3), np.uint8), NASTY)
    table = Table((NASTY,), ((NASTY,),), marked=frozenset({0}), title=NASTY, caption=NASTY)
    parts = (Text((NASTY,)), Facts(((NASTY, NASTY, NASTY),)), table, a_plot(), a_plot("png"))
    sections = (
        Section(NASTY, (*parts, Gallery((photo,)))),
        Section("More", (Text(("inside",)),)),
        Section("Empty", ()),
    )
    return Page(NASTY, NASTY, sections)


def test_the_page_asks_for_nothing_outside_of_itself(page):
    parsed = Parsed(page.html())
    for tag, attributes in parsed.tags:
        assert tag not in ("link", "iframe", "object", "script")
        assert attributes.get("src", "data:").startswith("data:")
        assert attributes.get("href", "#").startswith("#")
    assert "url(" not in page.html()
    assert "@import" not in page.html()
    policy = parsed.all("meta")[-1]["content"]
    assert policy == "default-src 'none'; img-src data:; style-src 'unsafe-inline'"


def test_every_text_is_escaped(page):
    parsed = Parsed(page.html())
    assert not parsed.all("script")
    # title, heading, subtitle, link, section, paragraph, fact (3), table (4), captions (3)
    assert sum(NASTY in word for word in parsed.words) == 16
    assert [image["alt"] for image in parsed.all("img")] == [NASTY] * 3


def test_plots_are_svg_or_png_and_photos_are_jpeg_of_bounded_width(page):
    sources = [image["src"] for image in Parsed(page.html()).all("img")]
    kinds = [source.partition(";base64,")[0] for source in sources]
    assert kinds == ["data:image/svg+xml", "data:image/png", "data:image/jpeg"]
    import cv2

    photo = page.sections[0].parts[-1].pictures[0]
    assert cv2.imdecode(np.frombuffer(photo.data, np.uint8), 1).shape == (480, 640, 3)


def test_a_section_without_parts_is_left_out(page):
    parsed = Parsed(page.html())
    assert [link["href"] for link in parsed.all("a")] == ["#part-1", "#part-2"]
    assert "Empty" not in "".join(parsed.words)


def test_a_table_of_the_terminal_keeps_cells_sides_and_marks():
    rich = RichTable(title="What", caption="so far")
    rich.add_column("name")
    rich.add_column("value", justify="right")
    rich.add_row("a", "1")
    rich.add_row("b", "2", style="red")
    assert Table.from_rich(rich) == Table(
        ("name", "value"), (("a", "1"), ("b", "2")), frozenset({1}), frozenset({1}),
        title="What", caption="so far",
    )  # fmt: skip


def test_the_same_drawing_is_the_same_bytes():
    assert a_plot().data == a_plot().data


def test_a_page_is_written_with_its_folder_and_replaces_what_was_there(page, tmp_path):
    path = page.write(tmp_path / "new" / "page.html")
    Page("again", "", ()).write(path)
    assert "<h1>again</h1>" in path.read_text(encoding="utf-8")
    assert [item.name for item in path.parent.iterdir()] == ["page.html"]


def test_a_place_that_cannot_be_written_is_named(page, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(RecordingError, match="file"):
        page.write(tmp_path / "file" / "page.html")
