"""Harm recordings of every kind and kill writers; exit 1 if anything is lost outside the damage.

python -m benchmarks.faults                              all of it, under ten minutes
python -m benchmarks.faults --tries 42 --files-alone     a small part, without bombs and writers
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from benchmarks.faults.attempt import Outcome, attempt, read
from benchmarks.faults.bombs import bombs
from benchmarks.faults.harm import HARMS, Harm
from benchmarks.faults.recordings import Message, Spans, kinds, simulated, write_mcap
from benchmarks.faults.table import Row, as_text
from benchmarks.faults.writers import (
    complaints_about,
    kill_when_grown,
    replay_words,
    simulate_words,
    small_disk,
)

_SEED = 13


def main() -> None:
    """Run, print the table, exit."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tries", type=int, default=840, help="harmed recordings, of all kinds")
    parser.add_argument("--files-alone", action="store_true", help="no bombs, no writers")
    asked = parser.parse_args()
    os.environ["OPENCV_FFMPEG_LOGLEVEL"] = "-8"
    with tempfile.TemporaryDirectory(prefix="faults_") as name:
        folder = Path(name)
        messages = simulated(folder)
        count = len(kinds())
        tries = asked.tries // count or 1
        harm = partial(_harm, folder, messages, tries)
        with ProcessPoolExecutor(2, mp_context=get_context("fork")) as workers:
            rows = list(workers.map(harm, range(count)))
        if not asked.files_alone:
            rows.append(_explode(folder, messages))
            write_mcap()(folder / "source.mcap", simulated(folder, seconds=6.0))
            rows += [_kill(folder), _fill(folder)]
    print(as_text(rows))
    for row in rows:
        for finding in row.findings:
            print(f"\n{row.kind}: {finding}", file=sys.stderr)
    sys.exit(any(row.is_violated for row in rows))


def _harm(folder: Path, messages: list[Message], tries: int, number: int) -> Row:
    kind, rng = kinds()[number], np.random.default_rng([_SEED, number])
    whole, path = (folder / f"{name}_{number}" / kind.file for name in ("whole", "harmed"))
    for place in (whole, path):
        place.parent.mkdir()
    kind.write(whole, messages)
    spans = kind.spans(whole) if kind.spans is not None else None
    expected = set(attempt(partial(read, whole)).keys)
    row = Row(kind.name)
    for attempted in range(tries):
        harm = HARMS[attempted % len(HARMS)]
        file, first, last = _harmed_copy(whole, path, harm, rng)
        outcome = attempt(partial(read, path))
        lost = _lost_beyond(spans, first, last, outcome) if spans is not None else None
        must_say = kind.is_told and not expected <= set(outcome.keys)
        how = f"{harm.__name__} of {file} at {first}"
        row.add(outcome, expected, lost, how, must_say=must_say)
    return row


def _harmed_copy(
    whole: Path, path: Path, harm: Harm, rng: np.random.Generator
) -> tuple[str, int, int]:
    """The recording again, with one of its files harmed; which, and where."""
    shutil.rmtree(path, ignore_errors=True)
    path.unlink(missing_ok=True)
    if whole.is_dir():
        shutil.copytree(whole, path)
        files = sorted(path.iterdir())
        file = files[int(rng.integers(len(files)))]
        source = whole / file.name
    else:
        file, source = path, whole
    content, first, last = harm(source.read_bytes(), rng)
    file.write_bytes(content)
    return file.name, first, last


def _lost_beyond(spans: Spans, first: int, last: int, outcome: Outcome) -> int:
    read_keys = set(outcome.keys)
    return sum(
        (end <= first or begin >= last) and key not in read_keys
        for key, begin, end in zip(*spans, strict=True)
    )


def _explode(folder: Path, messages: list[Message]) -> Row:
    row, expected = Row("bombs"), {(item.topic, item.log_ns) for item in messages}
    place = folder / "bombs"
    place.mkdir()
    for name, path in bombs(place, messages):
        outcome = attempt(partial(read, path))
        lost = None
        if path.suffix == ".mcap":
            lost = len(expected - set(outcome.keys))
        row.add(outcome, set(outcome.keys), lost, name, must_say=True)
    return row


def _kill(folder: Path) -> Row:
    row, source, out = Row("writers killed"), folder / "source.mcap", folder / "killed"
    for size in (1_800_000, 2_800_000):
        shutil.rmtree(out, ignore_errors=True)
        if kill_when_grown(replay_words(source, out), out / "output.mcap", size):
            row.judge("; ".join(complaints_about(out)), f"replay at {size} bytes")
    shutil.rmtree(out, ignore_errors=True)
    subprocess.run(replay_words(source, out), check=True)
    before = {file: file.read_bytes() for file in out.iterdir()}
    for size in (1_800_000, 2_800_000):
        if kill_when_grown(replay_words(source, out), out / "output.part.mcap", size):
            changed = [file.name for file, old in before.items() if file.read_bytes() != old]
            complaints = complaints_about(out, ".part") + [f"{name} changed" for name in changed]
            row.judge("; ".join(complaints), f"second replay at {size} bytes")
    for size in (4_000_000, 9_000_000):
        path = folder / "killed.mcap"
        path.unlink(missing_ok=True)
        kill_when_grown(simulate_words(path), path, size)
        outcome = attempt(partial(read, path))
        row.judge("" if outcome.keys else outcome.said or "nothing is left", f"simulate at {size}")
    return row


def _fill(folder: Path) -> Row:
    row, source = Row("disk full"), folder / "source.mcap"
    for megabytes in (1, 2, 3):
        with small_disk(folder / f"disk_{megabytes}", megabytes) as disk:
            if disk is None:
                row.note = "not run: no disk can be mounted here"
                return row
            for name, words in (
                ("replay", replay_words(source, disk / "out")),
                ("simulate", simulate_words(disk / "a.mcap")),
            ):
                done = subprocess.run(words, capture_output=True, text=True, check=False)
                said = done.stderr.strip().splitlines()[-1:] or [""]
                wrong = "" if "make room on the disk" in said[0] else done.stderr[-600:]
                wrong = done.stderr[-600:] if "Traceback" in done.stderr else wrong
                row.judge(wrong if done.returncode else "status 0", f"{name}, {megabytes} MB")
                for file in disk.glob("*.mcap"):
                    file.unlink()
    return row


if __name__ == "__main__":
    main()
