"""Child processes and process groups of a program, read from /proc (Linux)."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path


def compilers(program: int) -> list[int]:
    """Return the ids of the compiler processes of a program."""
    return [
        each
        for each in processes()
        if parent(each) == program and "from minirt.kernel.compiler import main; main()" in arguments(each)
    ]


def group(program: int) -> list[int]:
    """Return the ids of the running processes in the process group of a program, which has the program's id."""
    return [each for each in processes() if state(each)[0] not in "ZX" and state(each)[2] == str(program)]


def processes() -> list[int]:
    """Return the ids of all processes of the machine."""
    return [int(folder.name) for folder in Path("/proc").glob("[0-9]*")]


def processor_time(process: int) -> int:
    """Return the processor time that a process has used, in ticks of the system; 0 if it has ended."""
    user, kernel = state(process, 13)[11:] or (0, 0)
    return int(user) + int(kernel)


def parent(process: int) -> int:
    """Return the id of the parent process."""
    return int(state(process)[1])


def arguments(process: int) -> list[str]:
    """Return the command line; an empty list if the process has ended."""
    with suppress(OSError):
        return Path(f"/proc/{process}/cmdline").read_text().split("\0")
    return []


def state(process: int, fields: int = 3) -> list[str]:
    """Return the state letter, parent and group of a process, and further fields; the letter is X if it has ended."""
    with suppress(OSError):
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[:fields]
    return ["X", "0", "0"]
