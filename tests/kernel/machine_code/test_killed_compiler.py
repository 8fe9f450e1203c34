"""A compiling process that something else kills is started once more."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from minirt.errors import RenderError
from minirt.kernel.machine_code.compile_process import CompileProcess
from tests.kernel.machine_code.test_compile_process import stand_in


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
@pytest.mark.parametrize(
    ("kills", "reason"), [(1, "the second one has compiled"), (2, "the compiler ended with status -9")]
)
def test_a_compiler_that_is_killed_is_started_once_more(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, kills: int, reason: str
) -> None:
    killed = [tmp_path / str(number) for number in range(kills)]
    code = f"""
import os, sys
from pathlib import Path
for path in {[str(path) for path in killed]}:
    if not os.path.exists(path):
        Path(path).touch()
        os.kill(os.getpid(), 9)
sys.exit("the second one has compiled")  # an error whose message tells that
"""
    stand_in(monkeypatch, code)
    with pytest.raises(RenderError, match=f"^the kernel cannot be compiled: {reason}$"):
        CompileProcess().compile(["a request"])
    assert all(path.exists() for path in killed)
