import pytest

from tracker.errors import ConfigError
from tracker.perception.models import (
    model_to_run,
    numbers,
    processor_features,
    processor_kind,
    runs_here,
)


@pytest.fixture
def processor(monkeypatch):
    """Makes the processor one of these features, on a machine of this kind."""

    def pretend(*features, machine="x86_64"):
        monkeypatch.setattr(numbers, "processor_features", lambda: frozenset(features))
        monkeypatch.setattr(numbers.platform, "machine", lambda: machine)

    return pretend


def test_auto_takes_bytes_where_they_are_known_to_be_faster(processor):
    processor("avx2", "avx512_vnni")
    assert model_to_run("hand_landmark_full", "auto") == "hand_landmark_full_int8"
    processor("avx2")
    assert model_to_run("hand_landmark_full", "auto") == "hand_landmark_full"


def test_palm_models_have_no_bytes(processor):
    processor("avx512_vnni")
    assert model_to_run("palm_detection_lite", "int8") == "palm_detection_lite"


def test_either_can_be_forced(processor):
    processor("avx512_vnni")
    assert model_to_run("pose_detection", "fp32") == "pose_detection"
    processor("asimddp", machine="aarch64")
    assert model_to_run("pose_detection", "auto") == "pose_detection"
    assert model_to_run("pose_detection", "int8") == "pose_detection_int8"


def test_bytes_are_refused_where_their_sums_overflow(processor):
    processor("avx2")
    with pytest.raises(ConfigError, match=r"no VNNI.*choose `auto` or `fp32`"):
        model_to_run("hand_landmark_lite", "int8")


def test_other_providers_run_single_precision(processor):
    processor("avx512_vnni")
    assert model_to_run("hand_landmark_lite", "int8", "cuda") == "hand_landmark_lite"


class Store:
    """Has all files but some."""

    def __init__(self, *absent):
        self.absent = absent

    def has(self, name):
        return name not in self.absent


def test_each_model_runs_in_one_way(processor):
    processor("avx512_vnni")
    in_bytes, plain = (runs_here(Store(), numbers) for numbers in ("auto", "fp32"))
    assert len(in_bytes) == len(plain) == 6
    assert "hand_landmark_lite_int8" in in_bytes - plain


def test_a_file_that_is_not_there_does_not_run(processor):
    processor("avx512_vnni")
    assert "pose_detection" in runs_here(Store("pose_detection_int8"), "auto")
    assert "pose_detection_int8" not in runs_here(Store("pose_detection_int8"), "int8")
    assert "pose_landmark_full" not in runs_here(Store("pose_landmark_full"), "auto")


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("model name\t: A\nflags\t\t: fpu avx2\n\nflags\t\t: other\n", {"fpu", "avx2"}),
        ("Features\t: fp asimd asimddp\n", {"fp", "asimd", "asimddp"}),
        ("nothing", set()),
        (None, set()),
    ],
    ids=["x86", "ARM", "no such line", "no such file"],
)
def test_linux_tells_what_the_processor_can(tmp_path, monkeypatch, text, found):
    path = tmp_path / "cpuinfo"
    if text is not None:
        path.write_text(text)
    monkeypatch.setattr(numbers, "_CPUINFO", path)
    processor_features.cache_clear()
    try:
        assert processor_features() == found
    finally:
        processor_features.cache_clear()


def test_figures_can_say_on_which_processor_they_were_measured(processor, monkeypatch):
    processor("avx2", "fma", "sse2")
    monkeypatch.setattr(numbers.os, "cpu_count", lambda: 2)
    assert processor_kind() == "x86_64, 2 processors: avx2, fma"
    processor(machine="riscv64")
    assert processor_kind() == "riscv64, 2 processors: instruction sets unknown"
