"""`raised-hand evaluate`: how many raised hands are found, in drawn scenes or your own photos?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tracker.cli.options import (
    ConfigOption,
    JobsOption,
    JsonOption,
    ParameterOption,
    console,
    errors,
    parameter_files,
    parameters_from,
    print_files,
    print_json,
)
from tracker.config import Config
from tracker.errors import ConfigError
from tracker.evaluation.studies.executor import processes
from tracker.outputs import check_inputs_stay
from tracker.terminal.progress import bar, compile_tracker_first, fetch_models_if_needed

_SCENES, _PHOTOS = "Drawn scenes", "Your own photos"


def evaluate_command(
    folder: Annotated[
        Path | None,
        typer.Argument(
            help="Folder of photos with a labels.csv, or a folder of such folders. Without it, "
            "drawn people are used."
        ),
    ] = None,
    episodes: Annotated[
        int,
        typer.Option(
            "--episodes",
            "-n",
            help="Number of raised hands, spread over the distances.",
            min=0,
            rich_help_panel=_SCENES,
        ),
    ] = 200,
    minutes_of_nobody: Annotated[
        int,
        typer.Option(
            help="Minutes of people who talk, drink, phone, scratch their heads, rest their hands "
            "or wave them low, but never call.",
            min=0,
            rich_help_panel=_SCENES,
        ),
    ] = 10,
    distances: Annotated[
        str,
        typer.Option(help="Distances of the people who call, in meters.", rich_help_panel=_SCENES),
    ] = "1,2,3,4,5",
    seed: Annotated[
        int,
        typer.Option(help="The same seed gives the same scenes.", min=0, rich_help_panel=_SCENES),
    ] = 1,
    jobs: JobsOption = 0,
    looks: Annotated[
        int,
        typer.Option(
            help="Show each photo this many times, ten per second and slightly changed. A hand "
            "counts if it is raised in two looks in a row. 1 judges only the photo itself.",
            min=1,
            rich_help_panel=_PHOTOS,
        ),
    ] = 25,
    config: ConfigOption = None,
    param: ParameterOption = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for the tables (JSON, CSV) and a picture."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Measure how many raised hands are found, and how often one is invented.

    Without a folder, drawn people are used. They vary in distance, skin, sleeve, hand, build,
    posture, light and blur, and go as pictures through the whole pipeline without LiDAR. A hand
    is found when its track is raised within 30 images. Drawn people test the search, the rule
    and the streaks; they say nothing about real people.

    With a folder, each of your photos is judged on its own against labels.csv:

        file,raised,x,y
        bar_01.jpg,1,412,187
        bar_01.jpg,1,88,240
        bar_02.jpg,0

    One row per raised hand, x and y (which may be left out) the pixel of its wrist; raised 0 for a
    photo in which nobody raises a hand. The contact sheet shows what was missed, why, and what was
    invented. attributes.csv (file and any columns, such as hand or light) breaks the figures down.
    Videos in clips/ are judged against clips/episodes.csv, a row for each raised hand:

        clip,start_s,end_s
        waiter_1.mp4,2.0,9.5
        lunch.mp4,,

    [bold]Examples[/bold]

        raised-hand evaluate --out evaluation

        raised-hand evaluate --episodes 500 --distances 2,3.5 --minutes-of-nobody 0

        raised-hand evaluate my_photos --out evaluation -p model_complexity:=1
    """
    from tracker.report.detection.detection_table import SCENE_FILES
    from tracker.report.detection.photo_table import PHOTO_FILES

    # One thread for each of the processes; more would only get into each other's way.
    settings = parameters_from(config, param, Config(inference_threads=1))
    if out is not None:
        names = SCENE_FILES if folder is None else PHOTO_FILES
        check_inputs_stay(
            [folder, *parameter_files(config, settings)], [out / name for name in names]
        )
    if folder is not None:
        _evaluate_photos(folder, settings, looks, out, as_json)
        return
    distances_m = _distances(distances)
    _evaluate_scenes(
        settings, episodes, minutes_of_nobody, seed, distances_m, jobs, out, as_json
    )  # fmt: skip


def _evaluate_scenes(
    config: Config,
    episodes: int,
    minutes: int,
    seed: int,
    distances_m: list[float],
    jobs: int,
    out: Path | None,
    as_json: bool,
) -> None:
    from tracker.evaluation.detection.figures import detection_as_dict
    from tracker.evaluation.detection.study import study_detection
    from tracker.report.detection.detection_table import false_table, recall_table, write_detection

    fetch_models_if_needed(errors)
    compile_tracker_first(errors)
    with processes(jobs, episodes + minutes) as executor, bar(errors, "Evaluating") as progress:
        study = study_detection(
            episodes,
            minutes,
            seed,
            config,
            distances_m=distances_m,
            executor=executor,
            progress=lambda share: progress(share, 0),
        )
    files = write_detection(study, out) if out is not None else ()
    if as_json:
        print_json(detection_as_dict(study))
        return
    if study.episodes:
        console.print(recall_table(study))
    if study.minutes:
        console.print(false_table(study))
    print_files(files)


def _evaluate_photos(
    folder: Path, config: Config, looks: int, out: Path | None, as_json: bool
) -> None:
    from tracker.evaluation.detection.clip_study import clips_as_dict, read_clips, study_clips
    from tracker.evaluation.detection.photo_labels import read_photos
    from tracker.evaluation.detection.photo_study import photos_as_dict, study_photos
    from tracker.perception import open_detector
    from tracker.report.detection.photo_table import clip_table, photo_tables, write_photos

    photos, labeled_clips = read_photos(folder), read_clips(folder)
    fetch_models_if_needed(errors)
    with bar(errors, "Judging photos") as progress:
        study = study_photos(photos, open_detector(config), looks=looks, progress=progress)
    with bar(errors, "Judging clips") as progress:
        clips = study_clips(
            labeled_clips,
            config,
            progress=lambda number: progress(number / len(labeled_clips), number),
        )
    files = write_photos(study, out, clips) if out is not None else ()
    if as_json:
        print_json({**photos_as_dict(study), "clips": clips_as_dict(clips)})
        return
    for table in photo_tables(study):
        console.print(table)
    if clips.clips:
        console.print(clip_table(clips))
    print_files(files)


def _distances(text: str) -> list[float]:
    try:
        return [float(item) for item in text.split(",")]
    except ValueError as error:
        raise ConfigError(
            f"--distances is {text!r}; expected meters separated by commas, such as 1,2.5,4."
        ) from error
