"""How does the judgement of a folder of photos and clips look in a terminal, and in files?"""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING

from tracker.evaluation.detection.clip_study import ClipStudy, clips_as_dict
from tracker.evaluation.detection.photo_study import PhotoStudy, Share, photos_as_dict
from tracker.outputs import writing_into
from tracker.report.detection.contact_sheet import draw_contact_sheet

PHOTO_FILES = ("evaluation.json", "photos.csv", "contact_sheet.png")

if TYPE_CHECKING:
    from rich.table import Table


def photo_tables(study: PhotoStudy) -> tuple[Table, ...]:
    """One line per photo with something missed or invented, then the totals."""
    from rich.table import Table

    photos = Table(title="Photos with a missed hand or a false raise", title_justify="left")
    photos.add_column("photo")
    for name in ("raised", "found", "false"):
        photos.add_column(name, justify="right")
    photos.add_column("why not")
    for item in study.photos:
        found, false = int(item.is_found.sum()), int(item.is_false.sum())
        if found < len(item.is_found) or false:
            why = ", ".join(dict.fromkeys(filter(None, item.reasons)))
            raised = str(len(item.is_found))
            photos.add_row(item.photo.path.name, raised, str(found), str(false), why)
    totals = Table(title=f"{len(study.photos)} photos", title_justify="left")
    totals.add_column("")
    for name in ("count", "share", "95 % interval"):
        totals.add_column(name, justify="right")
    for share in study.shares:
        totals.add_row(share.name, f"{share.count} of {share.total}", *_percents(share))
    for name, levels in study.shares_by.items():
        totals.add_section()
        for value, shares in levels.items():
            for share in shares:
                if share.total:
                    label = f"{name} {value}: {share.name}"
                    totals.add_row(label, f"{share.count} of {share.total}", *_percents(share))
    return (photos, totals) if photos.row_count else (totals,)


def clip_table(study: ClipStudy) -> Table:
    """One line per clip, then the totals."""
    from rich.table import Table

    table = Table(title=f"{len(study.clips)} clips", title_justify="left")
    table.add_column("clip")
    for name in ("calls", "raised in", "raises", "false", "identities", "delay s"):
        table.add_column(name, justify="right")
    for item in study.clips:
        delays = ["-" if math.isnan(delay) else f"{delay:.1f}" for delay in item.delays_s]
        table.add_row(
            item.clip.path.name,
            str(len(item.delays_s)),
            f"{item.images_raised} of {item.images_up}" if item.images_up else "",
            str(item.raises),
            str(item.false_raises),
            str(item.identities),
            ", ".join(delays),
        )
    count, idle_s = study.false_raises
    table.add_section()
    for share in study.shares:
        table.add_row(share.name, "", f"{share.count} of {share.total}", _percents(share)[0])
    rate = f"{count / idle_s * 3600.0:.0f} an hour" if idle_s else ""
    table.add_row(f"false raises in {idle_s:.0f} s without a call", "", "", rate, str(count))
    return table


def write_photos(
    study: PhotoStudy, folder: str | Path, clips: ClipStudy | None = None
) -> tuple[Path, ...]:
    """Write evaluation.json, photos.csv (a line per photo) and contact_sheet.png.

    Args:
        study: What was found.
        clips: What became of clips, if there are any; they go into evaluation.json.
        folder: Made where it is missing; what is there is replaced.

    Returns:
        The files; the contact sheet only where something was missed or invented.

    Raises:
        RecordingError: A file cannot be written, or a photo no longer read.
    """
    folder = Path(folder)
    document, table, picture = (folder / name for name in PHOTO_FILES)
    told = photos_as_dict(study)
    if clips is not None:
        told["clips"] = clips_as_dict(clips)
    with writing_into(folder) as new:
        new(document.name).write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
        with new(table.name).open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(told["photos"][0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(told["photos"])
        is_drawn = draw_contact_sheet(study, new(picture.name))
    return (document, table, picture) if is_drawn else (document, table)


def _percents(share: Share) -> tuple[str, str]:
    if share.total == 0:
        return "-", ""
    interval = f"{100 * share.low:.1f} % to {100 * share.high:.1f} %"
    return f"{100 * share.count / share.total:.1f} %", interval
