"""No fault of the disk prevents a picture: kernels that cannot be kept stay in memory, with one notice."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path
from typing import Any

import pytest

from minirt.kernel.machine_code import cache_folder, private_files
from tests.kernel.machine_code.package_copies import copy_package
from tests.kernel.machine_code.small_kernels import double, file_of, is_found, square
from tests.processes import run

FAULTS = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EROFS, errno.EACCES)
FULL = """
import resource
resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))  # every write to a file fails, as on a full disk
import minirt
scene = minirt.load("ball.rt")
minirt.renderer(None).prepare(scene)
print(minirt.render(scene, 8, 8).array[4, 4].tolist())
"""
SCENE = "A 1 255,255,255\nC 0,0,0 0,0,1 60\nsp 0,0,5 4 10,20,30\n"


@pytest.fixture(autouse=True)
def fresh_notices(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each test see its notices as if none had been given before."""
    monkeypatch.setattr(cache_folder, "TOLD", set())


def failing(code: int) -> Any:
    """Return a function that fails as the disk would."""

    def fail(*_: object, **__: object) -> None:
        raise OSError(code, os.strerror(code))

    return fail


@pytest.mark.parametrize("code", FAULTS)
@pytest.mark.parametrize("call", ["fsync", "replace"])
def test_a_kernel_that_cannot_be_written_is_used_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, code: int, call: str
) -> None:
    owner = {"fsync": os, "replace": Path}[call]
    with monkeypatch.context() as patch:
        patch.setattr(owner, call, failing(code))
        assert not is_found(double, tmp_path)
        assert not is_found(square, tmp_path)
    (told,) = caplog.messages
    assert told.startswith("notice: every run compiles anew")
    assert os.strerror(code) in told
    assert not any(path.suffix != ".lock" for path in tmp_path.iterdir()), "nothing half written is left behind"


@pytest.mark.parametrize("code", FAULTS)
def test_a_kernel_that_cannot_be_read_is_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, code: int
) -> None:
    is_found(double, tmp_path)
    with monkeypatch.context() as patch:
        patch.setattr(private_files, "read", failing(code))
        assert not is_found(double, tmp_path)
    assert os.strerror(code) in caplog.messages[0]
    assert is_found(double, tmp_path)


def test_a_kernel_that_can_be_neither_read_nor_deleted_is_compiled(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    is_found(double, tmp_path)
    path = file_of(double, tmp_path)
    path.unlink()
    path.mkdir()
    (path / "file").touch()
    assert not is_found(double, tmp_path)
    assert all(message.startswith("notice: ") for message in caplog.messages)
    assert len(caplog.messages) == 2  # neither read nor written


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such limit")
def test_a_picture_is_rendered_where_no_file_can_grow(tmp_path: Path) -> None:
    (tmp_path / "ball.rt").write_text(SCENE)
    variables = {"XDG_CACHE_HOME": str(tmp_path / "cache"), "PYTHONPATH": str(copy_package(tmp_path).parent)}
    environment = os.environ | variables | {"PYTHONDONTWRITEBYTECODE": "1"}
    ended = run([sys.executable, "-c", FULL], cwd=tmp_path, env=environment, text=True)
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout == "[10, 20, 30]\n"
    (notice,) = ended.stderr.splitlines()
    assert notice.startswith("notice: every run compiles anew")
    assert os.strerror(errno.EFBIG) in notice
