"""Replays end with the first error that the window has shown."""

from __future__ import annotations

import pytest

from minirt.errors import RenderError
from minirt.viewer.app.replay import replay
from tests.viewer.fake import FakeRenderer, scene


def test_a_picture_that_cannot_be_made_is_the_error_of_a_replay() -> None:
    """Else a picture of the message would be written, with exit status 0: as where a texture cannot be read."""
    renderer = FakeRenderer()
    renderer.error = RenderError("dots.png: cannot be read: input/output error")
    with pytest.raises(RenderError, match="input/output error"):
        replay(scene(), ["wait 0.1"], renderer=renderer, size=(64, 48), path="scene.rt")
