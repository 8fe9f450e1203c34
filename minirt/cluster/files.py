"""Files by content: textures and meshes are kept in this user's cache under the SHA-256 of their bytes.

A worker asks only for files that its machine does not have. What is read is compared with its name first, so that a
damaged file is one that is missing.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import shutil
import tempfile
import time
from contextlib import suppress
from functools import cache
from pathlib import Path

from minirt.helpers import file_io
from minirt.helpers.file_io import PRIVATE_FILE, PRIVATE_FOLDER, user_folder
from minirt.kernel.machine_code.cache import make_private_folder

UNUSED = 30 * 24 * 3600  # seconds after which a file is deleted

checked: set[str] = set()  # digests of files that this process has compared with their names


@cache
def folder() -> Path:
    """Return the folder of the files, made if need be: a temporary one where the user's cache cannot be written."""
    try:
        path = user_folder() / "minirt" / "files"
        path.parents[1].mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
        for each in (path.parent, path):
            make_private_folder(each)
        delete_unused(path)
        if os.access(path, os.W_OK | os.X_OK):
            return path
    except (OSError, RuntimeError):  # RuntimeError: the user has no home
        pass
    temporary = tempfile.mkdtemp(prefix="minirt-")
    atexit.register(shutil.rmtree, temporary, ignore_errors=True)
    return Path(temporary)


def delete_unused(path: Path) -> None:
    """Delete files that nobody has used for a month."""
    for each in path.iterdir():
        with suppress(OSError):
            if time.time() - each.stat().st_mtime > UNUSED:
                each.unlink()


def digest_of(data: bytes) -> str:
    """Return the digest of some content."""
    return hashlib.sha256(data).hexdigest()


def keep(data: bytes) -> str:
    """Keep a file and return its digest; OSError where it cannot be written."""
    digest = digest_of(data)
    if not has(digest):
        file_io.write(folder() / digest, data, PRIVATE_FILE)
        checked.add(digest)
    return digest


def has(digest: str) -> bool:
    """Whether there is an undamaged file with a digest; it counts as used now."""
    path = folder() / digest
    try:
        if digest not in checked or not path.exists():
            if digest_of(path.read_bytes()) != digest:
                return False
            checked.add(digest)
        os.utime(path)
    except OSError:
        return False
    return True


def read(digest: str) -> bytes:
    """Return the content of a file that is there; OSError otherwise."""
    return (folder() / digest).read_bytes()
