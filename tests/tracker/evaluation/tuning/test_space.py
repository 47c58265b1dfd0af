import pytest

from tracker.config import Config
from tracker.errors import ConfigError
from tracker.evaluation.tuning.space import choose_parameters, tunable, within_search


@pytest.mark.parametrize("name", tunable())
def test_the_ends_of_the_search_are_allowed_and_the_default_lies_within(name):
    search = tunable()[name]
    kind = Config.model_fields[name].annotation
    if kind in (int, float):
        assert 0.0 < search.high - search.low
        assert not search.log or search.low > 0.0
        beside = {"confirm_window": 100} if name == "confirm_detections" else {}
        for end in (search.low, search.high):
            Config().replace(**{name: kind(end)}, **beside)
    assert within_search(name, getattr(Config(), name))


def test_a_kind_stands_for_all_of_its_parameters():
    names = choose_parameters(["process", "range_std_m"])
    assert {tunable()[name].kind for name in names} == {"process", "measurement"}
    assert names[0] == "range_std_m"
    assert "hand_offset_std_m" not in names


def test_no_kind_has_the_name_of_a_parameter():
    assert not {search.kind for search in tunable().values()} & set(Config.model_fields)


def test_what_cannot_be_tuned_is_named_with_what_can():
    with pytest.raises(ConfigError, match="`fixed_frame` cannot be tuned; there are the kinds"):
        choose_parameters(["fixed_frame"])
