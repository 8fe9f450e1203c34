"""Choice of the process that decodes a file: this one for files that are known or trusted, the helper for others."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.helpers.system import ForkSafeLock, renew_after_fork

if TYPE_CHECKING:
    from minirt.jail.decoder import Decoded
    from minirt.jail.helper import Helper


class State:
    """The helper process that open sessions share, and the files that it has decoded."""

    def __init__(self) -> None:
        self.trusts_all = False
        self.trusts_known = True  # files that were decoded well before
        self.sessions = 0
        self.helper: Helper | None = None
        self.of_parent: Helper | None = None  # after a fork
        self.decoded: list[str] = []  # digests
        renew_after_fork(self)

    def after_fork(self) -> None:
        """Leave the helper process to the parent process."""
        self.helper, self.of_parent, self.decoded = None, self.helper, []


state = State()
lock = ForkSafeLock()


def trust_all_files() -> None:
    """Decode all files in this process from now on."""
    state.trusts_all = True


def trust_no_files() -> None:
    """Decode all files in the helper process from now on, also those that were decoded well before."""
    state.trusts_all = state.trusts_known = False


@contextmanager
def session() -> Iterator[None]:
    """Use one helper process for all files in this block, which ends with the block. No file, no process."""
    with lock:
        state.sessions += 1
    try:
        yield
    finally:
        with lock:
            state.sessions -= 1
            if not state.sessions:
                end()


def end() -> None:
    """End the helper process, and remember the files that it has decoded."""
    helper, state.helper = state.helper, None
    if helper:
        helper.stop()
    if state.decoded:
        from minirt.jail import known_files

        known_files.add(state.decoded)
        state.decoded = []


def expect(path: str | os.PathLike[str]) -> None:
    """Start the helper process before it is needed, in a session, if a file will need it.

    The caller is about to import numpy, which takes as long as the start of the process.
    """
    if state.trusts_all or not state.sessions or "numpy" in sys.modules:
        return
    from minirt.jail.decoder import READ_BY_PROGRAM, DecodingError
    from minirt.jail.helper import Helper

    with suppress(FileError, DecodingError), lock:
        if state.helper:
            return
        data = file_io.read(path, file_io.LARGEST_ASSET)
        if not data.startswith(READ_BY_PROGRAM) and not is_known(digest_of(data)):
            state.helper = Helper()
            state.helper.start()


def decode(data: bytes) -> Decoded:
    """Decode the bytes of a picture file; DecodingError if it holds no picture."""
    from minirt.jail import decoder

    if state.trusts_all or is_known(digest := digest_of(data)):
        return decoder.decode(data)
    from minirt.jail.helper import Helper

    with session(), lock:
        state.helper = state.helper or Helper()
        answer, is_silent = state.helper.decode(data)
        if (
            is_silent and state.trusts_known
        ):  # of other files the decoder would complain on the standard error of this program
            state.decoded.append(digest)
        return answer


def digest_of(data: bytes) -> str:
    """Return the digest of a file."""
    from minirt.jail import known_files

    return known_files.digest_of(data)


def is_known(digest: str) -> bool:
    """Whether a file was decoded well before, and is trusted for that."""
    from minirt.jail import known_files

    return state.trusts_known and digest in known_files.known()
