"""Where in a recording is what? At the topics asked for, or where it usually is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

from tracker.messages import types
from tracker.recording.sources import TopicInfo
from tracker.wording import listing, one_line

IMAGES = (types.IMAGE, types.COMPRESSED_IMAGE)
TRANSFORMS = (types.TF_MESSAGE, types.TF_MESSAGE_ROS1)

#: Ways in which a laser is recorded that are not read, and what makes scans of them.
_OTHER_SCANS = {
    "sensor_msgs/msg/PointCloud2": "pointcloud_to_laserscan",
    "sensor_msgs/msg/PointCloud": "pointcloud_to_laserscan",
    "sensor_msgs/msg/MultiEchoLaserScan": "laser_proc",
}


@dataclass(frozen=True, slots=True)
class Topics:
    """Where a recording holds what.

    Attributes:
        image: Pictures; `<image>/compressed` is taken where the topic itself is missing.
        scan: LiDAR scans; where it is missing and there is one other topic of scans, that one.
        camera_info: Intrinsics; where it is missing, the `camera_info` beside the image topic.
        tf: Moving transforms; where it is missing, the robot's own, as /robot1/tf.
        tf_static: Lasting transforms; likewise.
        map: The map of the room; where it is missing and there is one other `map`, that one.
        truth: Simulated people.
        depth: Depth images; `<depth>/compressedDepth` is taken where the topic itself is missing.
        depth_camera_info: Their intrinsics; where it is missing, the `camera_info` beside them.
    """

    image: str = "/image_raw"
    scan: str = "/scan"
    camera_info: str = "/camera_info"
    tf: str = "/tf"
    tf_static: str = "/tf_static"
    map: str = "/map"
    truth: str = "/truth/people"
    depth: str = "/depth"
    depth_camera_info: str = "/depth_camera_info"


class TopicTable:
    """The topics of a recording, as they are looked for.

    Args:
        topics: Type and number of messages of each.
    """

    def __init__(self, topics: Mapping[str, TopicInfo]) -> None:
        self._topics = topics

    def holds(self, topic: str, *type_names: str) -> bool:
        """Whether a topic is there with messages of one of these types."""
        info = self._topics.get(topic)
        return info is not None and info.type_name in type_names

    def of_type(self, *type_names: str) -> list[str]:
        """The topics of these types, by name."""
        return sorted(name for name in self._topics if self.holds(name, *type_names))

    def find(self, asked: Topics) -> Topics:
        """Where the asked-for topics are missing, the places where these data usually are."""
        names = {item.name: self._spelled(getattr(asked, item.name)) for item in fields(asked)}
        asked = Topics(**names)
        found = replace(
            asked,
            image=self._find_image(asked.image),
            scan=self._find_scan(asked.scan),
            depth=self._find_depth(asked.depth),
        )
        found = replace(found, camera_info=self._find_camera_info(found.image, asked.camera_info))
        return replace(
            found,
            depth_camera_info=self._find_depth_camera_info(found, asked.depth_camera_info),
            tf=self._find_transforms(asked.tf, found),
            tf_static=self._find_transforms(asked.tf_static, found),
            map=self._find_map(asked.map),
        )

    def unread_scans(self, scan: str) -> str:
        """Why no scan is read although a laser was recorded, and the remedy; empty if none was."""
        if self.holds(scan, types.LASER_SCAN):
            return ""
        scans = self.of_type(types.LASER_SCAN)
        if scans:
            return (
                f"no scans on {one_line(scan)}, so none are used; scans are on {listing(scans)}. "
                "Pass one of them as --scan-topic."
            )
        for type_name, tool in _OTHER_SCANS.items():
            others = self.of_type(type_name)
            if others:
                return (
                    f"no LaserScan in the recording, so no laser is used; {listing(others)} "
                    f"carries {type_name}. The ROS package {tool} makes scans of it: run it, "
                    "record its topic, and pass that as --scan-topic."
                )
        return ""

    def unread_transforms(self, read: Topics) -> str:
        """Topics of transforms that are not read although others are missing; empty for none."""
        missing = [
            topic for topic in (read.tf, read.tf_static) if not self.holds(topic, *TRANSFORMS)
        ]
        others = [
            name for name in self.of_type(*TRANSFORMS) if name not in (read.tf, read.tf_static)
        ]
        if not missing or not others:
            return ""
        return (
            f"no transforms on {listing(missing)}; {listing(others)} is not read. Choose the "
            "topics with --tf-topic and --tf-static-topic."
        )

    def described(self) -> str:
        """Every topic with type and number, as far as a line holds them."""
        rows = sorted(self._topics.items())
        return listing(f"{name} ({info.type_name}, {info.count})" for name, info in rows)

    def _spelled(self, asked: str) -> str:
        """With the slash in front that names of recorded topics have."""
        return asked if asked in self._topics else f"/{asked.lstrip('/')}"

    def _find_image(self, asked: str) -> str:
        packed = f"{asked}/compressed"
        return packed if asked not in self._topics and self.holds(packed, *IMAGES) else asked

    def _find_depth(self, asked: str) -> str:
        packed = f"{asked}/compressedDepth"
        is_packed = asked not in self._topics and self.holds(packed, types.COMPRESSED_IMAGE)
        return packed if is_packed else asked

    def _find_depth_camera_info(self, found: Topics, asked: str) -> str:
        beside = self._find_camera_info(found.depth.removesuffix("/compressedDepth"), asked)
        # The color camera's own says nothing new of a depth image beside the color image.
        return asked if beside == found.camera_info else beside

    def _find_scan(self, asked: str) -> str:
        scans = self.of_type(types.LASER_SCAN)
        return scans[0] if asked not in self._topics and len(scans) == 1 else asked

    def _find_camera_info(self, image: str, asked: str) -> str:
        beside = f"{image.rsplit('/', 1)[0]}/camera_info"
        is_there = asked not in self._topics and self.holds(beside, types.CAMERA_INFO)
        return beside if is_there else asked

    def _find_map(self, asked: str) -> str:
        maps = [name for name in self.of_type(types.OCCUPANCY_GRID) if name.endswith("/map")]
        return maps[0] if asked not in self._topics and len(maps) == 1 else asked

    def _find_transforms(self, asked: str, others: Topics) -> str:
        """The topic of the same name in a namespace: the sensors' own, or the only one."""
        info = self._topics.get(asked)
        if info is not None and info.count:
            return asked
        last = asked.rsplit("/", 1)[-1]
        named = [
            name
            for name in self.of_type(*TRANSFORMS)
            if name.rsplit("/", 1)[-1] == last and self._topics[name].count
        ]
        near = [name for name in named if _shares_namespace(name, (others.image, others.scan))]
        for choice in (near, named):
            if len(choice) == 1:
                return choice[0]
        return asked


def _shares_namespace(topic: str, sensors: tuple[str, ...]) -> bool:
    namespace = topic.rsplit("/", 1)[0]
    return any(sensor.startswith(f"{namespace}/") for sensor in sensors)
