"""The command `raised-hand-dds`: the node `hand_detector` on Cyclone DDS, without ROS.

The same topics, services, parameters and diagnostics as the rclpy node; ROS 2's tools on the
network see one of theirs.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from nodes.dds.endpoints import Subscription
from nodes.dds.links import LinkWatch
from nodes.dds.names import Names
from nodes.dds.node import Node
from nodes.dds.parameters import ParameterServer
from nodes.dds.profiles import CLOCK, ROSOUT
from nodes.shared.core import NodeCore
from nodes.shared.diagnostics import REPORT_PERIOD_S
from nodes.shared.qos import PROFILES
from nodes.shared.topics import (
    ENABLE_SERVICE,
    OUTPUT_TYPES,
    RELEASE_SERVICE,
    RESET_SERVICE,
    Input,
    InputTopic,
    input_topics,
)
from tracker.config import NODE_NAME, Config
from tracker.errors import ConfigError, TrackerError
from tracker.messages import Encoded
from tracker.messages.parts import header
from tracker.messages.types import build, deserialize, serialize
from tracker.parameters.retired import without_retired
from tracker.parameters.ros_file import is_ours, read_assignment, read_parameters
from tracker.terminal.command_help import VersionOption, help_of
from tracker.terminal.program import run_program

_LOG_TYPE = "rcl_interfaces/msg/Log"
_CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
_LEVELS = {"info": 20, "warning": 30, "error": 40}


class DdsHandDetector:
    """The node: a `NodeCore` on a `Node`.

    Args:
        config: Every parameter.
        namespace: The node's.
        remaps: Rules `from:=to`.
        use_sim_time: Use the time from /clock.
        remarks: Warnings that its log begins with.

    Raises:
        ConfigError: A name or a variable of the environment is none, or DDS cannot start.
        ModelFileError: The hand models are not there.
    """

    def __init__(
        self,
        config: Config,
        *,
        namespace: str = "/",
        remaps: Iterable[str] = (),
        use_sim_time: bool = False,
        remarks: Iterable[str] = (),
    ) -> None:
        self._sim_ns = 0
        self._use_sim_time = use_sim_time
        self._node = Node(
            NODE_NAME,
            namespace=namespace,
            remaps=remaps,
            complain=lambda text: self._log("warning", text),
        )
        self._rosout = self._node.publisher("/rosout", _LOG_TYPE, ROSOUT)
        for remark in remarks:
            self._log("warning", remark)
        self._publishers = {
            output: self._node.publisher(output.value, type_name, PROFILES[output])
            for output, type_name in OUTPUT_TYPES.items()
        }
        inputs = input_topics(config)
        links = LinkWatch(
            self._node, {item: self._subscribe(item, topic) for item, topic in inputs.items()}
        )
        self._core = NodeCore(
            config,
            publish=lambda output, message: self._publishers[output].publish(message.cdr),
            has_subscribers=lambda output: self._publishers[output].subscribers > 0,
            log=self._log,
            now_ns=self._now_ns,
            topic_names={
                item: self._node.names.resolve(topic.name) for item, topic in inputs.items()
            },
            links=links.report,
            node_name=self._node.names.full_node_name,
        )
        if use_sim_time:
            self._node.subscribe("/clock", _CLOCK_TYPE, self._take_clock, CLOCK)
        self._serve()
        ParameterServer(
            self._node,
            lambda: self._core.config,
            self._core.configure,
            use_sim_time=use_sim_time,
            now_ns=self._now_ns,
        )
        self._spinner = threading.Thread(target=self._node.spin, name="dds", daemon=True)

    def run(self, stop: threading.Event) -> bool:
        """Work until `stop` is set, then leave in order.

        Returns:
            Whether all went well; else a thread died by a mistake that it has printed.
        """
        self._core.start()
        self._spinner.start()
        self._log("info", f"{self._node.names.full_node_name} is running, without ROS.")
        went_well = True
        while went_well and not stop.wait(REPORT_PERIOD_S):
            self._core.diagnose()
            went_well = self._core.is_alive and self._spinner.is_alive()
        self._core.stop()
        self._node.stop()
        self._spinner.join()
        self._node.close()
        return went_well

    def _subscribe(self, item: Input, topic: InputTopic) -> Subscription:
        def take(cdr: bytes) -> None:
            self._core.receive(item, Encoded(topic.type_name, cdr))

        return self._node.subscribe(topic.name, topic.type_name, take, PROFILES[item])

    def _serve(self) -> None:
        def release(_: Any) -> Any:
            success, message = self._core.release()
            return _trigger(success, message)

        def reset(_: Any) -> Any:
            self._core.reset("as asked by ~/reset")
            return _trigger(True, "everybody is forgotten")

        def enable(request: Any) -> Any:
            message = self._core.enable(bool(request.data))
            return build("std_srvs/srv/SetBool_Response", success=True, message=message)

        self._node.serve(*RELEASE_SERVICE, release)
        self._node.serve(*RESET_SERVICE, reset)
        self._node.serve(*ENABLE_SERVICE, enable)

    def _now_ns(self) -> int:
        return self._sim_ns if self._use_sim_time else time.time_ns()

    def _take_clock(self, cdr: bytes) -> None:
        try:
            now = deserialize(_CLOCK_TYPE, cdr).clock
        except TrackerError:  # the next one comes at once
            return
        before_ns, self._sim_ns = self._sim_ns, now.sec * 1_000_000_000 + now.nanosec
        if self._sim_ns < before_ns:
            self._core.reset(f"/clock jumped back by {(before_ns - self._sim_ns) / 1e9:.3f} s")

    def _log(self, level: str, text: str) -> None:
        now_ns = time.time_ns()
        name = self._node.names.full_node_name.lstrip("/").replace("/", ".")
        print(f"[{level.upper()}] [{now_ns / 1e9:.3f}] [{name}]: {text}", file=sys.stderr)
        said = build(
            _LOG_TYPE,
            stamp=header(now_ns, "").stamp,
            level=_LEVELS[level],
            name=name,
            msg=text,
        )
        self._rosout.publish(serialize(said).cdr)


def command(
    params_file: Annotated[
        list[Path] | None,
        typer.Option(
            "--params-file",
            metavar="FILE",
            help="ROS parameter file, such as config/hand_detector.yaml. May be repeated.",
        ),
    ] = None,
    param: Annotated[
        list[str] | None,
        typer.Option(
            "--param",
            "-p",
            metavar="SETTING",
            help="Set one parameter: -p processing_rate:=8.0. May be repeated.",
        ),
    ] = None,
    remap: Annotated[
        list[str] | None,
        typer.Option(
            "--remap",
            "-r",
            metavar="FROM:=TO",
            help="Remap one name: -r image_raw:=/camera/image_raw. May be repeated.",
        ),
    ] = None,
    namespace: Annotated[str, typer.Option(help="Namespace of the node and of its topics.")] = "/",
    use_sim_time: Annotated[
        bool, typer.Option("--use-sim-time", help="Use the time from /clock.")
    ] = False,
    ros_args: Annotated[
        bool,
        typer.Option("--ros-args", help="Accepted because ROS 2 tools pass it; it has no effect."),
    ] = False,
    version: VersionOption = False,
) -> None:
    """Run the node `hand_detector` without ROS: cameras and scanners in, customers out.

    Listens to image_raw (sensor_msgs/Image; CompressedImage with -p image_transport:=compressed),
    scan, depth (compressedDepth with -p depth_transport:=compressed), camera_info,
    depth_camera_info, map, /tf and /tf_static. Publishes hand_raised, customer_pose,
    hand_detection_debug, ~/tracks, ~/markers, ~/gesture, ~/approach_pose, ~/raised_hands,
    ~/waiting_list and /diagnostics; follows ~/command with an ~/answer; answers
    ~/release_customer, ~/enable, ~/reset and ROS 2's parameter services.

    Other nodes, with ROS or without, are met as ROS 2 does: by ROS_DOMAIN_ID,
    ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_STATIC_PEERS and CYCLONEDDS_URI.

    To try it on one machine, in three terminals: raised-hand-dds; raised-hand play recording.mcap;
    raised-hand echo /hand_raised. The demo's recording holds compressed pictures, which are heard
    with -p image_transport:=compressed.
    """
    from rich.console import Console

    from tracker.terminal.progress import fetch_models_if_needed, telling
    from tracker.tracking.machine_frame import begin_compiling

    name = Names(NODE_NAME, namespace, remap or ()).full_node_name
    remarks: list[str] = []
    config, sim_time = _parameters(params_file or [], param or [], name, remarks.append)
    errors = Console(stderr=True)
    fetch_models_if_needed(errors)
    begin_compiling(telling(errors), telling(errors))
    with _stop_signals() as stop:
        node = DdsHandDetector(
            config,
            namespace=namespace,
            remaps=remap or (),
            use_sim_time=use_sim_time or sim_time,
            remarks=remarks,
        )
        if not node.run(stop):
            sys.exit(1)


def main() -> NoReturn:
    """Run the command; every foreseen failure is one line and a status, as of `raised-hand`."""
    run_program("raised-hand-dds", app)


app = typer.Typer(
    name="raised-hand-dds",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command(help=help_of(command))(command)


@contextmanager
def _stop_signals() -> Iterator[threading.Event]:
    """An event that Ctrl-C and a service manager's SIGTERM set."""
    stop = threading.Event()
    before = {
        number: signal.signal(number, lambda *_: stop.set())
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _parameters(
    files: list[Path], assignments: list[str], node: str, remark: Callable[[str], object]
) -> tuple[Config, bool]:
    """The configuration that files and assignments give to a node, and whether time is simulated.

    Files may name retired parameters, for one remark; assigning one is a mistake.

    Raises:
        ConfigError: A file or an assignment is off.
    """
    found: dict[str, Any] = {}
    for path in files:
        found |= read_parameters(path, node)
    found = without_retired(found, ", ".join(map(str, files)), remark)
    found |= dict(read_assignment(text, node) for text in assignments)
    sim_time = found.get("use_sim_time", False)
    if not isinstance(sim_time, bool):
        raise ConfigError(f"`use_sim_time` is {sim_time!r}; allowed is true or false.")
    origins = [*map(str, files), *(["-p"] if assignments else [])]
    ours = {name: value for name, value in found.items() if is_ours(name)}
    return Config.from_mapping(ours, origin=", ".join(origins) or "parameters"), sim_time


def _trigger(success: bool, message: str) -> Any:
    return build("std_srvs/srv/Trigger_Response", success=success, message=message)


if __name__ == "__main__":
    main()
