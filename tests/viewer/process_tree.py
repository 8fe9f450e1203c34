"""Processes that a program has started, by Linux's numbers."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path


def compilers(program: int) -> list[int]:
    """The processes that compile for the program."""
    return [
        each for each in processes() if parent(each) == program and "minirt.kernel.compiler.process" in arguments(each)
    ]


def group(program: int) -> list[int]:
    """The processes that run in the group of a program, which has its number."""
    return [each for each in processes() if state(each)[0] not in "ZX" and state(each)[2] == str(program)]


def processes() -> list[int]:
    """All processes of the machine."""
    return [int(folder.name) for folder in Path("/proc").glob("[0-9]*")]


def parent(process: int) -> int:
    return int(state(process)[1])


def arguments(process: int) -> list[str]:
    """The command line; nothing where the process has ended."""
    with suppress(OSError):
        return Path(f"/proc/{process}/cmdline").read_text().split("\0")
    return []


def state(process: int) -> list[str]:
    """Its state as a letter, its parent, its group; X where it has ended."""
    with suppress(OSError):
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[:3]
    return ["X", "0", "0"]
