"""A child process after `os.fork()` leaves the helper process of its parent alone, and has one of its own."""

from __future__ import annotations

import os

import pytest

from minirt import jail
from minirt.jail import decoder
from minirt.jail.decoding import state
from tests.jail.pictures import FILES, PNG
from tests.processes import in_child

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork"),
    pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning"),  # what Python 3.12 says of a fork
]


def test_parent_and_child_decode_in_processes_of_their_own() -> None:
    with jail.session():
        jail.decode(PNG)
        assert state.helper
        process = state.helper.process

        def decode() -> None:
            try:
                assert jail.decode(FILES["BMP"]) == decoder.decode(FILES["BMP"])
                assert state.helper
                assert state.helper.process is not process
            finally:
                jail.decoding.end()

        assert in_child(decode) == 0
        assert jail.decode(FILES["palette"]) == decoder.decode(FILES["palette"])
        assert state.helper.process is process
