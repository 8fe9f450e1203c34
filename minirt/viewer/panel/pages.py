"""Pages: what belongs to the scene as a whole, the history of edits, and pictures and films."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from threading import Thread

from slimgui import imgui

from minirt.element import fields_of
from minirt.errors import MiniRTError
from minirt.movie import save_movie
from minirt.rendering.image import Image
from minirt.rendering.settings import render
from minirt.scene import Lamp, Scene
from minirt.viewer.app.commands import COMMANDS
from minirt.viewer.app.session import Session
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.motion import turntable
from minirt.viewer.editing.state import Snapshot
from minirt.viewer.language import translated
from minirt.viewer.panel.elements import Elements, seen
from minirt.viewer.panel.rows import Rows

SAMPLES = ("1", "4", "16", "64", "256")  # rays per pixel
FRAMES = ("24", "60", "120", "240")  # pictures of a film
COMMAND_TITLES = {"screenshot": "save the picture", "save": "save the scene", "save copy": "save a copy"}


class Pages:
    """The pages of a session's panel, apart from that of the elements."""

    def __init__(self, session: Session, rows: Rows, elements: Elements) -> None:
        self.session, self.rows, self.elements = session, rows, elements
        self.film = ""  # what the window shows of the film: its progress, or its end
        self._frames = FRAMES[1]
        self._is_stopped = False
        self._thread: Thread | None = None

    def scene(self) -> None:
        """Show the samples, and the rows of the elements that a scene has once, such as the camera."""
        refinement = self.session.refinement
        if samples := self.rows.option("samples", SAMPLES, str(refinement.samples)):
            refinement.restart(int(samples))
            self.session.update()
        for index, element in enumerate(self.session.state.scene.elements):
            if type(element).once and not isinstance(element, Lamp):
                imgui.push_id(index)
                imgui.separator_text(element.title)
                self.rows.show(index)
                self.elements.attributes()
                imgui.pop_id()

    def history(self) -> None:
        """Show the steps of undo and redo, the oldest first; a click goes there."""
        state = self.session.state
        steps = [*state.undo_stack, state.snapshot, *reversed(state.redo_stack)]
        now = len(state.undo_stack)
        for number in seen(len(steps)):
            title = step_title(steps[number - 1], steps[number]) if number else "as opened"
            undone = "  (undone)" if number > now else ""
            if imgui.selectable(f"{number}  {title}{undone}###{number}", number == now)[0]:
                for _ in range(abs(number - now)):
                    state = apply(state, "redo" if number > now else "undo")
                self.rows.gui.show(state)
            self.rows.note(f"step {number}")

    def picture(self) -> None:
        """Show the buttons that save the picture and the scene, and make a film of a turntable."""
        for action, title in COMMAND_TITLES.items():
            if imgui.button(f"{title}###{action}"):
                self.session.attempt(COMMANDS[action])
                self.rows.gui.show(self.session.state)
            self.rows.note(action)
        imgui.separator_text("turntable")
        self._frames = self.rows.option("frames", FRAMES, self._frames) or self._frames
        is_running = self._thread is not None and self._thread.is_alive()
        if imgui.button("stop###film" if is_running else "save a film###film"):
            self._is_stopped = is_running
            if not is_running:
                self._thread = Thread(target=self.make_film, name="minirt-film", daemon=True)
                self._thread.start()
        self.rows.note("film")
        imgui.text_wrapped(translated(self.film))

    def make_film(self) -> None:
        """Render and write the film, in a thread of its own; the window goes on meanwhile."""
        path = self.session.path
        names = (path.with_name(f"{path.stem}-{number}.gif") for number in count(1))
        file = next(each for each in names if not each.exists())
        try:
            save_movie(self.frames(self.session.shown_scene, int(self._frames)), file)
            self.say(f"film: {file}")
        except (MiniRTError, OSError) as error:
            self.say(str(error))

    def frames(self, scene: Scene, total: int) -> Iterator[Image]:
        """Yield the pictures of the film, as large and with as many samples as the picture in the window."""
        size, samples = (self.session.window.width, self.session.window.height), self.session.refinement.samples
        for number, view in enumerate(turntable(scene, total), 1):
            if self._is_stopped:
                raise MiniRTError("the film was stopped")
            yield render(view, *size, samples=samples)
            self.say(f"{number} of {total} pictures")

    def say(self, text: str) -> None:
        """Show what became of the film, from its thread."""
        self.film = text
        self.session.mlx.mlx_wake(self.session.display)


def step_title(before: Snapshot, after: Snapshot) -> str:
    """Description of the edit between two versions of a scene."""
    old, new = before.scene.elements, after.scene.elements
    if len(old) != len(new):
        return f"add {new[after.selected].title}" if len(new) > len(old) else f"delete {old[before.selected].title}"
    one, other = old[after.selected], new[after.selected]
    changed = [
        each.title for each in fields_of(type(one)) if getattr(one, each.name) != getattr(other, each.name, None)
    ]
    return f"{one.title}: {', '.join(changed)}"
