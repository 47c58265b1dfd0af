"""Imports point downwards, the core needs little, and what is public is written in order."""

import ast
import importlib
import subprocess
import sys
from collections import defaultdict
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = sorted((ROOT / "tracker").rglob("*.py"))

#: From the ground up. A file may import its own room and the floors below, never its neighbors.
FLOORS = [
    {"errors", "closing", "notes", "gesture", "user_cache", "wording"},
    {"outputs", "parameters"},
    {"containers", "config"},
    {"geometry", "config_file", "lens"},
    {"camera", "transforms", "compiling", "service"},
    {"perception", "ranging", "tracking", "messages", "waiting"},
    {"problems", "locating"},
    {"depth_sense"},
    {"pipeline", "recording"},
    {"simulation"},
    {"evaluation.metrics"},
    {"evaluation.recordings"},
    {"evaluation.trials"},
    {"evaluation.studies"},
    {"evaluation.detection", "evaluation.tuning"},
    {"report"},
    {"dashboard"},
    {"replay", "live"},
    {"terminal"},
    {"cli"},
]
FLOOR_OF = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}


def imported_modules(path):
    """Every module a file imports, anywhere in it, as (line, dotted name)."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno}: imports are written in full"
            yield node.lineno, node.module
            if node.module == "tracker":
                yield from ((node.lineno, f"tracker.{alias.name}") for alias in node.names)


def lines_for_type_checkers(path):
    """The lines under `if TYPE_CHECKING:`, which never run."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    blocks = [node for node in ast.walk(tree) if isinstance(node, ast.If)]
    blocks = [node for node in blocks if ast.unparse(node.test) == "TYPE_CHECKING"]
    return {line for node in blocks for line in range(node.lineno, node.end_lineno + 1)}


def room_of(module):
    """Where a module of ours stands: `evaluation` has floors of its own, other rooms have one."""
    parts = module.split(".")
    return ".".join(parts[1 : 3 if parts[1:2] == ["evaluation"] else 2])


def module_of(path):
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_file_imports_downwards_only(path):
    room = room_of(module_of(path))
    if room in ("", "__main__", "evaluation"):
        return
    assert room in FLOOR_OF, f"say in FLOORS where `{room}` stands"
    for line, module in imported_modules(path):
        if not module.startswith("tracker."):
            continue
        other = room_of(module)
        if other != room and other in FLOOR_OF:
            assert FLOOR_OF[other] < FLOOR_OF[room], f"{path}:{line} imports {module}"


def test_no_two_rooms_of_a_folder_import_each_other():
    needs = defaultdict(lambda: defaultdict(set))  # of each folder: what in it imports what in it
    for path in [*SOURCES, *(ROOT / "nodes").rglob("*.py")]:
        mine = module_of(path).split(".")
        typing_only = lines_for_type_checkers(path)
        for line, module in imported_modules(path):
            if line in typing_only:
                continue
            theirs = module.split(".")
            same = [one == two for one, two in zip(mine, theirs, strict=False)]
            shared = [*same, False].index(False)
            if 0 < shared < min(len(mine), len(theirs)):
                needs[".".join(mine[:shared])][mine[shared]].add(theirs[shared])
    found = []
    for folder, graph in needs.items():
        try:
            TopologicalSorter(graph).prepare()
        except CycleError as error:
            found.append(f"in {folder}: {' <- '.join(error.args[1])}")
    assert found == []


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_core_knows_neither_ros_nor_dds_nor_the_nodes(path):
    roots = {module.split(".")[0] for _, module in imported_modules(path)}
    if room_of(module_of(path)) == "cli":
        roots -= {"nodes"}  # `play` and `echo`, when called
    assert not roots & {"rclpy", "cyclonedds", "nodes", "tf2_ros", "sensor_msgs", "cv_bridge"}


IMPORT_WITH_LITTLE = """
import sys

ALLOWED = {
    "numpy", "scipy", "pydantic", "tracker",
    "pydantic_core", "annotated_types", "typing_extensions", "typing_inspection",
}

class Nothing:
    def find_spec(self, name, path=None, target=None):
        root = name.partition(".")[0]
        known = root in ALLOWED or root in sys.stdlib_module_names
        if not known and not root.startswith("_sysconfigdata"):
            raise ModuleNotFoundError(f"No module named {name!r} (blocked)", name=name)

sys.meta_path.insert(0, Nothing())
import tracker
tracker.PersonTracker(tracker.Config()).step(0, tracker.Measurements.none())
"""


def test_the_core_runs_with_numpy_scipy_and_pydantic_alone():
    run = subprocess.run(
        [sys.executable, "-c", IMPORT_WITH_LITTLE], cwd=ROOT, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stderr


def constants_classes_functions(name):
    """The order that ruff (RUF022) asks for."""
    return (not name.isupper(), not name[0].isupper(), name)


PACKAGES = [
    ".".join(path.parent.relative_to(ROOT).parts)
    for path in SOURCES
    if path.name == "__init__.py" and "__all__" in path.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("name", PACKAGES)
def test_public_names_are_sorted_and_exist(name):
    package = importlib.import_module(name)
    assert list(package.__all__) == sorted(set(package.__all__), key=constants_classes_functions)
    assert all(hasattr(package, item) for item in package.__all__)
