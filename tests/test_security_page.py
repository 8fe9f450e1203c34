"""SECURITY.md names the limits and the lowest versions of dependencies as they are."""

from __future__ import annotations

import re

from minirt.helpers.file_io import LARGEST_ASSET
from minirt.jail.confinement import CALLS
from minirt.jail.decoder import FORMATS, SIDE
from minirt.jail.messages import CPU_TIME, MEMORY
from minirt.jail.pipes import LONGEST_WAIT
from minirt.meshes import MAX_BYTES
from minirt.meshes.obj import MAX_LINES, MAX_TRIANGLES
from minirt.scene import files
from tests.jail.breakouts import ACTS
from tests.lowest_versions import lowest_versions
from tests.pages import read

PAGE = read("SECURITY.md")


def test_the_limits_are_those_of_the_program() -> None:
    flat = re.sub(r"\s+", " ", PAGE)
    assert f"A scene file has {files.MAX_BYTES // 2**20} MiB and {files.MAX_LINES:,} lines at most" in flat
    assert f"up to {LARGEST_ASSET // 2**20} MiB and of {SIDE}x{SIDE} pixels are read, in nine raster formats" in flat
    assert len((*FORMATS, "XPM")) == 9
    assert f"{CPU_TIME} s of processor time, {MEMORY // 2**30} GiB of memory" in flat
    assert f"{LONGEST_WAIT:.0f} s until it has answered" in flat
    assert f"`tests/jail`: {len(ACTS)} acts of a confined process" in flat
    assert f"no system calls but {len(CALLS)} that" in flat
    assert f"A mesh has {MAX_BYTES // 2**20} MiB, {MAX_LINES:,} lines and {MAX_TRIANGLES:,} triangles at most" in flat


def test_the_lowest_versions_are_those_of_the_project() -> None:
    rows = dict(re.findall(r"^\| (\w+)(?:, with llvmlite)? \| ([\d.]+) \|", PAGE, re.MULTILINE))
    assert {f"{name.lower()}=={version}" for name, version in rows.items()} == set(lowest_versions())
