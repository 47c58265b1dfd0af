"""Text, tables and pictures as one HTML file that needs no other file.

The page loads nothing and runs nothing, and tells the browser to refuse what would: pictures are
inside, folded sections are the browser's own. Whatever a recording brings is escaped.
"""

from __future__ import annotations

import io
from base64 import b64encode
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import cv2
import matplotlib
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from matplotlib.figure import Figure

from tracker.containers import ImageArray
from tracker.outputs import writing_into

if TYPE_CHECKING:
    from rich.table import Table as RichTable

_TEMPLATE = "page.html"
_JPEG_QUALITY = 82
_PHOTO_WIDTH_PX = 640
_DOTS_PER_INCH = 160
_MEDIA = {"png": "image/png", "svg": "image/svg+xml"}


@dataclass(frozen=True, slots=True)
class Text:
    """Paragraphs.

    Attributes:
        paragraphs: Plain text, one entry each.
    """

    kind: ClassVar[str] = "text"
    paragraphs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Facts:
    """Headline figures.

    Attributes:
        items: What it is, its value, and what to know about it ("" where nothing).
    """

    kind: ClassVar[str] = "facts"
    items: tuple[tuple[str, str, str], ...]


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of text.

    Attributes:
        columns: Headings.
        rows: Cells, as many in each row as there are columns.
        numeric: Columns that are aligned at their right.
        marked: Numbers of the rows that stand out, from 0.
        title: Above it.
        caption: Below it.
    """

    kind: ClassVar[str] = "table"
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numeric: frozenset[int] = frozenset()
    marked: frozenset[int] = frozenset()
    title: str = ""
    caption: str = ""

    @staticmethod
    def from_rich(table: RichTable) -> Table:
        """The same table as in the terminal; rows of a style of their own are marked."""
        return Table(
            columns=tuple(str(column.header) for column in table.columns),
            rows=tuple(zip(*(map(str, column.cells) for column in table.columns), strict=True)),
            numeric=frozenset(
                place for place, column in enumerate(table.columns) if column.justify == "right"
            ),
            marked=frozenset(place for place, row in enumerate(table.rows) if row.style),
            title=str(table.title or ""),
            caption=str(table.caption or ""),
        )


@dataclass(frozen=True, slots=True)
class Picture:
    """A plot or a photo, inside the page.

    Attributes:
        data: The file's content.
        media_type: Of the file, as "image/png".
        title: What it shows, also for those who cannot see it.
        is_plot: Drawn on white, and shown less bright on a dark screen.
    """

    kind: ClassVar[str] = "picture"
    data: bytes
    media_type: str
    title: str
    is_plot: bool = True

    @staticmethod
    def plot(figure: Figure, title: str, form: str = "svg") -> Picture:
        """What matplotlib drew.

        Args:
            figure: The drawing; its size in inches is how wide it is shown at most.
            title: What it shows.
            form: "svg" for lines, "png" for thousands of dots.
        """
        file = io.BytesIO()
        # The same drawing shall be the same bytes: no date, no random names.
        with matplotlib.rc_context({"svg.hashsalt": title}):
            undated = {"Date": None} if form == "svg" else {}
            figure.savefig(file, format=form, dpi=_DOTS_PER_INCH, metadata=undated)
        return Picture(file.getvalue(), _MEDIA[form], title)

    @staticmethod
    def photo(bgr: ImageArray, title: str) -> Picture:
        """A camera's picture as JPEG, at most 640 pixels wide.

        Args:
            bgr: Shape (height, width, 3), uint8, blue-green-red.
            title: What it shows.
        """
        height, width = bgr.shape[:2]
        if width > _PHOTO_WIDTH_PX:
            size = (_PHOTO_WIDTH_PX, max(1, round(height * _PHOTO_WIDTH_PX / width)))
            bgr = cv2.resize(bgr, size, interpolation=cv2.INTER_AREA)  # type: ignore[assignment]
        _, data = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
        return Picture(data.tobytes(), "image/jpeg", title, is_plot=False)

    @property
    def source(self) -> str:
        """The content as a data URL."""
        return f"data:{self.media_type};base64,{b64encode(self.data).decode('ascii')}"


@dataclass(frozen=True, slots=True)
class Gallery:
    """Pictures beside each other, as many as there is room for.

    Attributes:
        pictures: From left to right.
    """

    kind: ClassVar[str] = "gallery"
    pictures: tuple[Picture, ...]


Part = Text | Facts | Table | Picture | Gallery


@dataclass(frozen=True, slots=True)
class Section:
    """A chapter of the page.

    Attributes:
        title: Its heading.
        parts: From top to bottom; a section without any is left out.
    """

    title: str
    parts: tuple[Part, ...]


@dataclass(frozen=True, slots=True)
class Page:
    """One report.

    Attributes:
        title: What it is about.
        subtitle: One sentence below it.
        sections: From top to bottom.
    """

    title: str
    subtitle: str
    sections: tuple[Section, ...]

    def html(self) -> str:
        """The page as text."""
        environment = Environment(
            loader=FileSystemLoader(Path(__file__).parent),
            autoescape=True,
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
        )
        return environment.get_template(_TEMPLATE).render(page=self)

    def write(self, path: str | Path) -> Path:
        """Write the page; the file is there as a whole or not at all.

        Args:
            path: The .html file, replaced if it exists; its folder is made where it is missing.

        Returns:
            The file.

        Raises:
            RecordingError: It cannot be written.
        """
        path = Path(path)
        with writing_into(path.parent) as new:
            new(path.name).write_text(self.html(), encoding="utf-8")
        return path
