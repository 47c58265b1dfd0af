import itertools
import struct

import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.dds.parameters import ParameterServer
from nodes.dds.profiles import PARAMETER_SERVICES
from tracker.config import Config
from tracker.messages.types import build, deserialize, serialize

SRV = "rcl_interfaces/srv"


class Holder:
    """Keeps a configuration as the node does."""

    def __init__(self):
        self.config = Config()

    def configure(self, config):
        self.config = config


@pytest.fixture
def holder(make_node):
    made = Holder()
    made.node = make_node("hand_detector")
    ParameterServer(
        made.node, lambda: made.config, made.configure, use_sim_time=False, now_ns=lambda: 5
    )
    return made


@pytest.fixture
def ask(make_node, holder, until):
    """Asks a parameter service over the wire."""
    client, numbers, ends = make_node("client"), itertools.count(1), {}

    def call(name, service, **request):
        if service not in ends:
            replies, full = [], f"/hand_detector/{name}"
            kinds = f"{SRV}/{service}_Request", f"{SRV}/{service}_Response"
            identity = f"clientid={service};"
            writer = client._write(f"rq{full}Request", kinds[0], PARAMETER_SERVICES, identity)
            reader = client._read(f"rr{full}Reply", kinds[1], PARAMETER_SERVICES, identity)
            client._listen(reader, PARAMETER_SERVICES, lambda cdr, _: replies.append(cdr))
            ends[service] = writer, replies, kinds
        writer, replies, (request_type, response_type) = ends[service]
        until(lambda: writer.get_publication_matched_status().current_count)
        body = serialize(build(request_type, **request)).cdr
        writer.write_cdr(body[:4] + struct.pack("<Qq", 1, next(numbers)) + body[4:])
        until(lambda: replies, holder.node, client)
        reply = replies.pop()
        return deserialize(response_type, reply[:4] + reply[20:])

    return call


def parameter(name, kind, **value):
    return build(
        "rcl_interfaces/msg/Parameter",
        name=name,
        value=build("rcl_interfaces/msg/ParameterValue", type=kind, **value),
    )


def test_all_parameters_are_listed(ask):
    names = ask("list_parameters", "ListParameters").result.names
    assert sorted(names) == sorted([*Config.model_fields, "use_sim_time"])
    assert names[0] == "processing_rate"  # the basic ones come first


def test_values_have_their_types_and_unknown_names_none(ask):
    names = ["processing_rate", "max_hands", "raise_rule", "scan_sustains", "no_such"]
    values = ask("get_parameters", "GetParameters", names=names).values
    assert [value.type for value in values] == [3, 2, 4, 1, 0]
    assert values[0].double_value == Config().processing_rate
    kinds = ask("get_parameter_types", "GetParameterTypes", names=names).types
    assert list(kinds) == [3, 2, 4, 1, 0]


def test_a_live_parameter_is_changed_also_by_a_whole_number(ask, holder):
    for change in (
        parameter("processing_rate", 3, double_value=8.0),
        parameter("processing_rate", 2, integer_value=7),
    ):
        (result,) = ask("set_parameters", "SetParameters", parameters=[change]).results
        assert (result.successful, result.reason) == (True, "")
    assert holder.config == Config(processing_rate=7.0)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (parameter("processing_rate", 3, double_value=500.0), "at most 240"),
        (parameter("processing_rate", 3, double_value=float("nan")), "processing_rate"),
        (parameter("processing_rate", 4, string_value="fast"), "a number"),
        (parameter("processing_rate", 0), "processing_rate"),
        (parameter("processing_rate", 8), "processing_rate"),
        (parameter("fixed_frame", 4, string_value="odom"), "cannot change while the node runs"),
        (parameter("use_sim_time", 1, bool_value=True), "cannot change while the node runs"),
        (parameter("procesing_rate", 3, double_value=8.0), "did you mean `processing_rate`"),
    ],
    ids=["range", "nan", "text", "unset", "array", "fixed", "clock", "unknown"],
)
def test_a_bad_value_is_refused_with_the_reason(ask, holder, change, reason):
    (result,) = ask("set_parameters", "SetParameters", parameters=[change]).results
    assert not result.successful
    assert reason in result.reason
    assert holder.config == Config()


def test_several_are_set_together_or_not_at_all(ask, holder):
    good = parameter("processing_rate", 3, double_value=8.0)
    bad = parameter("max_hands", 2, integer_value=-1)
    service = "set_parameters_atomically", "SetParametersAtomically"
    assert not ask(*service, parameters=[good, bad]).result.successful
    assert holder.config == Config()
    results = ask("set_parameters", "SetParameters", parameters=[good, bad]).results
    assert [result.successful for result in results] == [True, False]
    assert holder.config == Config(processing_rate=8.0)


def test_a_description_has_range_meaning_and_whether_it_is_read_only(ask):
    names = ["processing_rate", "fixed_frame"]
    rate, frame = ask("describe_parameters", "DescribeParameters", names=names).descriptors
    (bounds,) = rate.floating_point_range
    assert (bounds.from_value, bounds.to_value, rate.type) == (0.0, 240.0, 3)
    assert "per second" in rate.description
    assert (rate.read_only, frame.read_only) == (False, True)


def test_changes_are_told_on_parameter_events(ask, holder, make_node, until):
    watcher, heard = make_node("watcher"), []
    watcher.subscribe("/parameter_events", "rcl_interfaces/msg/ParameterEvent", heard.append)
    until(lambda: watcher.offers("/parameter_events", 0.0))
    change = parameter("processing_rate", 3, double_value=8.0)
    ask("set_parameters", "SetParameters", parameters=[change])
    until(lambda: heard, watcher)
    event = deserialize("rcl_interfaces/msg/ParameterEvent", heard[0])
    assert (event.node, event.changed_parameters[0].name) == ("/hand_detector", "processing_rate")
