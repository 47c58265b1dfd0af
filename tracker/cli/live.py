"""`raised-hand live`: a camera, a stream, or a scene as if live, and the page that shows it."""

from __future__ import annotations

from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Annotated

import typer

from tracker.cli.options import (
    ConfigOption,
    ParameterOption,
    check_is_no_folder,
    console,
    errors,
    note,
    parameters_from,
)
from tracker.errors import ConfigError
from tracker.terminal.progress import fetch_models_if_needed, telling
from tracker.wording import counted

#: The port of the page where nobody names another one.
_PORT = 8750


def live_command(
    source: Annotated[
        str | None,
        typer.Argument(
            help="A camera's number (0 by default), a device such as /dev/video0, an address such "
            "as rtsp://..., a GStreamer pipeline that ends in `appsink`, or a recording or "
            "video, which is played as if it were live."
        ),
    ] = None,
    simulated: Annotated[
        bool, typer.Option("--simulated", help="Show a simulated scene instead of a camera.")
    ] = False,
    scene: Annotated[
        str, typer.Option(help="Scene for --simulated: a name from config/scenes, or a YAML file.")
    ] = "restaurant",
    record: Annotated[
        Path | None, typer.Option(help="Record into this .mcap file, for `raised-hand replay`.")
    ] = None,
    host: Annotated[
        str,
        typer.Option(
            help="Address on which the page is served. With 0.0.0.0, other "
            "computers can open it; they need the token in the printed "
            "address."
        ),
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(help="Port of the page; 0 means any free port.", min=0, max=65535)
    ] = _PORT,
    page: Annotated[bool, typer.Option("--page/--no-page", help="Serve the page.")] = True,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in a browser.")
    ] = True,
    config: ConfigOption = None,
    param: ParameterOption = None,
) -> None:
    r"""Watch a camera live: who raises a hand, who waits, on a page in the browser.

    Ends with Ctrl-C, or at the end of a recording. The page needs the extra `live`: in the
    project's folder, pip install ".\[live]".
    """
    import webbrowser

    from tracker.dashboard import Dashboard, DashboardServer
    from tracker.live.run import run_live
    from tracker.live.sources import live_events, paced, simulated_events
    from tracker.live.steering import PipelineSteering
    from tracker.live.teller import Teller
    from tracker.pipeline import Pipeline
    from tracker.recording import Topics
    from tracker.tracking.machine_frame import begin_compiling

    parameters = parameters_from(config, param)
    check_is_no_folder("--record", record)
    if record is not None and record.suffix.lower() != ".mcap":
        raise ConfigError(f"--record is {record}; expected a name that ends in .mcap.")
    if simulated and source is not None:
        raise ConfigError(
            f"--simulated uses no camera: leave out {source}, or leave out --simulated to use it. "
            "Another scene is named with --scene, such as --scene bistro."
        )
    source = source or "0"
    title = f"simulated: {scene}" if simulated else f"camera {source}"
    with ExitStack() as held:
        if simulated:
            events = paced(simulated_events(scene, 1, parameters.processing_rate))
        else:
            frame = parameters.fixed_frame
            events = held.enter_context(live_events(source, Topics(), note, frame))
        fetch_models_if_needed(errors)
        begin_compiling(telling(errors), telling(errors))  # frames do not wait for it
        pipeline = Pipeline(parameters)
        dashboard = Dashboard(parameters, title, PipelineSteering(pipeline))
        if page:
            server = held.enter_context(DashboardServer(dashboard, host, port))
            console.print(f"Page: {server.url}  (Ctrl-C ends it)", highlight=False)
            if browser:
                webbrowser.open(server.url)
        teller = Teller(lambda text: console.print(text, highlight=False))
        with suppress(KeyboardInterrupt):  # the ordinary end
            run_live(events, pipeline, watchers=[dashboard.watch, teller.watch], record=record)
    console.print(f"{counted(teller.frames, 'image')} seen.")
