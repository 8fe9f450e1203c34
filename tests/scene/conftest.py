"""Every text that a test of this folder parses is read by both readers, the fast and the diagnosing one."""

from __future__ import annotations

from collections.abc import Iterator
from unittest.mock import patch

import pytest

from minirt.scene import parser
from tests.scene.readers import read_by_both


@pytest.fixture(autouse=True, scope="package")
def both_readers() -> Iterator[None]:
    """Let both readers read, and compare them."""
    with patch.object(parser, "read_lines", read_by_both):
        yield
