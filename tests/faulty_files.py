"""Faults of a disk, and kills, at each write to a file in turn: `minirt.helpers.file_io` writes to counting files.

A fault is a function that is called before a write with its data; what it returns is written, so that an error fails
the write, and fewer bytes are a short one.
"""

from __future__ import annotations

import errno
import io
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from tests.processes import in_child

Fault = Callable[[memoryview], memoryview]

BUFFER = 256  # bytes of the largest write, so that even a small file takes several
CODES = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG)


class FaultyFile(io.FileIO):
    """A file whose writes suffer from a fault."""

    fault: Fault

    def write(self, data: Any) -> int:
        """Write what the fault leaves of the first bytes."""
        return super().write(self.fault(memoryview(data).cast("B")[:BUFFER]))


@contextmanager
def faulty_files(fault: Fault) -> Iterator[None]:
    """Let all writes to files that this thread opens by their descriptors suffer from a fault."""

    def open_faulty(descriptor: int, mode: str = "r", *others: Any, **named: Any) -> Any:
        if mode != "wb":
            return fdopen(descriptor, mode, *others, **named)
        raw = FaultyFile(descriptor, "wb")
        raw.fault = fault
        return io.BufferedWriter(raw, BUFFER)

    fdopen = os.fdopen
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fdopen", open_faulty)
        yield


def counting(counted: list[int]) -> Fault:
    """Return a fault that only notes the lengths of the writes."""

    def note(data: memoryview) -> memoryview:
        counted.append(len(data))
        return data

    return note


def failing_at(number: int, code: int) -> Fault:
    """Return a fault that fails at a write, counted from 0, and at all that follow, as a full disk does."""
    left = number

    def fail(data: memoryview) -> memoryview:
        nonlocal left
        left -= 1
        if left < 0:
            raise OSError(code, os.strerror(code))
        return data

    return fail


def short(data: memoryview) -> memoryview:
    """Write a part only, and now and then nothing at once, as interrupted by a signal."""
    if len(data) % 5 == 4:
        return data[: len(data) - 1]
    return data[: -(-len(data) // 3)]


def is_killed_at(work: Callable[[], object], number: int) -> bool:
    """Do work in a child process that is killed before a write, counted from 0; False where it ended before that."""
    left = number

    def kill(data: memoryview) -> memoryview:
        nonlocal left
        if not left:
            os.kill(os.getpid(), signal.SIGKILL)
        left -= 1
        return data

    def faulty() -> None:
        with faulty_files(kill):
            work()

    status = in_child(faulty)
    assert status in (0, -signal.SIGKILL), "the work failed"
    return status != 0
