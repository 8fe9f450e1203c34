"""Viewer: the widget that shows a scene in a notebook. This module needs anywidget."""

from __future__ import annotations

import threading
from typing import Any, Unpack

import anywidget
import traitlets

from minirt.errors import MiniRTError
from minirt.helpers import package
from minirt.mlx import Mlx
from minirt.notebook.page_back_end import PageDisplay, deliver
from minirt.rendering.image import Image
from minirt.scene import Scene, check_scene, size_of
from minirt.viewer.app.desktop import STOP_TIMEOUT, ViewSettings, open_view
from minirt.viewer.editing.state import state_after_reading

DEFAULT_SIZE = 960, 540  # pixels, of a scene that does not name a size


class Viewer(anywidget.AnyWidget):  # type: ignore[misc]
    """A scene in a notebook, which keys and the mouse edit as in the window.

    A click gives it the keyboard, Escape takes it away. `scene` is the scene as edited so far; another scene may be
    assigned to it, and undo takes that back. `picture` is what the viewer shows, without text. `close` ends it.

    The session of the viewer runs in a thread, so that it also goes on while a cell runs.
    """

    _esm = package.read(__name__, "viewer.js").decode()
    width = traitlets.Int().tag(sync=True)
    height = traitlets.Int().tag(sync=True)

    def __init__(self, scene: Scene, size: tuple[int, int] | None = None, **settings: Unpack[ViewSettings]) -> None:
        """Open the viewer; see `minirt.view`."""
        self._assigned: Scene | None = None  # the last scene, until the session's thread shows it
        size = size or (size_of(scene) if scene.resolution else DEFAULT_SIZE)
        self._display = PageDisplay(lambda message, data: self.send(message, [data] if data else None))
        self._session = open_view(scene, size, Mlx(self._display), **settings)
        window = self._session.window
        super().__init__(width=window.width, height=window.height)
        self._closing = False
        self.on_msg(self._on_message)
        self._thread = threading.Thread(target=self._run, name="minirt-viewer", daemon=True)
        self._thread.start()

    @property
    def scene(self) -> Scene:
        """The scene as edited so far."""
        assigned = self._assigned
        return self._session.state.scene if assigned is None else assigned

    @scene.setter
    def scene(self, scene: Scene) -> None:
        check_scene(scene, "show")
        self._assigned = scene
        self._display.do(lambda: self._show(scene))

    @property
    def picture(self) -> Image:
        """The picture that the viewer shows, without text and marks."""
        return Image.from_bgra(self._session.picture)

    def close(self) -> None:
        """End the viewer and take it from the notebook; its scene stays."""
        self._closing = True
        if hasattr(self, "_thread"):  # not after an error in `__init__`
            self._display.do(self._session.quit)
            if threading.current_thread() is not self._thread:
                self._thread.join()
        super().close()

    def __repr__(self) -> str:
        return f"<Viewer of {self.width}x{self.height} pixels: `.scene` is the scene as edited>"

    def _run(self) -> None:
        """Run the session until `close`: Escape, which ends the loop, only gives the keyboard back to the notebook. An
        error ends the session and is shown in the page; an unexpected one is raised, too."""
        session = self._session
        try:
            while not self._closing:
                session.mlx.mlx_loop(session.display)
                self.send({"kind": "release"})
        except Exception as error:
            self.send({"kind": "failure", "text": f"The viewer has ended: {error}"})
            if not isinstance(error, MiniRTError):
                raise
        finally:
            session.mlx.mlx_release(session.display)
            session.refinement.painter.close(STOP_TIMEOUT)

    def _show(self, scene: Scene) -> None:
        self._session.release_button()
        self._session.show(state_after_reading(self._session.state, scene, None))
        if self._assigned is scene:
            self._assigned = None

    def _on_message(self, _widget: object, message: dict[str, Any], _buffers: object) -> None:
        """Pass a message of the page to the session's thread."""
        display, window = self._display, self._session.window
        match message.get("kind"):
            case "ready":
                display.do(display.restart)
            case "shown":
                display.do(lambda: display.acknowledge(int(message["number"])))
            case _:
                display.do(lambda: deliver(window, message, display.time()))
