import pytest

from nodes.shared.parameters import changed, descriptors
from tracker import Config
from tracker.config import parameter_extra
from tracker.errors import ConfigError


def test_every_parameter_has_a_descriptor_with_its_default_meaning_and_unit():
    found = {item.name: item for item in descriptors()}
    assert sorted(found) == sorted(Config.model_fields)
    for name, item in found.items():
        assert item.default == getattr(Config(), name)
        assert item.is_read_only == (not parameter_extra(name)["live"])
        assert item.description.startswith(Config.model_fields[name].description)
    rate = found["processing_rate"]
    assert rate.description.endswith("[Hz]")
    assert (rate.minimum, rate.maximum) == (0.0, 240.0)
    assert rate.constraints == "a number above 0 and at most 240 (Hz)"
    assert found["ranging"].constraints == "one of person, spec"
    assert found["fixed_frame"].minimum is None


def test_basic_parameters_come_first_and_the_others_say_that_they_are_for_experts():
    is_expert = [parameter_extra(item.name)["level"] == "expert" for item in descriptors()]
    assert is_expert == sorted(is_expert)
    assert is_expert == [item.description.endswith(" (expert)") for item in descriptors()]


def test_every_number_has_a_range_that_holds_its_default():
    for item in descriptors():
        if isinstance(item.default, (int, float)) and not isinstance(item.default, bool):
            assert item.minimum <= item.default <= item.maximum, item.name


def test_live_parameters_change_together():
    config = changed(
        Config(), {"confirm_detections": 5, "confirm_window": 6, "use_sim_time": True}
    )
    assert (config.confirm_detections, config.confirm_window) == (5, 6)


def test_nothing_of_ours_changes_nothing():
    config = Config()
    assert changed(config, {"use_sim_time": True, "qos_overrides./scan.depth": 3}) is config


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"processing_rate": -1.0}, "above 0"),
        ({"confirm_detections": 5}, "must not exceed confirm_window"),
        ({"fixed_frame": "odom"}, "cannot change while the node runs"),
        ({"raise_rule": "nose"}, "one of evidence, palm, image"),
        ({"nonsense": 1}, "unknown parameter"),
        ({"max_hands": "many"}, "a whole number"),
    ],
    ids=["out-of-range", "cross-field", "not-live", "no-choice", "unknown", "wrong-type"],
)
def test_a_bad_change_is_refused_with_the_reason(changes, reason):
    with pytest.raises(ConfigError, match=reason):
        changed(Config(), changes)


def test_setting_a_fixed_parameter_to_what_it_is_passes():
    assert changed(Config(), {"fixed_frame": "map"}) == Config()


def test_before_anything_runs_every_parameter_may_change_and_none_may_be_wrong():
    assert changed(Config(), {"fixed_frame": "odom"}, is_running=False).fixed_frame == "odom"
    with pytest.raises(ConfigError, match="person, spec"):
        changed(Config(), {"ranging": "guess"}, is_running=False)
