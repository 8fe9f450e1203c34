"""Cache of compiled kernels on disk: a file with object code and names for each function and signature.

No fault of the disk prevents a picture: a kernel that cannot be read is compiled, one that cannot be written stays in
memory, each with one notice.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeAlias

from minirt.kernel.machine_code import container, private_files
from minirt.kernel.machine_code.cache_folder import notice

ObjectCode: TypeAlias = tuple[dict[str, Any], bytes]  # the names and the code of a container


def file_name(identity: str) -> str:
    """Return the name of the file of a kernel."""
    return f"{sha256(identity.encode()).hexdigest()[:24]}.kernel"


class CodeCache:
    """Writes and finds object code in a folder that belongs to this user alone."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def file_of(self, identity: str) -> Path:
        """Return the path of the file of a kernel."""
        return self.folder / file_name(identity)

    def read(self, identity: str) -> ObjectCode | None:
        """Return the names and the object code of a kernel; None without a good file. A bad file is deleted."""
        path = self.file_of(identity)
        try:
            data = private_files.read(path)
            return container.unpack(private_files.key_of(self.folder), identity, data)
        except FileNotFoundError:
            return None
        except (OSError, container.DamagedError) as error:
            notice("a kernel in %s is deleted and compiled anew: %s", self.folder, error)
            with suppress(OSError):
                path.unlink()
            return None

    def write(self, identity: str, code: ObjectCode) -> None:
        """Write the object code of a kernel; do nothing but give a notice where it cannot be written."""
        try:
            data = container.pack(private_files.key_of(self.folder), identity, *code)
            private_files.write(self.file_of(identity), data)
        except OSError as error:
            notice("every run compiles anew, a kernel cannot be kept in %s: %s", self.folder, error)

    @contextmanager
    def compiling_once(self, identity: str) -> Iterator[None]:
        """Let other processes that need a kernel wait during this block."""
        with private_files.locked(self.file_of(identity).with_suffix(".lock")):
            yield
