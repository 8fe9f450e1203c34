"""The environment variables that tests need, set where the user's own surroundings do not do.

They are set before the compiler is imported, which reads them once, and hold for all programs that tests start.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from tests.paths import ROOT

FALLBACK_CACHE = ROOT / "out" / "cache"  # where kernels are kept if the user's own folder cannot be written

# numba takes the features of the processor at hand for any name but `generic`: what the named one does not have must
# be left out by hand, or `haswell` would still be AVX-512.
FEATURES = {"haswell": "+avx,+avx2,+bmi,+bmi2,+f16c,+fma,+lzcnt,+movbe,+popcnt,+sse4.2"}


def prepare() -> None:
    """Set what is missing."""
    name = os.environ.get("NUMBA_CPU_NAME", "")
    if name in FEATURES:
        os.environ.setdefault("NUMBA_CPU_FEATURES", FEATURES[name])
    if not is_writable(user_cache()):
        os.environ["XDG_CACHE_HOME"] = str(FALLBACK_CACHE)


def user_cache() -> Path | None:
    """The folder in which this user's programs keep what they can make again; None for a user without a home."""
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    except RuntimeError:
        return None


def is_writable(folder: Path | None) -> bool:
    """Whether files can be made in a folder, or in it once it is made itself."""
    try:
        if folder:
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return folder is not None
