"""Everything that both nodes share: bytes in, `tracker.Pipeline` in one worker thread, bytes out.

Callbacks only store. The worker decodes, waits for transforms and runs the models; it alone
touches the pipeline, so orders from outside (release, reset, configure) wait for their turn.
Nothing here knows rclpy or Cyclone DDS.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from nodes.shared.call_desk import CallDesk
from nodes.shared.diagnostics import WARN, Diagnostics, encode_statuses
from nodes.shared.fault_log import FaultLog
from nodes.shared.image_silence import patience_s
from nodes.shared.inbox import Inbox
from nodes.shared.link import Link
from nodes.shared.outputs import (
    HasSubscribers,
    Publish,
    publish_answer,
    publish_nobody,
    publish_views,
)
from nodes.shared.topics import Input, Output, input_topics
from nodes.shared.work_budget import WorkBudget
from tracker.config import NODE_NAME, Config
from tracker.containers import CameraImage, FrameResult, Scan, Tracks
from tracker.errors import TrackerError
from tracker.messages import Encoded, decode, encode
from tracker.messages.header_peek import peek_header
from tracker.messages.types import deserialize
from tracker.notes import NoteKind
from tracker.perception.detector import HandDetector
from tracker.perception.gestures.customers import GestureNews
from tracker.pipeline import Pipeline
from tracker.service import Answer, Command, Verb
from tracker.transforms import Transforms
from tracker.waiting import IMAGES_KEPT, WaitingImage

if TYPE_CHECKING:
    from nodes.shared.page import NodePage

#: Tells a text to the user; levels are "info", "warning" and "error".
Log = Callable[[str, str], None]

#: A waiting image is looked at again this often, should nothing wake the worker.
_PATIENCE_STEP_S = 0.05
#: Images that a worker may catch up with after it was held up, the share of a period that an image
#: may take on average for that, and over how many images the average goes.
_CATCH_UP, _KEEPS_UP, _BUSY_IMAGES = 3, 0.8, 10
#: A robot's drivers start with the node; what is missing is worth a word in the log after this.
_SETTLED_NS = 5_000_000_000
#: How long `stop` waits for the frame at hand.
_STOP_S = 10.0


class NodeCore:
    """The node without ROS or DDS.

    `start` it, hand every message to `receive`, publish `diagnostics` once in
    `diagnostics.REPORT_PERIOD_S`, and `stop` it. All methods may be called from any thread and
    return at once, except `stop`.

    Args:
        config: Every parameter.
        publish: Hands a message to the wire; called by the worker, and by who calls `diagnose`.
        has_subscribers: Whether anybody listens to an output.
        log: Tells the user something.
        now_ns: The node's clock, simulated or not: the one of the stamps.
        detector: Finds hands; by default MediaPipe's models.
        transforms: By default a buffer of the project's own, filled by `receive`. A shell may
            pass another one, around tf2's.
        topic_names: Where each input is listened to, for words; by default the unmapped names.
        links: What the wire knows of who publishes the inputs; asked for every report.
        steady_ns: A clock that never jumps.
        node_name: Namespace and name, for /diagnostics.

    Raises:
        ModelFileError: The hand models are not there.
    """

    def __init__(
        self,
        config: Config,
        *,
        publish: Publish,
        has_subscribers: HasSubscribers,
        log: Log,
        now_ns: Callable[[], int],
        detector: HandDetector | None = None,
        transforms: Transforms | None = None,
        topic_names: Mapping[Input, str] | None = None,
        links: Callable[[], Mapping[Input, Link]] = dict,
        steady_ns: Callable[[], int] = time.monotonic_ns,
        node_name: str = NODE_NAME,
    ) -> None:
        self._publish, self._has_subscribers = publish, has_subscribers
        self._log, self._now_ns, self._steady_ns = log, now_ns, steady_ns
        self._config, self._links = config, links
        names = {item: topic.name for item, topic in input_topics(config).items()}
        names |= dict(topic_names or {})
        self._pipeline = Pipeline(config, detector, transforms, image_topic=names[Input.IMAGES])
        self._inbox = Inbox()
        self._images = self._pipeline.room.images
        self._gestures = GestureNews()
        self._diagnostics = Diagnostics(steady_ns, names)
        self._faults = FaultLog(lambda text: log("warning", text), steady_ns)
        self._remarks = FaultLog(lambda text: log("info", text), steady_ns)
        self._busy_s = 0.0
        self._budget = WorkBudget()
        self._began_ns = steady_ns()
        self._is_enabled = True
        self._node_name = node_name.lstrip("/")
        self._last: FrameResult | None = None
        self._shown_in: str | None = None
        self._calls = CallDesk(self._pipeline, config, publish, lambda text: log("warning", text))
        self._page = self._make_page(config) if config.dashboard_port else None
        self._worker = threading.Thread(target=self._work, name="hand_detector", daemon=True)
        log("info", _greeting(config))

    @property
    def config(self) -> Config:
        """The parameters in force, or about to be."""
        return self._config

    @property
    def is_enabled(self) -> bool:
        """Whether images are processed."""
        return self._is_enabled

    @property
    def is_hand_up(self) -> bool:
        """Whether the last published `hand_raised` was true."""
        return self._last is not None and self._last.hand_raised

    @property
    def is_alive(self) -> bool:
        """Whether the worker runs; it ends by `stop`, or by an error that it prints."""
        return self._worker.is_alive()

    @property
    def images_waiting(self) -> int:
        """How many images wait for a transform or for the worker."""
        return len(self._images)

    def start(self) -> None:
        """Begin to work."""
        self._worker.start()

    def stop(self) -> None:
        """Finish the frame at hand, take back what was published, and end the worker."""
        self._inbox.close()
        if self._worker.is_alive():
            self._worker.join(_STOP_S)
        if self._page is not None:
            self._page.close()

    def receive(self, item: Input, message: Encoded) -> None:
        """Store a received message."""
        self._diagnostics.heard(item)
        if item is Input.IMAGES:
            self._receive_image(message)
        else:
            self._inbox.put(item, message)

    def enable(self, is_enabled: bool) -> str:
        """Process images from now on, or ignore them and forget everybody.

        Returns:
            What happened, in words.
        """
        was_enabled, self._is_enabled = self._is_enabled, is_enabled
        if is_enabled and not was_enabled:
            self._diagnostics.listen()
        if was_enabled and not is_enabled:
            self._inbox.order(self._forget_everybody)
        words = "enabled" if is_enabled else "disabled"
        return words if was_enabled != is_enabled else f"already {words}"

    def release(self) -> tuple[bool, str]:
        """End the service of the selected customer; the next image selects another.

        Returns:
            Whether anybody was selected, and what happened, in words.
        """
        chosen = self._calls.selected_id
        if chosen is None:
            return False, "nobody is selected"
        # By the number: another one may be selected by the time that the worker is free.
        self._inbox.order(lambda: self._calls.obey(Command(Verb.RELEASE, chosen)))
        return True, f"customer {chosen} is released"

    def command(self, text: str) -> None:
        """Follow a command as `serve 3`; what comes of it is published."""
        try:
            command = Command.parse(text)
        except TrackerError as error:
            self._calls.answer(text, Answer(False, str(error)))
            return
        self._inbox.order(lambda: self._calls.obey(command))

    def reset(self, reason: str) -> None:
        """Forget people, scans and moving transforms, as after a jump of the clock.

        Args:
            reason: Why, for the log.
        """
        self._inbox.order(lambda: self._reset(reason))

    def configure(self, config: Config) -> None:
        """Change parameters while running; only those that are `live` take effect."""
        self._config = config
        if self._page is not None:
            self._page.follow(config)
        self._images.set_rate(config.processing_rate)
        self._inbox.order(lambda: self._pipeline.configure(config))

    def refuse(self, item: Input, text: str) -> None:
        """Count a malformed message, and log it once in a while."""
        self._diagnostics.malformed(item, text)
        self._faults.add(item.value, text)

    def diagnose(self) -> None:
        """Publish how the node is doing."""
        statuses = self._diagnostics.report(
            self._config,
            type(self._pipeline.detector).__name__,
            is_enabled=self._is_enabled,
            lost=self._images.lost,
            links=self._links(),
        )
        if self._steady_ns() - self._began_ns >= _SETTLED_NS:
            for status in statuses:
                if status.level >= WARN and status.is_news:
                    self._faults.add(status.name, status.message)
        report = encode_statuses(statuses, max(self._now_ns(), 0), self._node_name)
        self._publish(Output.DIAGNOSTICS, report)
        self._inbox.wake()  # silence brings nothing that would

    def _receive_image(self, message: Encoded) -> None:
        if not self._is_enabled:
            return
        try:
            header = peek_header(message.cdr)
        except TrackerError as error:
            self.refuse(Input.IMAGES, str(error))
            return
        verdict = self._images.offer(
            WaitingImage(*header, self._steady_ns(), lambda: self._image_of(message))
        )
        if verdict.is_refused:
            stamp_s = header.stamp_ns / 1e9
            self.refuse(Input.IMAGES, f"the stamp {stamp_s:.3f} s: {verdict.value}")
        elif verdict.is_admitted:
            self._inbox.wake()

    def _work(self) -> None:
        was_busy = False
        while self._inbox.wait(_PATIENCE_STEP_S if len(self._images) else None):
            self._catch_up()
            images = self._images.take(self._is_ready, at_most=self._backlog(was_busy))
            for image in images:
                self._process(image)
                self._catch_up()
            was_busy = bool(images)
            if was_busy:
                self._inbox.wake()
            self._mind_silence()
            if self._page is not None:
                self._page.follow_orders()
        if self.is_hand_up:
            self._forget_everybody()

    def _backlog(self, was_busy: bool) -> int:
        """How many images that are ready are worth processing; of more, the newest count.

        What one transform has set free is processed in order, and so is what little came while
        something else had the processor. A worker that is too slow for `processing_rate` takes
        the newest only: it must not run behind its time.
        """
        if not was_busy:
            return IMAGES_KEPT
        can_keep_up = self._busy_s < _KEEPS_UP / self._config.processing_rate
        return _CATCH_UP if can_keep_up else 1

    def _catch_up(self) -> None:
        """Execute pending orders and take in received data, except images."""
        delivery = self._inbox.take()
        for order in delivery.orders:
            order()
        for item, message in delivery.messages:
            self._take_in(item, message)

    def _take_in(self, item: Input, message: Encoded) -> None:
        is_static = item is Input.STATIC_TRANSFORMS
        if item is Input.COMMANDS:
            self._take_command(message)
            return
        try:
            events = decode(
                message.type_name,
                message.cdr,
                is_static=is_static,
                is_depth=item in (Input.DEPTH, Input.DEPTH_CAMERA_INFO),
                max_pixels=self._config.picture_max_pixels,
            )
        except TrackerError as error:
            self.refuse(item, str(error))
            return
        for event in events:
            if isinstance(event, Scan):
                self._diagnostics.scan_stamped(event.stamp_ns, self._now_ns())
            try:
                self._pipeline.add(event)
            except TrackerError as error:
                self.refuse(item, str(error))

    def _make_page(self, config: Config) -> NodePage:
        from nodes.shared.page import NodePage  # with the extra `live`

        page = NodePage(config, self._node_name, self._calls, self.configure)
        self._log("info", f"The page: {page.url}")
        return page

    def _take_command(self, message: Encoded) -> None:
        try:
            text = deserialize(*message).data
        except TrackerError as error:
            self.refuse(Input.COMMANDS, str(error))
            return
        self.command(text)

    def _is_ready(self, image: WaitingImage) -> bool:
        """Whether an image need not wait any longer for the transform of its stamp."""
        now_ns = self._steady_ns() if self._diagnostics.is_hopeful() else None
        return self._pipeline.is_ready(image, now_ns)

    def _process(self, waiting: WaitingImage) -> None:
        began_ns = self._steady_ns()
        try:
            image = waiting.open()
            result = self._pipeline.process(image)
        except TrackerError as error:
            self.refuse(Input.IMAGES, str(error))
            return
        self._last, self._shown_in = result, result.frame_id or self._shown_in
        publish_answer(result, self._publish)
        if result.sensor_pose is not None:
            self._calls.show(result.sensor_pose[:2])
        self._tell_gestures(result.tracks)
        latency_s = (self._now_ns() - result.stamp_ns) / 1e9
        busy_s = (self._steady_ns() - began_ns) / 1e9
        self._busy_s += (busy_s - self._busy_s) / _BUSY_IMAGES
        self._diagnostics.processed(result, latency_s, busy_s)
        if self._page is not None:
            self._page.watch(image, result, busy_s)
        self._pace(result)
        publish_views(image, result, self._config, self._publish, self._has_subscribers)
        for note in result.notes:
            if note.kind is NoteKind.CLOCK_JUMPED:
                self._note_reset(note.text)
            else:
                self._remarks.add(Input.IMAGES.value, note.text)

    def _pace(self, result: FrameResult) -> None:
        """Reduce the search before images are lost, and increase it again."""
        if result.work is not None:
            busy_share = self._busy_s * self._config.processing_rate
            most = self._config.search_regions_per_frame
            self._pipeline.model_runs = self._budget.after(result.work, busy_share, most)

    def _reset(self, reason: str) -> None:
        self._pipeline.reset()
        self._note_reset(reason)

    def _forget_everybody(self) -> None:
        self._images.reset()
        calls = self._pipeline.tracker.calls.now
        self._pipeline.tracker.reset()
        self._pipeline.tracker.restore(calls)  # who waits is not served by a camera that is off
        self._pipeline.detector.reset()
        self._take_back()

    def _mind_silence(self) -> None:
        """Report nobody while the camera is silent; the tracks are kept."""
        silence_s = self._diagnostics.silence_s
        if self._last is None or len(self._images) or silence_s is None:
            return
        if silence_s >= patience_s(self._config):
            self._pipeline.tracker.lower_hands()
            self._take_back()

    def _take_back(self) -> None:
        stamp_ns = self._last.stamp_ns if self._last is not None else 0
        self._last = None
        publish_nobody(stamp_ns, self._shown_in, self._publish, self._has_subscribers)
        self._calls.show()
        self._tell_gestures(Tracks.none(stamp_ns))

    def _tell_gestures(self, tracks: Tracks) -> None:
        for news in self._gestures.after(tracks):
            self._publish(Output.GESTURE, encode(news))

    def _image_of(self, message: Encoded) -> CameraImage:
        (image,) = decode(*message, max_pixels=self._config.picture_max_pixels)
        assert isinstance(image, CameraImage), "only images are subscribed to"
        return image

    def _note_reset(self, reason: str) -> None:
        self._diagnostics.resets += 1
        self._log("warning", f"Everybody is forgotten: {reason}.")


def _greeting(config: Config) -> str:
    if config.raise_rule == "evidence":
        rule = "evidence: hand, arm, body and movement, at any distance"
    elif config.raise_rule == "palm":
        rule = f"palm: up from {config.palm_raised_threshold:g} palm lengths, at any distance"
    else:
        rule = (
            f"image: up from {config.hand_raised_threshold:g} image heights, a hand spread over "
            f"{config.hand_span_threshold:g} image widths; up to about 0.7 m"
        )
    return (
        f"{config.processing_rate:g} Hz, model_complexity {config.model_complexity}, raise rule "
        f"{rule}; customers in the frame {config.fixed_frame!r}."
    )
