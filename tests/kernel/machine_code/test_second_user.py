"""A cache folder that users share: each user's pictures are right, and nobody runs what another has compiled.

It needs root, to run programs as other users.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.kernel.machine_code.package_copies import copy_package
from tests.kernel.machine_code.test_cache_folder import KERNELS, RENDER, SCENE
from tests.processes import run

FIRST, SECOND = 54321, 54322  # users that no machine has


def as_user(user: int, *command: str) -> list[str]:
    """Return a command that runs another one as a user without groups, for whom all that he writes is for everybody.

    The user may read all files, as the interpreter may be in a folder of root.
    """
    rights = (f"--{kind}-caps=+dac_read_search" for kind in ("inh", "ambient"))
    run_it = ("sh", "-c", 'umask 000; exec "$@"', "sh", *command)
    return ["setpriv", f"--reuid={user}", f"--regid={user}", "--clear-groups", *rights, *run_it]


def can_run_as_others() -> bool:
    """Whether programs can be run as other users, with this interpreter."""
    if sys.platform != "linux" or os.geteuid() or not shutil.which("setpriv"):
        return False
    return run(as_user(FIRST, sys.executable, "-c", "import numba"), cwd="/").returncode == 0


pytestmark = pytest.mark.skipif(not can_run_as_others(), reason="needs root, to run programs as others: sudo make test")


@pytest.fixture
def shared() -> Iterator[Path]:
    """Return a folder that everybody may read and write, with a copy of the package and a scene."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o777)
        copy_package(folder)
        (folder / "ball.rt").write_text(SCENE)
        yield folder


def render(user: int, shared: Path) -> tuple[list[str], str]:
    """Render as a user; return what `RENDER` prints (folder, kernels loaded and compiled, pixel), and the notices."""
    variables = {"XDG_CACHE_HOME": str(shared / "cache"), "PYTHONPATH": str(shared), "PYTHONDONTWRITEBYTECODE": "1"}
    command = as_user(user, sys.executable, "-c", RENDER)
    ended = run(command, cwd=shared, env=os.environ | variables | {"HOME": str(shared)}, text=True)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout.strip().split(" ", 3), ended.stderr


def contents(folder: Path) -> dict[Path, tuple[int, bytes]]:
    """Return the owner and the bytes of each file in a folder."""
    return {path: (path.stat().st_uid, path.read_bytes()) for path in folder.rglob("*") if path.is_file()}


def test_a_second_user_compiles_for_himself_and_draws_the_same(shared: Path) -> None:
    (_, *first), notices = render(FIRST, shared)
    assert (first, notices) == (["0", KERNELS, "[10, 20, 30]"], "")
    kept = contents(shared / "cache")
    assert {owner for owner, _ in kept.values()} == {FIRST}
    for path in (shared / "cache").rglob("*"):
        path.chmod(0o777)  # as if the first user wanted the second one to use it
    second, notices = render(SECOND, shared)
    assert second == ["None", "0", KERNELS, "[10, 20, 30]"]
    (notice,) = notices.splitlines()
    assert notice.startswith("notice: every run compiles anew")
    assert "belongs to another user" in notice
    assert contents(shared / "cache") == kept
