import numpy as np
import pytest

from tracker.errors import ModelFileError
from tracker.perception.sessions import open_session


class FolderStore:
    def __init__(self, folder):
        self.folder = folder

    def path(self, name):
        return self.folder / f"{name}.onnx"


@pytest.mark.parametrize(
    "content", [b"", b"no model at all", None], ids=["empty", "text", "absent"]
)
def test_a_file_that_is_no_model_is_named_with_the_remedy(tmp_path, content):
    if content is not None:
        (tmp_path / "broken.onnx").write_bytes(content)
    with pytest.raises(ModelFileError, match=r"broken\.onnx.*models fetch"):
        open_session(FolderStore(tmp_path), "broken", threads=1)


@pytest.mark.model
def test_threads_and_fixed_sizes_change_speed_not_results(model_store):
    image = np.random.default_rng(3).random((1, 192, 192, 3), dtype=np.float32)
    sizes = {"batch": 1, "height": 192, "width": 192}
    name = "palm_detection_lite"
    free = open_session(model_store, name, threads=1).run(["boxes"], {"image": image})[0]
    fixed = open_session(model_store, name, threads=2, fixed_sizes=sizes)
    np.testing.assert_allclose(fixed.run(["boxes"], {"image": image})[0], free, atol=1e-3)
