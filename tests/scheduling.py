"""Distribute tests to processes: each file is a whole, so that its fixtures are made once.

Some files form a group in one process: those that open windows, which share a screen, those that compile the kernels of
all scenes, and those that ask about the rays of all regimes, which are slow to make.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

from tests.paths import ROOT

WINDOWS, SCENES, EXACT = "windows", "scenes", "tests/stability/test_exact.py"
# The groups and files that take longest start first, so that no process starts one when the others are idle.
LARGEST = (WINDOWS, EXACT, SCENES, "tests/newcomer/test_newcomer.py")
GROUPS = {
    "tests/test_goldens.py": SCENES,
    "tests/rendering/packing/test_generic_kernels.py": SCENES,
    "tests/rendering/queries/test_preview.py": SCENES,
    "tests/stability/test_pictures.py": SCENES,
}

# Folders and files that `make quick` leaves out. They take most of the time, above all without compiled kernels, since
# a kernel takes seconds to compile.
SLOW = (
    "tests/bench/",
    "tests/cli/test_arguments.py",
    "tests/cli/test_cluster.py",
    "tests/cli/test_ends.py",
    "tests/cli/test_files.py",
    "tests/cli/test_formats.py",
    "tests/cli/test_output.py",
    "tests/cli/test_process.py",
    "tests/cli/test_resume.py",
    "tests/cli/test_streams.py",
    "tests/cluster/",
    "tests/faults/",
    "tests/fuzz/",
    "tests/kernel/",
    "tests/lanes/test_operators.py",
    "tests/newcomer/",
    "tests/rendering/packing/test_planes.py",
    "tests/rendering/packing/test_visibility.py",
    "tests/rendering/test_tone_mapping.py",
    "tests/rendering/packing/test_generic_kernels.py",
    "tests/rendering/queries/",
    "tests/rendering/test_kernels.py",  # which needs generic kernels
    "tests/rendering/sampling/",
    "tests/rendering/test_apertures.py",
    "tests/rendering/test_buffers.py",
    "tests/rendering/test_crop.py",
    "tests/rendering/test_extreme_scenes.py",
    "tests/rendering/test_renderer.py",
    "tests/rendering/test_meshes.py",
    "tests/report/",
    "tests/scene/test_examples.py",
    "tests/scene/test_fast.py",
    "tests/scene/test_writer.py",
    "tests/shapes/test_mapping.py",
    "tests/shapes/test_protocol.py",
    "tests/stability/",
    "tests/test_concurrency.py",
    "tests/helpers/test_fork_safety.py",
    "tests/test_goldens.py",
    "tests/test_imports.py",
    "tests/test_pages.py",
    "tests/test_random_materials.py",
    "tests/test_typed.py",
    "tests/viewer/app/test_building.py",
    "tests/viewer/app/test_monkey.py",
    "tests/viewer/editing/test_every_kind.py",
)


def is_slow(test: str) -> bool:
    """Whether a test, or a file of tests, is one that `make quick` leaves out."""
    return test.startswith(SLOW)


def file_of(test: str) -> str:
    """Return the file of a test, such as tests/shapes/test_torus.py::test_a_waist[0.1]."""
    return test.split("::", maxsplit=1)[0]


@cache
def opens_windows(file: str) -> bool:
    """Whether tests of a file open windows, by the mark in its source."""
    return "pytest.mark.window" in (ROOT / file).read_text(encoding="utf-8")


def work_group(test: str) -> str:
    """Return the name of the group of tests that run in one process with a test."""
    file = file_of(test)
    return GROUPS.get(file) or (WINDOWS if opens_windows(file) else file)


def order(test: str) -> int:
    """Sort key of a test: the largest groups come first."""
    group = work_group(test)
    return LARGEST.index(group) if group in LARGEST else len(LARGEST)


def make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Make a scheduler of pytest-xdist for these groups, in pytest's order."""
    from xdist.scheduler import LoadScopeScheduling

    class GroupScheduling(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return work_group(nodeid)

    config.option.loadscopereorder = False
    return GroupScheduling(config, log)
