"""`raised-hand monte-carlo`: many noisy trials of the tracker, against bounds and truth."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from tracker.cli.jobs import JobsOption, processes
from tracker.cli.options import (
    ConfigOption,
    JsonOption,
    ParameterOption,
    console,
    errors,
    parameters_from,
    print_files,
    print_json,
)
from tracker.cli.progress import bar
from tracker.errors import ConfigError


def monte_carlo_command(
    scenario: Annotated[
        str | None, typer.Argument(help="Name of a scenario; none lists those there are.")
    ] = None,
    trials: Annotated[int, typer.Option("--trials", "-n", help="How many.", min=1)] = 100,
    seed: Annotated[
        int, typer.Option(help="Trial i of a seed is the same in every study.", min=0)
    ] = 1,
    config: ConfigOption = None,
    param: ParameterOption = None,
    paths: Annotated[
        Path | None,
        typer.Option(help="CSV of real people's paths (t_s, id, x_m, y_m) to walk along."),
    ] = None,
    jobs: JobsOption = 0,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for study.json, trials.csv and study.png."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Run many noisy trials, and hold the tracker against the truth and against what is possible.

    Filter scenarios (model-matched, outliers) print RMSE over the Cramer-Rao bound and NEES;
    known-people those of several who have to be told apart, and how often they were not; the
    others run the whole tracker and print GOSPA, identity switches, times to raise and more. The
    scenario's own settings hold unless --config or -p says otherwise.
    """
    from tracker.evaluation.monte_carlo import find_scenario, monte_carlo
    from tracker.evaluation.scenario import (
        SCENARIOS,
        FilterScenario,
        PeopleScenario,
        default_config,
    )
    from tracker.evaluation.study import study_as_dict
    from tracker.report.study_table import study_table, write_study

    if scenario is None:
        for name, item in SCENARIOS.items():
            console.print(f"{name:<22}{item.title}", highlight=False, soft_wrap=True)
        return
    _, chosen = find_scenario(scenario)
    if paths is not None:
        if not isinstance(chosen, PeopleScenario):
            raise ConfigError(f"--paths: the scenario {scenario} has no people who walk.")
        chosen = replace(chosen, recording=str(paths))
    settings = parameters_from(config, param, default_config(chosen))
    alone = isinstance(chosen, FilterScenario)
    with processes(1 if alone else jobs, trials) as executor, bar(errors, "Running") as progress:
        study = monte_carlo(
            chosen,
            trials,
            seed,
            settings,
            executor=executor,
            progress=lambda share: progress(share, 0),
        )
    study = replace(study, name=scenario)
    files = write_study(study, out) if out is not None else ()
    if as_json:
        print_json(study_as_dict(study))
    else:
        console.print(study_table(study))
        print_files(files)
