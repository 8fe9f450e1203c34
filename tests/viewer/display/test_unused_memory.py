"""Memory that is given back to the system: once after each resize or reload, and really."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from minirt.viewer.app import session
from minirt.viewer.display import screen
from tests.processes import run
from tests.viewer.fake import played

PROGRAM = """
from threading import Thread
import numpy as np
from minirt.viewer.app import session
from minirt.viewer.display import screen
from tests.usage import Usage

def work():
    np.ones(2 * 2**20)  # glibc takes blocks up to this size from the heap afterwards
    blocks = [np.ones(2**17) for _ in range(100)]  # a mebibyte each
    kept.extend(blocks[::10])

kept = []
screen.use_one_heap()
thread = Thread(target=work)
thread.start()
thread.join()
usages = [Usage.of().memory]
screen.give_back_memory()
usages.append(Usage.of().memory)
print(usages[0] - usages[1], sum(block.nbytes for block in kept), all((block == 1).all() for block in kept))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="only glibc can give memory back")
def test_free_blocks_between_used_ones_are_given_back() -> None:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("MALLOC_")}  # set by dask
    done = run([sys.executable, "-c", PROGRAM], text=True, env=environment)
    given_back, kept, are_whole = done.stdout.split()
    assert done.returncode == 0, done.stderr
    assert int(given_back) > 80e6
    assert int(kept) == 10 * 2**20
    assert are_whole == "True"


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (["press d", "press T", "click 5,5", "wait 1"], 0),
        (["resize 40x30", "wait 1", "press d", "wait 1"], 1),
        (["press Ctrl+S", "press d", "wait 1", "press Ctrl+R", "wait 1", "press d", "wait 1"], 1),
        (["resize 40x30", "wait 1", "press d", "resize 64x48", "wait 1", "press d", "wait 1"], 2),
    ],
)
def test_memory_is_given_back_once_after_a_resize_or_a_reload(
    lines: list[str], expected: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    calls: list[None] = []
    monkeypatch.setattr(session, "give_back_memory", lambda: calls.append(None))
    played(*lines, path=tmp_path / "scene.rt")
    assert len(calls) == expected


def test_other_systems_have_no_such_functions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(screen.ctypes, "CDLL", lambda _: object())
    screen.use_one_heap()
    screen.give_back_memory()
