"""The desktop for tests of real windows."""

from tests.windows import desktop

__all__ = ["desktop"]
