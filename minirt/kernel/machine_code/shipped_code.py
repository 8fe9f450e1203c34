"""Kernels that were compiled ahead of time and came with the package, in a folder for each processor.

The installer vouches for their origin, as for that of all sources; a digest finds damage.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from minirt.helpers import file_io
from minirt.kernel.machine_code import container
from minirt.kernel.machine_code.cache_folder import PACKAGE
from minirt.kernel.machine_code.code_cache import ObjectCode, file_name
from minirt.kernel.machine_code.processor import processor

FOLDER = PACKAGE / "kernel" / "ahead_of_time"
NO_KEY = b""
READABLE = 0o644


def read(identity: str, folder: Path | None = None) -> ObjectCode | None:
    """Return the names and the object code of a kernel; None where the folder has none for it, or a damaged one.

    A kernel of other sources has another name, and so is not found.
    """
    folder = folder or FOLDER / processor()
    try:
        return container.unpack(NO_KEY, identity, (folder / file_name(identity)).read_bytes())
    except (OSError, container.DamagedError):
        return None


def write(identity: str, code: ObjectCode, folder: Path) -> None:
    """Write a kernel into a folder of the package. OSError where that is impossible."""
    folder.mkdir(parents=True, exist_ok=True)
    file_io.write(folder / file_name(identity), container.pack(NO_KEY, identity, *code), READABLE)


def delete_others(identities: Iterable[str], folder: Path) -> None:
    """Delete the kernels in a folder that are none of these: those of older sources."""
    kept = set(map(file_name, identities))
    for path in folder.glob("*.kernel"):
        if path.name not in kept:
            with suppress(OSError):
                path.unlink()
