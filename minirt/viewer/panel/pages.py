"""Pages: what belongs to the scene as a whole, the history of edits, and pictures and films."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from threading import Thread

from slimgui import imgui

from minirt.element import Element, fields_of
from minirt.errors import MiniRTError
from minirt.helpers.file_io import found
from minirt.movie import FILMS, FPS, QUALITY, numbered, save_movie
from minirt.rendering.image import Image
from minirt.rendering.settings import render
from minirt.scene import Lamp, Scene
from minirt.scene.names import own_name
from minirt.scene.registry import ELEMENTS
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import BINDINGS
from minirt.viewer.editing import structure
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.motion import turntable
from minirt.viewer.editing.state import Snapshot
from minirt.viewer.language import translated
from minirt.viewer.panel.elements import seen
from minirt.viewer.panel.groups import Groups
from minirt.viewer.panel.rows import Rows

SAMPLES = ("1", "4", "16", "64", "256")  # rays per pixel
BUTTONS = {each.action: each.help for each in BINDINGS if each.action in ("screenshot", "save", "save copy")}
ONCE = [kind for kind in ELEMENTS.values() if kind.once and not issubclass(kind, Lamp)]  # settings of a scene
MOST_PICTURES, BEST_QUALITY = 3600, 100  # as on the command line


class Pages:
    """The pages of a session's panel, apart from that of the elements."""

    def __init__(self, session: Session, rows: Rows, groups: Groups) -> None:
        self.session, self.rows, self.groups = session, rows, groups
        self.film = ""  # what the window shows of the film: its progress, or its end
        self._share = 0.0  # of the film that is made
        self._format, self._pictures, self._quality = ".gif", 120, QUALITY
        self._is_running = self._is_stopped = False
        self._end = ""  # what became of the film, until it is said
        self._thread: Thread | None = None

    def scene(self) -> None:
        """Show the samples, and the rows of the elements that a scene has once, such as the camera."""
        refinement = self.session.refinement
        if samples := self.rows.option("samples", SAMPLES, str(refinement.samples)):
            refinement.restart(int(samples))
            self.session.update()
        for kind in ONCE:
            imgui.push_id(kind.code)
            self.setting(kind)
            imgui.pop_id()

    def setting(self, kind: type[Element]) -> None:
        """Show the rows of an element that a scene has once; a box adds and deletes one that it may lack."""
        state = self.session.state
        index = next((each for each in state.scene.indices_of(kind) if type(state.scene.elements[each]) is kind), None)
        if kind.required:
            imgui.separator_text(translated(kind.title))
        elif self.rows.box(kind.title, index is not None):
            after = structure.with_element(state, kind) if index is None else apply(state.select(index), "delete")
            self.rows.gui.show(after)
            return
        if index is not None:
            self.groups.show(index)

    def history(self) -> None:
        """Show the steps of undo and redo, the oldest first; a click goes there."""
        state = self.session.state
        steps = [*state.undo_stack, state.snapshot, *reversed(state.redo_stack)]
        now = len(state.undo_stack)
        for number in seen(len(steps)):
            title = step_title(steps[number - 1], steps[number]) if number else translated("as opened")
            undone = translated("(undone)") if number > now else ""
            if imgui.selectable(f"{number}  {title}  {undone}###step {number}", number == now)[0]:
                for _ in range(abs(number - now)):
                    state = apply(state, "redo" if number > now else "undo")
                self.rows.gui.show(state)

    def picture(self) -> None:
        """Show the buttons that save the picture and the scene, the settings of a film of a turntable, and a button
        that makes the film in a thread, or stops that thread."""
        self.rows.gui.buttons(BUTTONS)
        imgui.separator_text(translated("film"))
        self._format = self.rows.option("format", FILMS, self._format) or self._format
        self._pictures = self.rows.whole("pictures", self._pictures, MOST_PICTURES)
        if FILMS[self._format].is_lossy:
            self._quality = self.rows.whole("quality", self._quality, BEST_QUALITY)
        if imgui.button(translated("stop" if self._is_running else "save a film") + "###film"):
            self._is_stopped = self._is_running  # which the thread looks at
            if not self._is_running:
                self._is_running = True
                self._thread = Thread(target=self.make_film, name="minirt-film", daemon=True)
                self._thread.start()
        width, height = self.session.window_size
        film = f"once around the scene, a film of {self._pictures / FPS:g} s, {width}x{height} pixels"
        imgui.text_wrapped(translated(film))  # below the button, which a number that is typed must not move
        if self._is_running:
            imgui.progress_bar(self._share, overlay=translated(self.film))
        else:
            imgui.text_wrapped(translated(self.film))

    def make_film(self) -> None:
        """Render and write the film to a new file, in a thread of its own; an error of miniRT or the system ends it.
        `_share`, `film` and `_end` tell the window of its progress and its end."""
        path = self.session.path
        names = (path.with_name(f"{path.stem}-{number}{self._format}") for number in count(1))
        file = next(each for each in names if not found(each) and not found(numbered(each, 1)))
        quality = self._quality if FILMS[self._format].is_lossy else None
        self._share = 0.0
        self.say(f"0 of {self._pictures} pictures")
        try:
            pictures = self.frames(self.session.shown_scene, self._pictures)
            end = f"film: {save_movie(pictures, file, quality=quality)[0]}"
        except (MiniRTError, OSError) as error:
            end = str(error)
        self._end, self._is_running = end, False
        self.say(end)

    def tell_end(self) -> None:
        """Say over the picture, once, that the film is finished or why not, also where the panel is closed."""
        if self._end and not self._is_running:
            self.session.say(self._end)
            self._end = ""
            self.session.refresh()

    def frames(self, scene: Scene, total: int) -> Iterator[Image]:
        """Yield the pictures of the film, as large and with as many samples as the picture in the window."""
        size, samples = self.session.window_size, self.session.refinement.samples
        for number, view in enumerate(turntable(scene, total), 1):
            if self._is_stopped:
                raise MiniRTError("the film was stopped")
            yield render(view, *size, samples=samples)
            self._share = number / total
            self.say("the file is written" if number == total else f"{number} of {total} pictures")

    def say(self, text: str) -> None:
        """Show what became of the film, from its thread."""
        self.film = text
        self.session.mlx.mlx_wake(self.session.display)


def step_title(before: Snapshot, after: Snapshot) -> str:
    """Description of the edit between two versions of a scene."""
    old, new = before.scene.elements, after.scene.elements
    if len(old) != len(new):
        is_more = len(new) > len(old)
        names = translated(structure.names_of_chosen(after if is_more else before))
        return f"{'+' if is_more else '-'} {names}"
    one, other = old[after.selected], new[after.selected]
    changed = (each for each in fields_of(type(one)) if getattr(one, each.name) != getattr(other, each.name, None))
    titles = ["name"] if own_name(one) != own_name(other) else [each.title for each in changed]
    names = structure.names_of_chosen(before._replace(selected=after.selected))
    return f"{translated(names)}: {', '.join(map(translated, titles))}"
