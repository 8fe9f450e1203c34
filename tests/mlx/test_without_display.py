"""Programs on a machine without a screen: imports work, and errors say what to do."""

from __future__ import annotations

import os
import sys

from tests import processes
from tests.paths import ROOT

NO_SCREEN = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}


def run(program: str) -> str:
    """Run a program without a screen and return its output."""
    command = [sys.executable, "-W", "error", "-c", program]
    done = processes.run(command, env=NO_SCREEN | {"PYTHONPATH": str(ROOT)}, text=True)
    assert done.stderr == ""
    return str(done.stdout)


def test_the_import_loads_no_window_library() -> None:
    program = (
        "import sys, minirt.mlx, minirt.mlx.memory; print([n for n in ('pyglet', 'PIL', 'numba') if n in sys.modules])"
    )
    assert run(program) == "[]\n"


def test_no_display_is_an_error_with_advice_each_time() -> None:
    program = """
from minirt.mlx import Mlx, MlxError
for _ in range(2):
    try:
        Mlx(strict=True).mlx_init()
    except MlxError as error:
        print("-o FILE" in str(error), "no display" in str(error))
"""
    if sys.platform == "linux":
        assert run(program) == "True True\n" * 2
