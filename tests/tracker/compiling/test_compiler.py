"""Functions as machine code, taken from a folder or kept there."""

import random

import pytest

pytest.importorskip("numba", reason="numba is not installed")


def hits(function):
    return sum(function.stats.cache_hits.values())


def test_a_function_and_what_it_calls_are_compiled_and_kept(small, tmp_path):
    module = small()
    for expected in (0, 1):
        double = module.build(tmp_path / "code")
        assert double(3.0) == 6.0
        assert hits(double) == expected


def test_without_a_folder_nothing_is_kept(small, tmp_path):
    double = small().build(None)
    assert double(3.0) == 6.0
    assert not list(tmp_path.rglob("*.nb?"))


def test_types_that_were_not_said_are_refused_and_not_compiled(small, tmp_path):
    double = small().build(tmp_path / "code")
    with pytest.raises(TypeError):
        double("word")
    assert len(double.signatures) == 1


def test_a_folder_that_cannot_be_written_is_no_reason_to_stop(small, tmp_path):
    (tmp_path / "code").write_text("a file where the folder should be")
    assert small().build(tmp_path / "code")(3.0) == 6.0


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("left", [0.0, 0.5, 0.99], ids=["empty", "half", "nearly all"])
def test_files_that_were_cut_off_are_compiled_again(small, tmp_path, suffix, left):
    module, folder = small(), tmp_path / "code"
    module.build(folder)
    for path in folder.glob(f"*{suffix}"):
        content = path.read_bytes()
        path.write_bytes(content[: int(left * len(content))])
    double = module.build(folder)
    assert (double(3.0), hits(double)) == (6.0, 0)
    again = module.build(folder)
    assert (again(3.0), hits(again)) == (6.0, 1)


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("seed", range(20))
def test_files_with_anything_in_them_are_compiled_again(small, tmp_path, suffix, seed):
    module, folder = small(), tmp_path / "code"
    module.build(folder)
    for path in folder.glob(f"*{suffix}"):
        content = path.read_bytes()
        path.write_bytes(content[:seed] + random.Random(seed).randbytes(200))
    double = module.build(folder)
    assert double(3.0) == 6.0


def test_a_changed_source_is_not_the_kept_one(small, tmp_path):
    assert small(factor=2.0).build(tmp_path / "one")(3.0) == 6.0
    assert small(factor=5.0).build(tmp_path / "other")(3.0) == 15.0
