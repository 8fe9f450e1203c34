"""The seed of all random tests of a run, which is printed at its end; MINIRT_SEED replays it.

Each run tries others. The processes of a run inherit the seed by the environment. Each test makes its own of it and of
a name: which tests run, and in which order, changes nothing.
"""

from __future__ import annotations

import os
import zlib
from random import SystemRandom

VARIABLE = "MINIRT_SEED"
RUN = int(os.environ.setdefault(VARIABLE, str(SystemRandom().randrange(2**32))))


def seed_of(name: str) -> int:
    """Return the seed, from 0 to 2^32 - 1, of what has this name."""
    return zlib.crc32(f"{RUN} {name}".encode())
