"""Temporary folder of a report, which the next report deletes if this program is killed."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from minirt.helpers import file_io

PREFIX = "minirt-report-"


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Make a folder for the block. Folders of killed programs are deleted: their locks are free."""
    parent = Path(tempfile.gettempdir())
    for each in parent.glob(f"{PREFIX}*"):
        with suppress(OSError):
            delete_if_abandoned(each)
    with ExitStack() as stack:
        made = locked_folder(stack)
        stack.callback(shutil.rmtree, made, ignore_errors=True)
        yield made


def locked_folder(stack: ExitStack) -> Path:
    """Make a folder, and lock it until the stack ends."""
    while True:
        made = Path(tempfile.mkdtemp(prefix=PREFIX))
        if sys.platform == "win32":  # where folders cannot be opened
            return made
        with suppress(FileNotFoundError):  # another program took it for abandoned, before it was locked
            descriptor = os.open(made, os.O_RDONLY)
            stack.callback(os.close, descriptor)
            file_io.lock(descriptor)
            made.stat()
            return made


def delete_if_abandoned(folder: Path) -> None:
    """Delete a folder of this user that no program has locked. OSError."""
    if sys.platform == "win32":
        return
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        if os.fstat(descriptor).st_uid == os.geteuid() and file_io.is_free(descriptor):
            shutil.rmtree(folder, ignore_errors=True)
    finally:
        os.close(descriptor)
