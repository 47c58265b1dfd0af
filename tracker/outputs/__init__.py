"""Files that are written: never over an input, never half in place of an earlier one."""

from tracker.outputs.aside import GrowingFile, GrowingOutput, part_of, writing_into
from tracker.outputs.folder_lock import FolderLock
from tracker.outputs.inputs import check_inputs_stay
from tracker.outputs.unwritable import unwritable

__all__ = [
    "FolderLock",
    "GrowingFile",
    "GrowingOutput",
    "check_inputs_stay",
    "part_of",
    "unwritable",
    "writing_into",
]
