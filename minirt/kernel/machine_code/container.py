"""Container of machine code on disk: magic, version, length, keyed digest, names and object code.

A reader checks everything before it uses anything, and nothing in a container is unpickled. The digest is keyed
BLAKE2b, and covers the identity of the kernel too: a file in the place of another one is as bad as a damaged one.
"""

from __future__ import annotations

import hmac
import json
import struct
from hashlib import blake2b
from typing import Any

MAGIC = b"miniRT\r\n"
VERSION = 1
KEY_SIZE = DIGEST_SIZE = 32  # bytes
HEADER = struct.Struct(f"<{len(MAGIC)}sIQ{DIGEST_SIZE}s")  # magic, version, bytes after the header, digest
NAMES_SIZE = struct.Struct("<I")  # bytes of the names, which are JSON; the object code follows them


class DamagedError(Exception):
    """A container is not as it was written; the message says what is wrong."""


def pack(key: bytes, identity: str, names: dict[str, Any], code: bytes) -> bytes:
    """Return a container with the names and the object code of a kernel."""
    text = json.dumps(names).encode()
    content = NAMES_SIZE.pack(len(text)) + text + code
    return HEADER.pack(MAGIC, VERSION, len(content), digest(key, identity, content)) + content


def unpack(key: bytes, identity: str, data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the names and the object code in a container; DamagedError where any byte is not as it was written."""
    if len(data) < HEADER.size:
        raise DamagedError("it is too short")
    magic, version, length, expected = HEADER.unpack_from(data)
    content = data[HEADER.size :]
    if (magic, version) != (MAGIC, VERSION):
        raise DamagedError("it has another format")
    if length != len(content):
        raise DamagedError(f"it has {len(content)} bytes instead of {length}")
    if not hmac.compare_digest(expected, digest(key, identity, content)):
        raise DamagedError("its digest is wrong")
    (size,) = NAMES_SIZE.unpack_from(content)
    code_at = NAMES_SIZE.size + size
    return json.loads(content[NAMES_SIZE.size : code_at]), content[code_at:]


def digest(key: bytes, identity: str, content: bytes) -> bytes:
    """Return the keyed digest of the identity of a kernel and of the content of its container."""
    whose = identity.encode()
    prefix = struct.pack("<IQ", VERSION, len(whose))
    return blake2b(prefix + whose + content, key=key, digest_size=DIGEST_SIZE).digest()


def size(data: bytes) -> int:
    """Return the bytes of the container at the beginning of some data; DamagedError where there is none."""
    if len(data) < HEADER.size:
        raise DamagedError("it is too short")
    return HEADER.size + int(HEADER.unpack_from(data)[2])
