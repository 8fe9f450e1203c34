"""One virtual screen for all tests that open windows."""

from tests.windows import desktop

__all__ = ["desktop"]
