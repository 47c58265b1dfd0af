"""What stands and hangs in a room? Walls with posters, tables, chairs, as a scene file has them.

Lengths are meters, angles degrees, places in the map frame (x and y on the floor).
"""

from __future__ import annotations

from math import hypot
from typing import Annotated, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, model_validator

Color: TypeAlias = Annotated[str, Field(pattern=r"^#[0-9a-fA-F]{6}$")]
Point: TypeAlias = Annotated[tuple[float, float], Field(strict=False)]


class Part(BaseModel):
    """Anything of a scene file: what is unknown, of another type or not finite is refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class Pose2(Part):
    """A place on the floor and a direction."""

    x_m: float = 0.0
    y_m: float = 0.0
    yaw_deg: float = 0.0


class Poster(Part):
    """A sheet that hangs on a straight piece of a wall."""

    piece: int = Field(0, ge=0, description="Which straight piece, from 0, as corners go.")
    at_m: float = Field(ge=0.0, description="Its middle, from the piece's first corner.")
    z_m: float = Field(1.5, gt=0.0, le=10.0, description="Height of its middle.")
    width_m: float = Field(0.6, gt=0.0, le=5.0)
    height_m: float = Field(0.9, gt=0.0, le=5.0)
    shows: Literal["menu", "person", "raised_hand"] = Field(
        "menu", description="Lines of text, somebody, or somebody with a raised hand."
    )
    color: Color = "#e9dfc8"


class Wall(Part):
    """A run of straight walls through corners."""

    corners_m: Annotated[tuple[Point, ...], Field(strict=False, min_length=2)]
    closed: bool = False
    height_m: float = Field(2.6, gt=0.0, le=20.0)
    color: Color = "#d9cbb2"
    panel: Color = Field("#8a6a4f", description="The lower part, up to 0.9 m.")
    pictures: bool = True
    posters: Annotated[tuple[Poster, ...], Field(strict=False)] = ()

    @property
    def segments(self) -> list[tuple[float, float, float, float]]:
        """x_m, y_m of each straight piece's two ends."""
        ends = [*self.corners_m[1:], self.corners_m[0]] if self.closed else self.corners_m[1:]
        return [(*start, *end) for start, end in zip(self.corners_m, ends, strict=False)]

    @model_validator(mode="after")
    def _possible(self) -> Wall:
        pieces = self.segments
        for poster in self.posters:
            if poster.piece >= len(pieces):
                raise ValueError(
                    f"posters: piece is {poster.piece}; this wall has the pieces 0 to "
                    f"{len(pieces) - 1}"
                )
            x0, y0, x1, y1 = pieces[poster.piece]
            length_m, half_m = hypot(x1 - x0, y1 - y0), poster.width_m / 2
            if not half_m <= poster.at_m <= length_m - half_m:
                raise ValueError(
                    f"posters: at_m is {poster.at_m:g}; allowed is {half_m:g} to "
                    f"{length_m - half_m:g} on piece {poster.piece}"
                )
        return self


class Table(Pose2):
    """A table on one, two or four posts, round or rectangular."""

    length_m: float = Field(0.8, gt=0.0, le=10.0, description="Along its own x axis.")
    width_m: float = Field(0.8, gt=0.0, le=10.0)
    height_m: float = Field(0.74, gt=0.0, le=2.0)
    posts: Literal[1, 2, 4] = Field(
        4, description="One pedestal in the middle, one post near each short side, or four legs."
    )
    round: bool = False
    plates: int = Field(2, ge=0, le=8)
    color: Color = "#b98a5a"


class Chair(Pose2):
    """A chair, whose sitter looks along its x axis, or a bar stool on one column."""

    kind: Literal["chair", "bar_stool"] = "chair"
    color: Color = "#7a5a3c"

    @property
    def seat_m(self) -> float:
        """Height of the seat."""
        return 0.45 if self.kind == "chair" else 0.75
