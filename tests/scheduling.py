"""Which process runs which tests: files as a whole, so that what a file prepares is prepared once. Some files are one
piece of work: all that open windows, which share a screen, and all that compile the kernels of all scenes."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

from tests.paths import ROOT

WINDOWS, SCENES = "windows", "scenes"
FIRST = (WINDOWS, SCENES)  # they take longest
OF_SCENES = {"tests/test_goldens.py", "tests/stability/test_pictures.py", "tests/rendering/queries/test_preview.py"}

# What `make quick` leaves out: these take two thirds of the time of all tests that open no window.
SLOW = {
    "tests/bench/yardstick/test_yardstick.py",
    "tests/kernel/bvh/test_queries.py",
    "tests/kernel/compiler/test_cache_folder.py",
    "tests/kernel/compiler/test_documented_pipeline.py",
    "tests/kernel/compiler/test_specialisation.py",
    "tests/kernel/shading/test_texturing.py",
    "tests/lanes/test_operators.py",
    "tests/materials/test_textures.py",
    "tests/rendering/queries/test_pick.py",
    "tests/rendering/queries/test_preview.py",
    "tests/rendering/running/test_compile_process.py",
    "tests/rendering/sampling/test_auto.py",
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
    "tests/test_random_materials.py",
    "tests/viewer/app/test_monkey.py",
    "tests/viewer/editing/test_every_kind.py",
}


def is_slow(test: str) -> bool:
    """Whether a test is in one of the slow files."""
    return file_of(test) in SLOW


def file_of(test: str) -> str:
    """The file of a test, such as tests/shapes/test_torus.py::test_a_waist[0.1]."""
    return test.split("::", maxsplit=1)[0]


@cache
def opens_windows(file: str) -> bool:
    """Whether tests of a file open windows: whether its source has the mark."""
    return "pytest.mark.window" in (ROOT / file).read_text(encoding="utf-8")


def piece_of_work(test: str) -> str:
    """The name of all that a test is run together with, in one process."""
    file = file_of(test)
    return SCENES if file in OF_SCENES else WINDOWS if opens_windows(file) else file


def order(test: str) -> int:
    """A number by which tests are sorted."""
    piece = piece_of_work(test)
    return FIRST.index(piece) if piece in FIRST else len(FIRST)


def make_scheduler(config: pytest.Config, log: Any) -> Any:
    """The scheduler of pytest-xdist for these pieces of work, in the order in which pytest has them."""
    from xdist.scheduler import LoadScopeScheduling

    class Pieces(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return piece_of_work(nodeid)

    config.option.loadscopereorder = False
    return Pieces(config, log)
