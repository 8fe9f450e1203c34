"""The seed of random tests: another in each run, printed at its head, and MINIRT_SEED replays a run."""

from __future__ import annotations

import os
from random import SystemRandom

# Processes that a run starts inherit it.
SEED = int(os.environ.setdefault("MINIRT_SEED", str(SystemRandom().randrange(2**32))))
