import io

from rich.console import Console

from tracker.evaluation.metrics.raised_hands.episode_report import (
    EpisodeReport,
    EpisodeRow,
    InventedRow,
)
from tracker.report.replay.episode_table import episode_table

SECOND = 10**9


def text_of(report):
    console = Console(width=120, file=io.StringIO())
    console.print(episode_table(report))
    return console.file.getvalue()


def test_every_episode_and_every_invention_is_a_line_and_the_totals_stand_below():
    found = EpisodeRow(
        7, 2 * SECOND, 9 * SECOND, (1.0, 0.0), 70, 22 * SECOND // 10, 3, 0.123, (3,)
    )
    missed = EpisodeRow(8, 4 * SECOND, 5 * SECOND, (1.0, 0.0), 10, None, None, None, ())
    invented = InventedRow(5, 6 * SECOND, 7 * SECOND, (4.0, 0.0), None)
    text = text_of(
        EpisodeReport(
            start_ns=SECOND, episodes=(found, missed), invented=(invented,), too_short=1,
            identities={7: (3, 9)}, identity_switches=1, position_error_m=0.1, frames=100,
            frames_without_truth=0,
        )
    )  # fmt: skip
    lines = text.splitlines()
    (line,) = [line for line in lines if "3 frames" in line]
    assert [cell.strip() for cell in line.strip("│").split("│")] == [
        "7", "1.00 s", "0.20 s, 3 frames", "0.12 m", "#3",
    ]  # fmt: skip
    assert any("missed" in line and "3.00 s" in line for line in lines)
    assert any("invented" in line and "nobody" in line and "#5" in line for line in lines)
    words = " ".join(text.split())
    assert "1 of 2 episodes reported; 1 invented" in words
    assert "1 identity switch;" in words
    assert "1 too short to report" in words
