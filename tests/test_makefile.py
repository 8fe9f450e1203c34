"""The Makefile lists its targets and makes the program by default."""

from __future__ import annotations

import os
import re
import shutil

import pytest

from tests.paths import ROOT
from tests.processes import run

MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")

OUTSIDE = {name: value for name, value in os.environ.items() if not re.match("M(AKE|FLAGS)", name)}  # of another make

pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="needs make: apt-get install make")


def test_help_lists_every_target() -> None:
    done = run(["make", "--no-print-directory", "help"], cwd=ROOT, env=OUTSIDE, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    told = {word for line in lines for word in line.removeprefix("make ")[:18].split()}
    (targets,) = re.findall(r"^\.PHONY: (.*)$", MAKEFILE, re.MULTILINE)
    assert told == set(targets.split())
    assert all(len(line) > 25 for line in lines)


def test_the_program_comes_first() -> None:
    """`make` alone makes it, as the subject asks."""
    done = run(["make", "--dry-run", "--always-make"], cwd=ROOT, env=OUTSIDE, text=True)
    assert "pip" in done.stdout
    program, kernels = done.stdout.index("touch .venv/bin/miniRT"), done.stdout.index("touch .venv/.kernels")
    assert program < kernels


def test_showing_a_scene_does_not_wait_for_generic_kernels() -> None:
    done = run(["make", "--dry-run", "--always-make", "run"], cwd=ROOT, env=OUTSIDE, text=True)
    assert "touch .venv/bin/miniRT" in done.stdout
    assert "ahead_of_time" not in done.stdout


def test_test_files_that_it_names_exist() -> None:
    named = re.findall(r"\btests/[\w/]+\.py\b", MAKEFILE)
    assert len(named) > 5
    assert [path for path in named if not (ROOT / path).is_file()] == []
