"""Distribute tests to processes: each file is a whole, so that its fixtures are made once.

Some files form a group in one process: those that open windows, which share a screen, and those that compile the
kernels of all scenes.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

from tests.paths import ROOT

WINDOWS, SCENES = "windows", "scenes"
LARGEST = (WINDOWS, SCENES)  # the groups that take longest start first
SCENE_TESTS = {
    "tests/test_goldens.py",
    "tests/rendering/packing/test_widening.py",
    "tests/rendering/queries/test_preview.py",
    "tests/stability/test_pictures.py",
}

# Files that `make quick` skips: they take two thirds of the time of all tests that open no window.
SLOW = {
    "tests/bench/yardstick/test_yardstick.py",
    "tests/cli/test_streams.py",
    "tests/kernel/bvh/test_queries.py",
    "tests/kernel/compiler/test_documented_pipeline.py",
    "tests/kernel/compiler/test_specialisation.py",
    "tests/kernel/machine_code/test_cache_folder.py",
    "tests/kernel/machine_code/test_compile_process.py",
    "tests/kernel/machine_code/test_shipped_code.py",
    "tests/kernel/shading/test_texturing.py",
    "tests/lanes/test_operators.py",
    "tests/materials/test_textures.py",
    "tests/rendering/packing/test_widening.py",
    "tests/rendering/queries/test_pick.py",
    "tests/rendering/queries/test_preview.py",
    "tests/rendering/sampling/test_auto.py",
    "tests/rendering/test_extreme_scenes.py",
    "tests/rendering/test_meshes.py",
    "tests/report/measurements/test_formula_errors.py",
    "tests/report/measurements/test_operation_counts.py",
    "tests/report/test_report.py",
    "tests/scene/test_fast.py",
    "tests/scene/test_fuzz.py",
    "tests/scene/test_round_trips.py",
    "tests/shapes/test_mapping.py",
    "tests/shapes/test_protocol.py",
    "tests/stability/test_mutants.py",
    "tests/stability/test_properties.py",
    "tests/stability/test_regimes.py",
    "tests/stability/test_reintersection.py",
    "tests/stability/test_surfaces.py",
    "tests/test_fork_safety.py",
    "tests/test_random_materials.py",
    "tests/viewer/app/test_monkey.py",
    "tests/viewer/editing/test_every_kind.py",
}


def is_slow(test: str) -> bool:
    """Whether a test is in one of the slow files."""
    return file_of(test) in SLOW


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
    return SCENES if file in SCENE_TESTS else WINDOWS if opens_windows(file) else file


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
