from pathlib import Path

import onnx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from onnx import TensorProto, helper

from tracker.perception.models.onnx_metadata import read_metadata


def _model(texts: dict[str, str]) -> bytes:
    values = [helper.make_tensor_value_info(name, TensorProto.FLOAT, ["n"]) for name in "ab"]
    graph = helper.make_graph(
        [helper.make_node("Identity", "a", "b")], "g", [values[0]], [values[1]]
    )
    model = helper.make_model(graph)
    helper.set_model_props(model, texts)
    return model.SerializeToString()


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("metadata") / "model.onnx"


@given(st.dictionaries(st.text(), st.text()))
def test_texts_are_what_onnx_itself_reads(path: Path, texts: dict[str, str]) -> None:
    path.write_bytes(_model(texts))
    assert read_metadata(path) == {p.key: p.value for p in onnx.load(path).metadata_props}


def test_file_cut_off_anywhere_never_tells_the_last_text(path: Path) -> None:
    content = _model({"first": "1", "last": "2"})
    for length in range(len(content)):
        path.write_bytes(content[:length])
        assert "last" not in read_metadata(path)


@given(st.binary(max_size=200))
def test_any_other_file_is_survived(path: Path, content: bytes) -> None:
    path.write_bytes(content)
    assert isinstance(read_metadata(path), dict)


def test_varint_without_end_is_survived(path: Path) -> None:
    path.write_bytes(b"\xff" * 100)
    assert read_metadata(path) == {}


def test_absent_file_is_the_callers_business(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read_metadata(tmp_path / "none.onnx")
