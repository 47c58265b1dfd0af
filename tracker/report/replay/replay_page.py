"""What does a replay's page hold? Who raised a hand, where, when, and what went wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, FrameResult
from tracker.evaluation.metrics.raised_hands.episode_report import EpisodeReport
from tracker.report.history.history import History, Person
from tracker.report.page import Facts, Gallery, Page, Part, Picture, Section, Table, Text
from tracker.report.provenance import provenance_section, settings_section
from tracker.report.replay.episode_table import episode_table
from tracker.report.replay.moments import Moments
from tracker.report.replay.stage_times import StageTimes
from tracker.report.replay.summary import summary_table
from tracker.wording import counted

_PEOPLE_LISTED = 100


class ReplayReport:
    """Watches a replay, then makes its page; memory does not grow with the recording.

    Args:
        config: The parameters in force.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        self._moments = Moments(config)
        self._times = StageTimes()

    def watch(self, image: CameraImage, result: FrameResult, busy_s: float) -> None:
        """Take in an image, what it led to, and how long the pipeline took for it."""
        self._moments.write(image, result)
        self._times.write(result, busy_s)

    def page(
        self,
        source: str,
        history: History,
        episodes: EpisodeReport | None = None,
        *,
        overview: Path,
        problems: tuple[str, ...] = (),
        remarks: tuple[str, ...] = (),
        command: str = "",
    ) -> Page:
        """The page of everything that was watched.

        Args:
            source: The recording, as the reader knows it.
            history: What was collected while the recording streamed.
            episodes: A comparison with the truth, where there is any.
            overview: The replay's own overview.png.
            problems: What was wrong with the input.
            remarks: What is worth saying and is no fault.
            command: As typed.
        """
        hands = summary_table(history)
        people: list[Part] = [_people_table(history)] if history.people else []
        people += [Table.from_rich(hands)] if hands.row_count else []
        if episodes is not None:
            people.append(Table.from_rich(episode_table(episodes)))
        picture = Picture(
            overview.read_bytes(),
            "image/png",
            "Where hands were raised, and below it when; each person's existence (a probability), "
            "fresh pose, and service.",
        )
        sections = (
            Section("In short", (self._headline(history, episodes), *_trouble(problems))),
            Section("Map and time line", (picture,)),
            Section("People", tuple(people) or (Text(("Nobody was confirmed.",)),)),
            Section("Pictures", _gallery(self._moments.pictures)),
            Section("Remarks", _remarks(history, remarks)),
            Section("Time per image", (self._times.table(),)),
            settings_section(self._config),
            provenance_section(command),
        )
        frames = f"{counted(history.frames_processed, 'image')} over {history.duration_s:.1f} s"
        return Page(f"Replay of {Path(source).name or source}", f"{source}: {frames}", sections)

    def _headline(self, history: History, episodes: EpisodeReport | None) -> Facts:
        raises = sum(len(person.hands) for person in history.people.values())
        share = history.frames_raised / max(1, history.frames_processed)
        items = [
            ("people", str(len(history.people) + history.people_dropped), "confirmed customers"),
            ("raised hands", str(raises), "raised hands reported"),
            ("hand_raised", f"{share:.0%}", "of the images"),
            ("images", str(history.frames_processed), f"in {history.duration_s:.1f} s"),
        ]
        median_ms = 1e3 * self._times.median_s()
        if np.isfinite(median_ms):
            items.append(("time per image", f"{median_ms:.0f} ms", "median, on this machine"))
        if episodes is not None:
            found, all_ = len(episodes.found), len(episodes.episodes)
            items.append(("found", f"{found} of {all_}", "raised hands in truth"))
            items.append(("invented", str(len(episodes.invented)), "false raises"))
            if episodes.position_error_m is not None:
                error = f"{episodes.position_error_m:.2f} m"
                items.append(("position error", error, "median, hand up"))
        return Facts(tuple(items))


def _trouble(problems: tuple[str, ...]) -> tuple[Part, ...]:
    if not problems:
        return (Text(("No problems with the recording.",)),)
    rows = tuple((problem,) for problem in problems)
    marked = frozenset(range(len(rows)))
    return (Table(("problems of the recording",), rows, marked=marked),)


def _gallery(pictures: tuple[Picture, ...]) -> tuple[Part, ...]:
    return (Gallery(pictures),) if pictures else ()


def _remarks(history: History, remarks: tuple[str, ...]) -> tuple[Part, ...]:
    notes = tuple((note, str(count)) for note, count in history.notes.items())
    parts: list[Part] = [Text(remarks)] if remarks else []
    if notes:
        parts.append(Table(("noted", "images"), notes, numeric=frozenset({1})))
    return tuple(parts)


def _people_table(history: History) -> Table:
    people = list(history.people.values())[:_PEOPLE_LISTED]
    hidden = len(history.people) + history.people_dropped - len(people)
    return Table(
        (
            "person", "first seen", "last seen", "hands up", "up for", "served for",
            "last x", "last y",
        ),
        tuple(_person_row(history, person) for person in people),
        numeric=frozenset(range(1, 8)),
        title="Everybody who was confirmed",
        caption=f"and {hidden} more, in tracks.csv" if hidden else "",
    )  # fmt: skip


def _person_row(history: History, person: Person) -> tuple[str, ...]:
    end_ns = history.end_ns or person.last_seen_ns
    up_s, served_s = (
        sum((end_ns if span.end_ns is None else span.end_ns) - span.start_ns for span in spans)
        / 1e9
        for spans in (person.hands, person.selected)
    )
    places = person.path.rows[-1:].tolist()
    x, y = (f"{value:.2f} m" for value in places[0]) if places else ("-", "-")
    return (
        f"#{person.id}",
        f"{history.seconds(person.first_seen_ns):.1f} s",
        f"{history.seconds(person.last_seen_ns):.1f} s",
        str(len(person.hands)),
        f"{up_s:.1f} s",
        f"{served_s:.1f} s",
        x,
        y,
    )
