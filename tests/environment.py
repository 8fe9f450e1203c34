"""Set the environment variables that tests need and the user's environment lacks.

They are set before the compiler is imported, which reads them once, and are inherited by all programs that tests start.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from tests.paths import ROOT

FALLBACK_CACHE = ROOT / "out" / "cache"  # cache of compiled kernels if the user's cache folder cannot be written
STATE = ROOT / "out" / "state"  # journals of unsaved changes, apart from the user's
CONFIGURATION = ROOT / "out" / "configuration"  # defaults of options, of which there are none

# Before numpy is imported: threads that wait for small products took three quarters of the time of some tests.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def prepare() -> None:
    """Set missing environment variables."""
    if os.environ.get("NUMBA_CPU_NAME"):  # else numba adds the features of the actual processor, such as AVX-512
        os.environ.setdefault("NUMBA_CPU_FEATURES", "")
    if not is_cache_writable():
        os.environ["XDG_CACHE_HOME"] = str(FALLBACK_CACHE)
    os.environ["LANGUAGE"] = "en"  # of the window's texts, whatever the user's is
    os.environ["XDG_STATE_HOME"] = str(STATE)
    os.environ["XDG_CONFIG_HOME"] = str(CONFIGURATION)


def is_cache_writable() -> bool:
    """Whether files can be created in the user's cache folder, which is created if necessary."""
    named = Path(os.environ.get("XDG_CACHE_HOME", ""))
    try:
        folder = named if named.is_absolute() else Path.home() / ".cache"
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except (OSError, RuntimeError):  # RuntimeError for a user without a home folder
        return False
    return True
