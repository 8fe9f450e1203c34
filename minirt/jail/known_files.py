"""List of the picture files that were decoded well, by digest, in the user's cache folder.

Whoever can write the list can have a file decoded outside of the helper process. So a list that belongs to another
user, or that others may write, is not read. Without a list every file goes to the helper, and nothing else changes.
"""

from __future__ import annotations

import errno
import os
import stat
from contextlib import suppress
from hashlib import blake2b
from pathlib import Path

from minirt.helpers.file_io import PRIVATE_FILE, PRIVATE_FOLDER, is_private, user_folder

NAME = "decoded-pictures"
DIGEST_SIZE = 32  # bytes
MOST = 2**18  # bytes of the list: 4,000 files
SAFELY = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)  # no link, and no waiting for a pipe


def digest_of(data: bytes) -> str:
    """Return the digest of a file for the version of Pillow that decodes it: another one may have other errors."""
    from PIL import __version__

    return blake2b(data, digest_size=DIGEST_SIZE, person=__version__.encode()[: blake2b.PERSON_SIZE]).hexdigest()


def path() -> Path:
    """Return the path of the list; RuntimeError where the user has no home."""
    return user_folder() / "minirt" / NAME


def open_list(mode: int) -> int:
    """Open the list and return its descriptor; OSError where it is missing, or where others may have written it."""
    file = path()
    if not is_private(file.parent.stat()):
        raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))
    descriptor = os.open(file, mode | SAFELY, PRIVATE_FILE)
    status = os.fstat(descriptor)  # of the file that is read, whatever has the name by now
    if stat.S_ISREG(status.st_mode) and is_private(status):
        return descriptor
    os.close(descriptor)
    raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))


def known() -> set[str]:
    """Return the digests in the list; none where it cannot be read or trusted."""
    with suppress(OSError, RuntimeError), os.fdopen(open_list(os.O_RDONLY), "rb") as file:
        return set(file.read(MOST).decode("ascii", "replace").split())
    return set()


def add(digests: list[str]) -> None:
    """Add digests to the list, if it can be written and trusted. A list that has become too long begins anew."""
    with suppress(OSError, RuntimeError):
        path().parent.mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
        with os.fdopen(open_list(os.O_WRONLY | os.O_CREAT | os.O_APPEND), "ab") as file:
            lines = "".join(f"{each}\n" for each in digests).encode()
            if file.tell() + len(lines) > MOST:
                file.truncate(0)
            file.write(lines)  # in one piece, so that programs that add at the same moment do not mix their lines
