"""How does the comparison with the truth look in a terminal?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.evaluation.metrics.raised_hands.episode_report import EpisodeReport

if TYPE_CHECKING:
    from rich.table import Table


def episode_table(report: EpisodeReport) -> Table:
    """One line per raised hand of the truth and per invented one, totals in the caption."""
    from rich.table import Table

    table = Table(title="Raised hands against the truth", title_justify="left")
    table.add_column("person")
    for name in ("hand up at", "reported after", "position error", "identity"):
        table.add_column(name, justify="right")
    for row in report.episodes:
        told = row.reported_frames is not None
        table.add_row(
            str(row.person),
            f"{report.seconds(row.start_ns):.2f} s",
            f"{row.delay_s:.2f} s, {_count(row.reported_frames, 'frame')}" if told else "missed",
            f"{row.position_error_m:.2f} m" if row.position_error_m is not None else "-",
            ", ".join(f"#{key}" for key in row.identities) or "-",
            style="" if told else "red",
        )
    for invented in report.invented:
        table.add_row(
            "nobody" if invented.person is None else f"{invented.person}, hand down",
            f"{report.seconds(invented.start_ns):.2f} s",
            "invented",
            "-",
            f"#{invented.identity}",
            style="red",
        )
    table.caption = _totals(report)
    table.caption_justify = "left"
    return table


def _totals(report: EpisodeReport) -> str:
    several = sum(len(ids) > 1 for ids in report.identities.values())
    error = report.position_error_m
    parts = [
        f"{len(report.found)} of {_count(len(report.episodes), 'episode')} reported",
        f"{len(report.invented)} invented",
        f"{several} of {_count(len(report.identities), 'person', 'people')} "
        "with several identities",
        _count(report.identity_switches, "identity switch", "identity switches"),
        "no position" if error is None else f"median position error {error:.2f} m",
    ]
    if report.too_short:
        parts.append(f"{report.too_short} too short to report")
    if report.frames_without_truth:
        parts.append(f"{_count(report.frames_without_truth, 'image')} without truth")
    return "; ".join(parts)


def _count(number: int | None, one: str, many: str = "") -> str:
    return f"{number} {one if number == 1 else many or one + 's'}"
