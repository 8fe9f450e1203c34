"""A small file system that is full, for programs in tests. It needs root on Linux, which may mount one."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from tests.cli.program import environment
from tests.processes import run

PAGE = 4096  # bytes: files of a tmpfs consist of whole pages
SCRIPT = """
mount -t tmpfs -o size=128k tmpfs "$1" && cp -a "$2"/. "$1" && cd "$1" || exit 99
free=$3
cat /dev/zero >filler 2>/dev/null
truncate -s "-$free" filler
shift 3
"$@"
status=$?
rm filler
cp -a . ../left
exit $status
"""


def can_mount() -> bool:
    """Whether this process may mount a file system for a program alone."""
    if sys.platform != "linux" or os.geteuid() or not shutil.which("unshare"):
        return False
    return run(["unshare", "-m", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]).returncode == 0


needs_mount = pytest.mark.skipif(not can_mount(), reason="needs root, to mount a small file system: sudo make test")


def run_on_full_disk(
    folder: Path, files: Mapping[str, bytes], command: Sequence[str], pages: int, **variables: str
) -> tuple[int, str, str, dict[str, bytes]]:
    """Run a command in a folder of a file system with some files and some free pages.

    Return its status, standard output and standard error, and the files in the folder afterwards by their paths. The
    variables are added to the environment.
    """
    disk, before, left = folder / "disk", folder / "before", folder / "left"
    for each in (disk, before):
        each.mkdir()
    for name, data in files.items():
        (before / name).write_bytes(data)
    arguments = ["unshare", "-m", "sh", "-c", SCRIPT, "sh", str(disk), str(before), str(pages * PAGE), *command]
    ended = run(arguments, cwd=folder, env=environment() | variables, text=True)
    assert ended.returncode != 99, ended.stderr
    found = {str(path.relative_to(left)): path.read_bytes() for path in left.rglob("*") if path.is_file()}
    return ended.returncode, ended.stdout, ended.stderr, found
