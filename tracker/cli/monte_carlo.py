"""`raised-hand monte-carlo`: many simulated trials of the tracker, compared with the truth."""

from __future__ import annotations

from dataclasses import replace
from enum import Enum
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from tracker.cli.options import (
    ConfigOption,
    ExecutorOption,
    JobsOption,
    JsonOption,
    ParameterOption,
    ReportOption,
    check_is_no_folder,
    command_line,
    console,
    errors,
    parameters_from,
    print_files,
    print_json,
)
from tracker.errors import ConfigError
from tracker.evaluation.studies.executor import open_executor
from tracker.outputs import check_inputs_stay
from tracker.terminal.progress import compile_tracker_first, counting_bar


class TableFormat(str, Enum):
    """How the table of trials is written."""

    CSV = "csv"
    PARQUET = "parquet"


def monte_carlo_command(
    scenario: Annotated[
        str | None,
        typer.Argument(help="Name of a scenario. Without it, the scenarios are listed."),
    ] = None,
    trials: Annotated[int, typer.Option("--trials", "-n", help="Number of trials.", min=1)] = 100,
    seed: Annotated[
        int,
        typer.Option(
            help="Seed of the random numbers. Trial i of a seed is the same in every study.", min=0
        ),
    ] = 1,
    config: ConfigOption = None,
    param: ParameterOption = None,
    paths: Annotated[
        Path | None,
        typer.Option(help="CSV of real people's paths (t_s, id, x_m, y_m) to walk along."),
    ] = None,
    executor: ExecutorOption = "processes",
    jobs: JobsOption = 0,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="Folder for study.json, trials.csv and study.png. Trials are written as they "
            "finish. To continue a stopped study, give the same command again.",
        ),
    ] = None,
    format: Annotated[
        TableFormat,
        typer.Option(help="parquet: also write trials.parquet when all trials are done."),
    ] = TableFormat.CSV,
    report: ReportOption = None,
    as_json: JsonOption = False,
) -> None:
    """Run many simulated trials, and compare the tracker with the truth.

    Filter scenarios (model-matched, outliers) print the error divided by the Cramer-Rao bound, and
    the NEES. known-people prints how often known people are confused. The others run the whole
    tracker and print GOSPA, identity switches, times to raise and more. docs/studies.md says what
    each figure means and what is good. --config and -p replace the scenario's own parameters.
    """
    from tracker.evaluation.studies.monte_carlo import (
        find_scenario,
        monte_carlo,
        worthwhile_workers,
    )
    from tracker.evaluation.studies.study import study_as_dict
    from tracker.evaluation.studies.study_log import LOG_FILES
    from tracker.evaluation.trials.scenario import (
        SCENARIOS,
        PeopleScenario,
        ScanScenario,
        default_config,
    )
    from tracker.report.studies.study_page import study_page
    from tracker.report.studies.study_table import (
        STUDY_FILES,
        study_table,
        write_parquet,
        write_study,
    )

    if scenario is None:
        for name, item in SCENARIOS.items():
            console.print(f"{name:<22}{item.title}", highlight=False, soft_wrap=True)
        return
    check_is_no_folder("--report", report)
    names = (*LOG_FILES, *STUDY_FILES) if out is not None else ()
    check_inputs_stay([config, paths], [*((out or Path()) / name for name in names), report])
    _, chosen = find_scenario(scenario)
    if paths is not None:
        if not isinstance(chosen, PeopleScenario):
            raise ConfigError(f"--paths: the scenario {scenario} has no walking people.")
        chosen = replace(chosen, recording=str(paths))
    if format is TableFormat.PARQUET:
        _check_parquet(out)
    settings = parameters_from(config, param, default_config(chosen))
    if isinstance(chosen, (PeopleScenario, ScanScenario)):
        compile_tracker_first(errors)
    useful = worthwhile_workers(chosen, trials)
    try:
        with (
            open_executor(executor, jobs, useful) as crew,
            counting_bar(errors, "trial", trials) as count,
        ):
            study = monte_carlo(
                chosen,
                trials,
                seed,
                settings,
                executor=crew,
                progress=lambda share: count(round(share * trials)),
                folder=out,
            )
    except KeyboardInterrupt:
        if out is not None:
            text = f"\nThe trials are in {out}; give the same command again to continue."
            errors.print(text, soft_wrap=True)
        raise
    study = replace(study, name=scenario)
    files: tuple[Path, ...] = ()
    if out is not None:
        files = (out / "trials.csv", *write_study(study, out))
    if out is not None and format is TableFormat.PARQUET:
        files = (*files, write_parquet(study, out))
    if report is not None:
        files = (*files, study_page(study, command=command_line()).write(report))
    if as_json:
        print_json(study_as_dict(study))
    else:
        console.print(study_table(study))
        print_files(files)


def _check_parquet(out: Path | None) -> None:
    """Fail before hours of work, not after."""
    if out is None:
        raise ConfigError("--format parquet: needs a folder for the file: --out FOLDER.")
    if find_spec("pyarrow") is None:
        raise ConfigError(
            "--format parquet: needs pyarrow: pip install '.[cluster]' in the project's folder."
        )
