"""Kernels that were compiled ahead of time and came with the package, in a folder that is only read.

The installer vouches for their origin, as for that of all sources; a digest finds damage.
"""

from __future__ import annotations

from minirt.kernel.machine_code import container
from minirt.kernel.machine_code.cache_folder import PACKAGE
from minirt.kernel.machine_code.code_cache import ObjectCode, file_name

FOLDER = PACKAGE / "kernel" / "ahead_of_time"
NO_KEY = b""


def read(identity: str) -> ObjectCode | None:
    """Return the names and the object code of a kernel; None where the package has none for it, or a damaged one.

    Those for other sources and other processors have other names, and so are not found.
    """
    try:
        return container.unpack(NO_KEY, identity, (FOLDER / file_name(identity)).read_bytes())
    except (OSError, container.DamagedError):
        return None
