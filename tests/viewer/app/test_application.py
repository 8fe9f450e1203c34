"""The application as the desktop sees it: its name and its icon."""

from __future__ import annotations

import numpy as np
import pytest

from tests.viewer.app.test_real_window import viewing
from tests.waiting import until

pytestmark = pytest.mark.window


def test_the_desktop_knows_the_name_and_the_icon_of_the_application(desktop, tmp_path):
    with viewing(desktop, tmp_path / "scene.rt") as viewer:

        def properties() -> bytes:
            return viewer.desktop.run("xprop", "-id", str(viewer.window), "-notype", "WM_CLASS", "32c", "_NET_WM_ICON")

        until(lambda: b"_NET_WM_ICON = 16, 16, " in properties(), "the icon")
        name, _, words = properties().partition(b"_NET_WM_ICON = ")
        assert name.strip() == b'WM_CLASS = "minirt", "miniRT"'
        icon = np.array(words.split(b", "), np.uint32)
        sizes = []
        while len(icon):
            width, height = icon[:2].tolist()
            drawn, icon = icon[2 : 2 + width * height].reshape(height, width), icon[2 + width * height :]
            assert drawn[0, 0] >> 24 == 0  # transparent beside the ball
            assert drawn[height // 2, width // 2] >> 24 == 255
            sizes.append((width, height))
        assert sizes == [(16, 16), (32, 32), (64, 64)]
        viewer.key("Escape")
        assert viewer.end() == (0, "", "")
