"""Folder of compiled kernels, which later runs load.

The name of the folder is a hash of all sources of a kernel and of the processor: after a change of a shape's formula
the old machine code is not found. The folder is closed to other users, since what is in it is run.
"""

from __future__ import annotations

import hashlib
import logging
import os
import shutil
from contextlib import suppress
from functools import cache
from pathlib import Path

from minirt.helpers.file_io import PRIVATE_FOLDER, user_folder
from minirt.kernel.machine_code.private_files import make_private_folder
from minirt.kernel.machine_code.processor import described, processor
from minirt.kernel.machine_code.source_files import source_files

PACKAGE = Path(__file__).parents[2]
SOURCES = ("kernel", "lanes", "shapes")  # folders of all sources of a kernel
OTHER_VERSIONS = 8  # folders of other versions that are not deleted, so that versions can be used in turn
TOLD: set[str] = set()  # notices that were given


@cache
def fingerprint_of(name: str) -> str:
    """Return a hash of the sources and of the processor of a name: see `minirt.kernel.machine_code.processor`."""
    digest = hashlib.sha256(described(name).encode())
    for folder in SOURCES:
        for path, source in source_files(PACKAGE / folder, folder):
            digest.update(path.encode() + b"\0" + source)
    return digest.hexdigest()[:16]


def fingerprint() -> str:
    """Return the hash of the sources and of the processor that is compiled for."""
    return fingerprint_of(processor())


def folder() -> Path | None:
    """Return the folder for kernels of these sources, made if need be.

    None, with a notice, if it cannot be written, or if others could have written to it."""
    try:
        path = user_folder() / "minirt" / f"kernels-{fingerprint()}"
        path.parents[1].mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
        for each in (path.parent, path):
            make_private_folder(each)
        probe = path / f"probe-{os.getpid()}"
        probe.touch()  # marks the folder as used now, too: `delete_old_folders`
        probe.unlink()
    except (OSError, RuntimeError) as error:  # RuntimeError: the user has no home
        notice("every run compiles anew, kernels cannot be kept: %s", error)
        return None
    with suppress(OSError):
        delete_old_folders(path)
    return path


def notice(message: str, *values: object) -> None:
    """Tell the user something once, with values in the places that are marked by %s."""
    if message not in TOLD:
        TOLD.add(message)
        logging.getLogger(__name__).warning(f"notice: {message}", *values)


def delete_old_folders(current: Path) -> None:
    """Delete the folders of other sources, except the `OTHER_VERSIONS` that were used last."""
    others = [each for each in current.parent.glob("kernels-*") if each != current]
    others.sort(key=lambda each: each.stat().st_mtime)
    for each in others[: max(0, len(others) - OTHER_VERSIONS)]:
        shutil.rmtree(each, ignore_errors=True)
