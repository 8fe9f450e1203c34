"""`minirt.view` opens a window or a widget, as it is told, and says what is missing."""

from __future__ import annotations

import sys
from threading import Event

import pytest

import minirt
from minirt.mlx import Mlx
from minirt.mlx.display import Display
from minirt.mlx.memory import Memory
from tests.notebook.requirements import require


class NoScreen(Memory):
    """A back end on a machine without a screen."""

    def open(self, options: object) -> None:
        raise minirt.MlxError("no screen")


@pytest.fixture
def scene() -> minirt.Scene:
    return minirt.loads("A 1 255,255,255\nC 0,0,-10 0,0,1 40\nsp 0,0,0 2 255,0,0\n")


def test_what_cells_show_beside_pictures_is_one_line(scene: minirt.Scene) -> None:
    shown = [
        scene,
        minirt.render(scene, 64, 48),
        minirt.buffers(scene, 64, 48),
        minirt.trace(scene, [[0] * 3], [[0, 0, 1]]),
    ]
    assert all(len(repr(each)) < 100 and "\n" not in repr(each) for each in shown)


@pytest.mark.parametrize("told", [False, None])
def test_outside_of_notebooks_a_missing_screen_is_an_error(scene: minirt.Scene, told: bool | None) -> None:
    with pytest.raises(minirt.MlxError, match="no screen"):
        minirt.view(scene, mlx=Mlx(NoScreen()), notebook=told)


def test_a_missing_package_is_named(scene: minirt.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "minirt.notebook.widget", raising=False)
    with pytest.raises(minirt.MlxError, match=r"pip install 'minirt\[notebook\]'"):
        minirt.view(scene, notebook=True)


def test_a_viewer_that_cannot_open_leaves_no_second_error(scene: minirt.Scene) -> None:
    require("anywidget")
    with pytest.raises(minirt.MiniRTError):
        minirt.view(scene, (64, 48), precision="half", notebook=True)  # type: ignore[call-overload]


def test_a_failure_of_the_session_ends_the_viewer_and_is_told(
    scene: minirt.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    require("anywidget")
    from minirt.notebook.widget import Viewer

    told: list[dict[str, str]] = []
    monkeypatch.setattr(Viewer, "send", lambda self, message, buffers=None: told.append(message))

    def fail() -> None:
        raise minirt.RenderError("planted")

    viewer = Viewer(scene, (64, 48))
    viewer._display.do(fail)
    viewer._thread.join()
    assert {"kind": "failure", "text": "The viewer has ended: planted"} in told
    viewer.close()


def test_a_notebook_without_a_screen_gets_the_widget(scene: minirt.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    require("anywidget")
    monkeypatch.setattr("minirt.notebook.in_notebook", lambda: True)
    viewer = minirt.view(scene, (64, 48), mlx=Mlx(NoScreen()))
    try:
        assert (viewer.width, viewer.height, viewer.scene) == (64, 48, scene)
        assert isinstance(viewer._display, Display)
    finally:
        viewer.close()
    assert not viewer._thread.is_alive()


def test_an_assigned_scene_is_the_scene_at_once(scene: minirt.Scene) -> None:
    require("anywidget")
    from minirt.notebook.widget import Viewer

    viewer = Viewer(scene, (64, 48))
    busy, goes_on, is_shown = Event(), Event(), Event()
    try:
        viewer._display.do(lambda: (busy.set(), goes_on.wait()))
        busy.wait()
        larger = scene.replace(scene.spheres[0], diameter=3)
        viewer.scene = larger
        assert viewer.scene is larger
        goes_on.set()
        viewer._display.do(is_shown.set)
        is_shown.wait()
        assert viewer._session.state.scene.items == larger.items
        assert viewer.scene is viewer._session.state.scene
    finally:
        goes_on.set()
        viewer.close()
