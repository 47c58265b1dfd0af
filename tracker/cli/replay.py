"""`raised-hand replay`: run the tracker on a recording, as on the robot."""

from __future__ import annotations

import sys
import threading
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from tracker.cli.options import (
    ConfigOption,
    JsonOption,
    ParameterOption,
    ReportOption,
    check_is_no_file,
    check_is_no_folder,
    command_line,
    complain,
    console,
    errors,
    note,
    parameter_files,
    parameters_from,
    print_files,
    print_json,
)
from tracker.errors import ConfigError
from tracker.outputs import check_inputs_stay
from tracker.terminal.progress import bar, compile_tracker_first, fetch_models_if_needed
from tracker.wording import counted


def replay_command(
    source: Annotated[
        Path,
        typer.Argument(
            help="A rosbag2 folder, .mcap, .db3, ROS 1 .bag, a video, or a folder of photos. "
            "Without LiDAR and depth, ranges are only estimated from the size of hands."
        ),
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the output files.")] = Path(
        "out"
    ),
    config: ConfigOption = None,
    param: ParameterOption = None,
    image_topic: Annotated[str, typer.Option(help="Camera images.")] = "/image_raw",
    scan_topic: Annotated[str, typer.Option(help="LiDAR scans.")] = "/scan",
    camera_info_topic: Annotated[str, typer.Option(help="Intrinsics.")] = "/camera_info",
    depth_topic: Annotated[str, typer.Option(help="Depth images.")] = "/depth",
    depth_camera_info_topic: Annotated[
        str, typer.Option(help="Intrinsics of a depth camera that is not registered.")
    ] = "/depth_camera_info",
    tf_topic: Annotated[str, typer.Option(help="Moving transforms.")] = "/tf",
    tf_static_topic: Annotated[str, typer.Option(help="Lasting transforms.")] = "/tf_static",
    map_topic: Annotated[str, typer.Option(help="The map of the room.")] = "/map",
    room_map: Annotated[
        Path | None,
        typer.Option("--map", help="map_server's YAML file, used instead of the recording's map."),
    ] = None,
    stamps: Annotated[
        str,
        typer.Option(
            help="Which time is used: `header` (the sensor's stamp) or `log` (the time "
            "of recording)."
        ),
    ] = "header",
    report: ReportOption = None,
    view: Annotated[
        bool, typer.Option("--view", help="Watch live in Rerun's viewer (extra `view`).")
    ] = False,
    save_view: Annotated[
        Path | None, typer.Option(help="Write a recording for Rerun's viewer: an .rrd file.")
    ] = None,
    serve: Annotated[
        bool, typer.Option("--serve", help="Watch on a page in the browser (extra `live`).")
    ] = False,
    port: Annotated[
        int, typer.Option(help="Port for --serve; 0 means any free port.", min=0, max=65535)
    ] = 8750,
    as_json: JsonOption = False,
) -> None:
    """Run the tracker on a recording, exactly as on the robot.

    Writes output.mcap (for Foxglove, RViz, ros2 bag play), tracks.csv, summary.json, overview.png
    and debug.mp4. A recording that is cut off is replayed as far as it can be read; the exit
    status is then 1.
    """
    from tracker.dashboard import Dashboard, DashboardServer
    from tracker.recording import Topics, load_map
    from tracker.replay import Watcher, replay
    from tracker.replay.outputs import replay_files
    from tracker.report.replay.replay_page import ReplayReport
    from tracker.report.replay.summary import summary_table
    from tracker.report.video.rerun_view import RerunView

    if stamps not in ("header", "log"):
        raise ConfigError(f"--stamps is {stamps!r}; allowed is header or log.")
    parameters = parameters_from(config, param)
    if not source.exists():
        raise ConfigError(f"{source}: there is no such file or folder.")
    check_is_no_file("--out", out)
    check_is_no_folder("--report", report)
    check_is_no_folder("--save-view", save_view)
    grid = None if room_map is None else load_map(room_map)
    check_inputs_stay(
        [source, *parameter_files(config, parameters)], [*replay_files(out), report, save_view]
    )
    fetch_models_if_needed(errors)
    compile_tracker_first(errors)
    watched = ReplayReport(parameters) if report is not None else None
    watchers: list[Watcher] = [watched.watch] if watched is not None else []
    topics = Topics(
        image=image_topic,
        scan=scan_topic,
        camera_info=camera_info_topic,
        tf=tf_topic,
        tf_static=tf_static_topic,
        map=map_topic,
        depth=depth_topic,
        depth_camera_info=depth_camera_info_topic,
    )
    viewer, said = None, ""
    with ExitStack() as stack:
        if view or save_view is not None:
            viewer = stack.enter_context(RerunView(live=view, save=save_view))
            watchers.append(viewer.watch)
            said = viewer.trouble
            if said:
                complain(f"--view: {viewer.trouble}")
        if serve:
            dashboard = Dashboard(parameters, str(source))
            server = stack.enter_context(DashboardServer(dashboard, port=port))
            watchers.append(dashboard.watch)
            note(f"the page: {server.url}")
        progress = stack.enter_context(bar(errors, "Replaying"))
        result = replay(
            source,
            out,
            parameters,
            topics=topics,
            stamps=stamps,
            room_map=grid,
            progress=progress,
            watchers=watchers,
        )
        if serve:
            _wait_for_interrupt()
    if viewer is not None and viewer.trouble != said:  # while it was watched
        complain(f"--view: {viewer.trouble}")
    files = (*result.files, *([save_view] if save_view is not None else []))
    if report is not None and watched is not None:
        page = watched.page(
            str(source),
            result.history,
            result.episodes,
            overview=out / "overview.png",
            problems=result.problems,
            remarks=result.remarks,
            command=command_line(),
        )
        files = (*files, page.write(report))
    if as_json:
        print_json(result.summary)
    else:
        table = summary_table(result.history)
        images = counted(result.history.frames_processed, "image")
        console.print(table if table.row_count else f"Nobody raised a hand in {images}.")
        print_files(files)
    for remark in result.remarks:
        note(remark)
    for problem in result.problems:
        complain(problem)
    has_trouble = viewer is not None and viewer.trouble
    if result.problems or has_trouble:
        sys.exit(1)


def _wait_for_interrupt() -> None:
    """Keep the page open after the replay, until Ctrl-C."""
    note("replay done; the page stays open until Ctrl-C")
    try:
        threading.Event().wait()
    except KeyboardInterrupt:
        pass
