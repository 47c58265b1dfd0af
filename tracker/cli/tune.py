"""`raised-hand tune`: search for the best parameters, and test them on other data."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tracker.cli.options import (
    ConfigOption,
    JobsOption,
    JsonOption,
    ParameterOption,
    ReportOption,
    check_is_no_folder,
    command_line,
    console,
    errors,
    parameter_files,
    parameters_from,
    print_files,
    print_json,
)
from tracker.config import Config
from tracker.errors import ConfigError, RecordingError
from tracker.evaluation.studies.executor import processes, workers
from tracker.outputs import check_inputs_stay
from tracker.terminal.progress import (
    bar,
    compile_tracker_first,
    fetch_models_if_needed,
    trials_bar,
)

if TYPE_CHECKING:
    from tracker.evaluation.tuning.objective import Objective
    from tracker.recording import Topics

_SCENES, _RECORDINGS = "Scenarios", "Recordings"


def tune_command(
    source: Annotated[
        str | None,
        typer.Argument(
            help="Name of a scenario, or a recording that `replay` can read. Without it, the "
            "scenarios and the parameters that can be tuned are listed."
        ),
    ] = None,
    params: Annotated[
        str | None,
        typer.Option(
            help="What to search, separated by commas: names of parameters, or process, "
            "measurement, clutter, life, method. Default: all except method, and on recordings "
            "also except life."
        ),
    ] = None,
    trials: Annotated[
        int,
        typer.Option(
            "--trials",
            "-n",
            help="Number of trials in all, including those of an earlier run.",
            min=1,
        ),
    ] = 200,
    storage: Annotated[
        str | None,
        typer.Option(help="Optuna storage, such as sqlite:///my.db. Default: tuning.db in --out."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of the scenes and of the search.", min=0)] = 1,
    config: ConfigOption = None,
    param: ParameterOption = None,
    jobs: JobsOption = 1,
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Folder for best.yaml, tuning.json and tuning.png.")
    ] = Path("tuning"),
    report: ReportOption = None,
    as_json: JsonOption = False,
    scenes: Annotated[
        int,
        typer.Option(help="Scenes that every trial runs.", min=1, rich_help_panel=_SCENES),
    ] = 6,
    scene_s: Annotated[
        float,
        typer.Option(help="Length of each scene, in seconds.", min=1.0, rich_help_panel=_SCENES),
    ] = 8.0,
    unseen: Annotated[
        int,
        typer.Option(
            help="Number of other scenes for the final test; no trial uses them.",
            min=2,
            rich_help_panel=_SCENES,
        ),
    ] = 40,
    image_topic: Annotated[
        str, typer.Option(help="Camera images.", rich_help_panel=_RECORDINGS)
    ] = "/image_raw",
    scan_topic: Annotated[
        str, typer.Option(help="LiDAR scans.", rich_help_panel=_RECORDINGS)
    ] = "/scan",
    camera_info_topic: Annotated[
        str, typer.Option(help="Intrinsics.", rich_help_panel=_RECORDINGS)
    ] = "/camera_info",
    tf_topic: Annotated[
        str, typer.Option(help="Moving transforms.", rich_help_panel=_RECORDINGS)
    ] = "/tf",
    tf_static_topic: Annotated[
        str, typer.Option(help="Lasting transforms.", rich_help_panel=_RECORDINGS)
    ] = "/tf_static",
) -> None:
    """Search for the best parameters for a scenario or for your own recording.

    On a scenario the truth is known, and less GOSPA is better. On a recording,
    it is better if the tracker predicts the next measurement well. The final test
    uses data that the search has not used: other scenes, or the rest of the
    recording.

    [bold]raised-hand tune cheap-lidar[/bold]   for a cheap laser

    [bold]raised-hand tune my_robot.mcap[/bold]   for your own robot

    [bold]raised-hand tune rough --params process,range_std_m -n 50[/bold]   only these parameters

    [bold]raised-hand tune rough -c robot.yaml -j 2[/bold]   from your own file, two processes

    Stop it with Ctrl-C; give the same command again to continue. best.yaml is a
    complete parameter file, for raised-hand replay -c tuning/best.yaml and for the node.
    """
    from tracker.evaluation.trials.scenario import SCENARIOS, default_config
    from tracker.evaluation.tuning.objective import scenario_objective
    from tracker.evaluation.tuning.search import check_optuna, tune
    from tracker.evaluation.tuning.space import DEFAULT_KINDS, choose_parameters
    from tracker.recording import Topics
    from tracker.report.studies.tuning_page import tuning_page
    from tracker.report.studies.tuning_table import (
        TUNING_FILES,
        parameters_table,
        verdict_table,
        write_tuning,
    )

    if source is None:
        _list()
        return
    check_optuna()
    is_scenario = source in SCENARIOS
    if not is_scenario and not Path(source).exists():
        raise ConfigError(
            f"{source}: is neither a scenario nor an existing recording; `raised-hand tune` "
            "alone lists the scenarios."
        )
    words = [word.strip() for word in params.split(",")] if params else DEFAULT_KINDS
    names = choose_parameters(words)
    default = default_config(SCENARIOS[source]) if is_scenario else None
    base = parameters_from(config, param, default)
    check_is_no_folder("--report", report)
    files = [out / name for name in (*TUNING_FILES, "tuning.db")]
    read = [None if is_scenario else Path(source), *parameter_files(config, base)]
    check_inputs_stay(read, [*files, report])
    _make_room(out)
    compile_tracker_first(errors)
    if is_scenario:
        objective = scenario_objective(
            source, seed=seed, parts=scenes, scene_s=scene_s, unseen=unseen
        )
    else:
        topics = Topics(
            image=image_topic,
            scan=scan_topic,
            camera_info=camera_info_topic,
            tf=tf_topic,
            tf_static=tf_static_topic,
        )
        objective = _recording(Path(source), base, topics)
    if not params:
        names = tuple(name for name in names if objective.judges(name))
    address = storage or f"sqlite:///{(out / 'tuning.db').resolve()}"
    try:
        verdict = 2 * unseen if is_scenario else None
        with (
            processes(jobs, trials) as executor,
            trials_bar(errors, trials, verdict) as (progress, judged),
        ):
            tuning = tune(
                objective,
                names,
                base,
                trials=trials,
                storage=address,
                seed=seed,
                jobs=workers(jobs, trials),
                executor=executor,
                progress=progress,
                judged=judged,
            )
    except KeyboardInterrupt:
        text = f"\nThe trials are in {address}; give the same command again to continue."
        errors.print(text, soft_wrap=True)
        raise
    written: tuple[Path, ...] = write_tuning(tuning, out)
    if report is not None:
        written = (*written, tuning_page(tuning, command=command_line()).write(report))
    if as_json:
        from tracker.evaluation.tuning.result import tuning_as_dict

        print_json(tuning_as_dict(tuning))
        return
    console.print(parameters_table(tuning))
    console.print(verdict_table(tuning))
    print_files(written)


def _recording(source: Path, base: Config, topics: Topics) -> Objective:
    from tracker.evaluation.recordings.tracker_steps import recorded_steps
    from tracker.evaluation.tuning.objective import RecordingObjective

    fetch_models_if_needed(errors)
    with bar(errors, "Measuring") as progress:
        steps = recorded_steps(source, base, topics=topics, progress=progress)
    return RecordingObjective(source.name, steps, base)


def _list() -> None:
    from rich.table import Table

    from tracker.evaluation.trials.scenario import SCENARIOS, PeopleScenario, ScanScenario
    from tracker.evaluation.tuning.space import tunable

    for name, item in SCENARIOS.items():
        if isinstance(item, (PeopleScenario, ScanScenario)):
            console.print(f"{name:<22}{item.title}", highlight=False, soft_wrap=True)
    table = Table("parameter", "kind", "default", "search")
    for name, search in tunable().items():
        kind = Config.model_fields[name].annotation
        where = ", ".join(getattr(kind, "__args__", ())) or f"{search.low:g} to {search.high:g}"
        table.add_row(name, search.kind, str(getattr(Config(), name)), where)
    console.print(table)


def _make_room(out: Path) -> None:
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RecordingError(f"{out}: cannot be made ({error.strerror}).") from error
