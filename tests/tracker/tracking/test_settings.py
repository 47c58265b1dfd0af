import numpy as np
import pytest
from scipy.stats import chi2

from tracker import Config
from tracker.tracking.settings import RECORD, Settings, record_of, settings_of


def test_parameters_keep_their_names_and_values():
    config = Config(detection_probability=0.7, outlier_dof=3.0)
    settings = settings_of(config)
    same = [name for name in Settings._fields if hasattr(config, name)]
    assert len(same) == len(Settings._fields) - 5
    for name in same:
        assert getattr(settings, name) == getattr(config, name)


def test_the_gates_are_quantiles_of_chi_square():
    settings = settings_of(Config(gate_probability=0.95))
    assert settings.bearing_limit == pytest.approx(chi2.ppf(0.95, 1))
    assert settings.ranged_limit == pytest.approx(chi2.ppf(0.95, 2))


@pytest.mark.parametrize(
    ("association", "flags"), [("pda", (0, 0)), ("hungarian", (1, 0)), ("jpda", (0, 1))]
)
def test_ways_to_associate_are_told_apart_by_two_flags(association, flags):
    settings = settings_of(Config(association=association))
    assert (settings.is_hard, settings.is_joint) == flags


def test_what_confirms_is_a_flag():
    confirms = [
        settings_of(Config(confirmation=name)).confirms_by_existence
        for name in ("m_of_n", "existence")
    ]
    assert confirms == [0.0, 1.0]


def test_machine_code_reads_the_same_numbers_by_the_same_names():
    settings = settings_of(Config())
    assert all(isinstance(number, float) for number in settings)
    record = record_of(settings)
    assert RECORD.names == Settings._fields
    assert record.tolist() == tuple(settings)
    assert {record.dtype[name] for name in RECORD.names} == {np.dtype(np.float64)}
