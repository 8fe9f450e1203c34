"""A child process after `os.fork()` leaves the helper process of its parent alone, and has one of its own."""

from __future__ import annotations

import os

import pytest

from minirt import jail
from minirt.jail import decoder
from minirt.jail.decoding import state
from tests.jail.pictures import FILES, PNG

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork"),
    pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning"),  # what Python 3.12 says of a fork
]


def test_parent_and_child_decode_in_processes_of_their_own() -> None:
    with jail.session():
        jail.decode(PNG)
        assert state.helper
        process = state.helper.process
        child = os.fork()
        if not child:
            status = 1
            try:
                right = jail.decode(FILES["BMP"]) == decoder.decode(FILES["BMP"])
                assert state.helper
                status = 0 if right and state.helper.process is not process else 1
            finally:
                jail.decoding.end()
                os._exit(status)
        assert os.waitpid(child, 0)[1] == 0
        assert jail.decode(FILES["palette"]) == decoder.decode(FILES["palette"])
        assert state.helper.process is process
