"""Cache of compiled kernels on disk: a file with object code for each function and signature.

Kernels that are compiled here are kept in a folder of this user. It is trusted as numba's own cache is: it belongs to
the user and nobody else may write it. Others were compiled ahead of time and came with the package, in a folder for
each processor. A checksum finds damaged files, which are compiled anew, and nothing is unpickled. No fault of the disk
prevents a picture.
"""

from __future__ import annotations

import hashlib
import logging
import os
import shutil
import time
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

from minirt.helpers import file_io
from minirt.helpers.file_io import PRIVATE_FOLDER, is_private, user_folder
from minirt.kernel.machine_code.fingerprint import PACKAGE, fingerprint_of, processor

SHIPPED = PACKAGE / "kernel" / "ahead_of_time"  # folders of the kernels that came with the package
OTHER_VERSIONS = 8  # folders of other sources that are not deleted, so that versions can be used in turn
READABLE = 0o644  # by all users of an installed package
CHECKSUM_SIZE = 16  # bytes
PATIENCE = 60.0  # seconds; no kernel takes as long to compile
POLL = 0.01  # seconds between two attempts to lock a file
TOLD: set[str] = set()  # notices that were given


class ObjectCode(NamedTuple):
    """A compiled kernel."""

    entry: str  # name of its entry point
    code: bytes  # object code in the format of the system


class CodeCache:
    """The kernels in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def file_of(self, identity: str) -> Path:
        """Return the path of the file of a kernel."""
        return self.folder / f"{hashlib.sha256(identity.encode()).hexdigest()[:24]}.kernel"

    def read(self, identity: str) -> ObjectCode | None:
        """Return a kernel; None without a good file."""
        try:
            return unpack(identity, self.file_of(identity).read_bytes())
        except (FileNotFoundError, NotADirectoryError):
            return None
        except (OSError, ValueError) as error:
            notice("a kernel in %s is compiled anew: %s", self.folder, error)
            return None

    def write(self, identity: str, kernel: ObjectCode) -> None:
        """Write a kernel as a whole. OSError where that is impossible."""
        file_io.write(self.file_of(identity), pack(identity, kernel), READABLE)

    def keep(self, kernels: dict[str, ObjectCode]) -> None:
        """Write kernels, by their identities; do nothing but give a notice where that is impossible."""
        try:
            for identity, kernel in kernels.items():
                self.write(identity, kernel)
        except OSError as error:
            notice("every run compiles anew, a kernel cannot be kept in %s: %s", self.folder, error)

    def delete_others(self, identities: Iterable[str]) -> None:
        """Delete the kernels that are none of these: those of older sources."""
        for path in set(self.folder.glob("*.kernel")) - set(map(self.file_of, identities)):
            path.unlink(missing_ok=True)

    @contextmanager
    def compiling_once(self, identity: str) -> Iterator[None]:
        """Let other processes that need the kernel `identity` wait during this block, or till this process ends.

        Nobody waits where no file can be locked, as on Windows, nor for more than `PATIENCE` seconds: the process that
        holds a lock may have been suspended.
        """
        with ExitStack() as stack:
            with suppress(OSError):
                file = os.open(
                    self.file_of(identity).with_suffix(".lock"), os.O_WRONLY | os.O_CREAT, file_io.PRIVATE_FILE
                )
                stack.callback(file_io.unlock, file)
                end = time.monotonic() + PATIENCE
                while not file_io.lock(file) and time.monotonic() < end:
                    time.sleep(POLL)
            yield


def pack(identity: str, kernel: ObjectCode) -> bytes:
    """Return a kernel as bytes, with a checksum that covers its identity, too."""
    content = kernel.entry.encode() + b" " + kernel.code
    return checksum(identity, content) + content


def unpack(identity: str, data: bytes) -> ObjectCode:
    """Return the kernel in some bytes; ValueError where any of them is not as `pack` has made it."""
    content = data[CHECKSUM_SIZE:]
    if data[:CHECKSUM_SIZE] != checksum(identity, content):
        raise ValueError("it is damaged")
    entry, code = content.split(b" ", 1)
    return ObjectCode(entry.decode(), code)


def checksum(identity: str, content: bytes) -> bytes:
    """Return the checksum of the identity and the content of a kernel."""
    return hashlib.blake2b(identity.encode() + b"\0" + content, digest_size=CHECKSUM_SIZE).digest()


def folder() -> Path | None:
    """Return the user's folder for kernels of these sources, made if need be.

    None, with a notice, if it cannot be used, or if others could have written to it. Old folders of other sources are
    deleted, see `OTHER_VERSIONS`."""
    try:
        path = user_folder() / "minirt" / f"kernels-{fingerprint_of(processor())}"
        path.parents[1].mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
        for each in (path.parent, path):
            make_private_folder(each)
        os.utime(path)  # the folder used last is the last to be deleted
    except (OSError, RuntimeError) as error:  # RuntimeError: the user has no home
        notice("every run compiles anew, kernels cannot be kept: %s", error)
        return None
    with suppress(OSError):
        delete_old_folders(path)
    return path


def make_private_folder(path: Path) -> None:
    """Make a folder for this user alone, unless it is there.

    PermissionError where it belongs to another user or others may write it; OSError where it cannot be made."""
    path.mkdir(mode=PRIVATE_FOLDER, exist_ok=True)
    status = path.stat()
    if not is_private(status):
        if status.st_uid != os.geteuid():
            raise PermissionError(f"{path} belongs to another user; XDG_CACHE_HOME can name a folder of yours")
        raise PermissionError(f"other users may write {path}; chmod go-w '{path}' mends that")


def delete_old_folders(current: Path) -> None:
    """Delete the folders of other sources, except the `OTHER_VERSIONS` that were used last."""
    others = [each for each in current.parent.glob("kernels-*") if each != current]
    others.sort(key=lambda each: each.stat().st_mtime)
    for each in others[: max(0, len(others) - OTHER_VERSIONS)]:
        shutil.rmtree(each, ignore_errors=True)


def notice(message: str, *values: object) -> None:
    """Tell the user something once, with values in the places that are marked by %s."""
    if message not in TOLD:
        TOLD.add(message)
        logging.getLogger(__name__).warning(f"notice: {message}", *values)
