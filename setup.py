"""What colcon and the wheel need beside pyproject.toml: the scenes as a package, the ROS files.

colcon understands a Python package by its setup.py alone, so name, version, Python and the test
extra stand here again; tests/test_packaging.py holds the two files together.
"""

from glob import glob
from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "raised_hand_tracker"
SHARE = f"share/{PACKAGE}"

setup(
    name="raised-hand-tracker",
    version="0.1.0",
    python_requires=">=3.10",
    packages=[*find_packages(include=["tracker*", "nodes*"]), "tracker.scenes"],
    package_dir={"tracker.scenes": "config/scenes"},
    package_data={
        "tracker": [
            "py.typed",
            "report/page.html",
            "dashboard/page/*",
            "perception/gestures/signs.npz",
            "perception/models/int8/ranges.npz",
        ],
        "tracker.scenes": ["*.yaml"],
    },
    extras_require={
        "test": [
            "pytest>=8.2,<10",
            "pytest-xdist>=3.5,<4",
            "pytest-timeout>=2.3,<3",
            "hypothesis>=6.100,<7",
            "ai-edge-litert>=1.2,<3",
            "rosbags-image>=0.10,<0.12",
            "stonesoup>=1.9,<2",
            "optuna>=4,<5",
            "cyclonedds==11.0.1; python_version < '3.14'",
            "distributed>=2024.8,<2027",
            "pyarrow>=16,<26",
            "starlette>=0.40,<2",
            "uvicorn>=0.30,<1",
            "websockets>=13,<17",
            "playwright>=1.45,<2",
            "nbclient>=0.10,<0.12",
            "ipykernel>=6.29,<8",
            "ipywidgets>=8.1,<9",
        ]
    },
    # `colcon build --symlink-install` does not see pyproject.toml.
    entry_points={
        "console_scripts": [
            "raised-hand = tracker.cli.app:main",
            "raised-hand-dds = nodes.raised_hand_dds:main",
            "hand_detector = nodes.hand_detector:main",
            "lifecycle_hand_detector = nodes.lifecycle_hand_detector:main",
            "perception.py = nodes.hand_detector:main",
        ]
    },
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (SHARE, [path for path in ["package.xml"] if Path(path).is_file()]),
        (f"{SHARE}/config", sorted(glob("config/*.yaml") + glob("config/*.rviz"))),
        (f"{SHARE}/config/scenes", sorted(glob("config/scenes/*.yaml"))),
        (f"{SHARE}/launch", sorted(glob("launch/*.launch.py"))),
    ],
    zip_safe=False,
)
