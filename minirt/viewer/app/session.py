"""The viewer on a window of the contract, whichever back end is behind it: events in, edits and pictures out."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from minirt.errors import MiniRTError, RenderError
from minirt.mlx import Event, Mlx, Modifier
from minirt.scene import Scene
from minirt.shapes import Shape
from minirt.viewer.app import file_sync
from minirt.viewer.app.commands import COMMANDS
from minirt.viewer.app.mouse import Mouse
from minirt.viewer.display.painter import Painter, Pixels
from minirt.viewer.display.refinement import Refinement
from minirt.viewer.display.screen import Screen
from minirt.viewer.editing.editor import EDITS, apply
from minirt.viewer.editing.state import State, initial_state
from minirt.viewer.files.scene_files import save_picture, summary
from minirt.viewer.files.watched_file import WatchedFile
from minirt.viewer.input.bindings import Binding
from minirt.viewer.input.key_repeat import KeyRepeat
from minirt.viewer.input.keymap import Keymap

if TYPE_CHECKING:
    from minirt.mlx.display import Display

Pick = Callable[[Scene, int, int, int, int], Shape | None]  # (scene, width, height, x, y)

FINE = 0.1


class Session:
    """One window with one scene. It renders only when the scene or the size of the window changed."""

    def __init__(
        self,
        m: Mlx,
        mlx: Display,
        scene: Scene,
        *,
        path: Path,
        size: tuple[int, int],
        painter: Callable[[Callable[[], object]], Painter],
        pick: Pick,
        keys: str = "auto",
        lenient: bool = False,
        samples: int = 1,
        watch: bool = False,
    ) -> None:
        """`samples`: rays for each pixel of a picture that does not move. `watch`: read the file when it changes."""
        self.m = m
        self.mlx = mlx
        self.path = path
        self.lenient = lenient
        self.pick = pick
        self.state = initial_state(scene)
        self.saved = scene  # what the file holds
        self.disk = WatchedFile(path)
        self.watched = watch
        self.keymap = Keymap(keys)
        self.held = KeyRepeat()
        self.wants_screenshot = False
        self.full_screen = False
        self.win = m.mlx_new_window(mlx, *size, f"miniRT - {path.name}", resizable=True)
        self.pictures = Refinement(painter(lambda: m.mlx_wake(mlx)), self.win, samples)
        self.screen = Screen(m, self.win, self.keymap.layout)
        self.mouse = Mouse(self)
        hooks: dict[Event, Callable[..., None]] = {
            Event.EXPOSE: self.update,
            Event.KEY_PRESS: self.on_press,
            Event.KEY_RELEASE: self.on_release,
            Event.BUTTON_PRESS: self.mouse.press,
            Event.BUTTON_RELEASE: lambda button, _x, _y: self.mouse.release(button),
            Event.MOTION_NOTIFY: self.mouse.motion,
            Event.FOCUS_OUT: self.mouse.let_go,
            Event.DESTROY_NOTIFY: self.quit,
        }
        for event, hook in hooks.items():
            m.mlx_hook(self.win, event, 0, without_parameter(hook), None)
        m.mlx_text_hook(self.win, without_parameter(self.on_press))
        m.mlx_drop_hook(self.win, without_parameter(self.on_drop))
        m.mlx_resize_hook(self.win, without_parameter(self.on_resize))
        m.mlx_wake_hook(mlx, without_parameter(self.on_wake))
        self.watch()

    # --- events ---

    def on_press(self, code: int | str) -> None:
        """A key goes down, or a character was typed."""
        if isinstance(code, str):  # of one or more characters; Shift may be a part of typing it
            for typed in filter(None, map(self.keymap.find, code)):
                self.act(typed, 1.0)
            return
        binding = self.keymap.find(code, self.modifiers)
        if binding:
            self.act(binding, self.step)
            if binding.held:
                self.held.press(code, binding.action, self.now)
                self.tick_while_held()

    def on_release(self, code: int) -> None:
        self.go_on(self.held.release(code, self.now))
        self.tick_while_held()
        self.update()

    def on_tick(self) -> None:
        """A sixtieth of a second with a key held."""
        self.go_on(self.held.advance(self.now))

    def on_wake(self) -> None:
        """The painter has something to tell, or whoever watches the file."""
        if self.news.is_set():
            self.news.clear()
            file_sync.file_changed(self)
        for error in self.pictures.collect():
            self.complain(error)
        self.guarded(Session.take_screenshot)
        self.draw()
        self.update()

    def on_resize(self, _width: int, _height: int) -> None:
        """Another picture: what is under the pointer is something else now."""
        self.mouse.let_go()
        self.update()

    def on_drop(self, file: str) -> None:
        """A file was dropped on the window."""
        self.guarded(lambda session: file_sync.open_another(session, Path(file)))
        self.show(self.state)

    # --- what they lead to ---

    def act(self, binding: Binding, step: float) -> None:
        """Do what a row of the table says."""
        self.mouse.let_go()
        if binding.action in EDITS:
            self.show(apply(self.state, binding.action, step if binding.fine else 1.0, self.now))
            return
        self.state = self.state.with_message("")
        self.guarded(COMMANDS[binding.action])
        self.show(self.state)

    def go_on(self, advances: list[tuple[str, float]]) -> None:
        """Held keys do more of what they do."""
        state = self.state
        for action, amount in advances:
            if amount:
                state = apply(state, action, amount * self.step, self.now)
        if state is not self.state:
            self.show(state)

    def show(self, state: State) -> None:
        """Another state. Where its scene is another, the words on the picture wait for the picture."""
        same = state.scene is self.state.scene
        self.state = state
        self.update()
        if same:
            self.draw()

    def update(self) -> None:
        """See to it that the picture of the scene as it is comes."""
        self.pictures.want(self.state.scene, moving=bool(self.held))

    def draw(self) -> None:
        """Show it now, and let the pace know how long that takes."""
        start = self.now
        pictures = self.pictures
        if self.screen.draw(self.state, pictures.latest, pictures.painter.compiling, pictures.pace.rate):
            self.m.mlx_sync(self.mlx, self.m.SYNC_WIN_FLUSH, self.win)
            self.pictures.pace.learn_showing(self.now - start)

    def take_screenshot(self) -> None:
        """Save the picture when it is wanted and complete. RenderError."""
        if self.wants_screenshot and self.pictures.complete:
            self.wants_screenshot = False
            self.state = self.state.with_message(f"picture: {save_picture(self.picture, self.path)}")

    def guarded(self, command: Callable[[Session], None]) -> None:
        """Do something that may fail; the reason is shown over the picture."""
        try:
            command(self)
        except MiniRTError as error:
            self.complain(error)

    def complain(self, error: Exception) -> None:
        """Show an error over the picture that is there; RenderError where it is none that miniRT knows."""
        if not isinstance(error, MiniRTError):
            raise RenderError(f"the picture cannot be made: {type(error).__name__}: {error}") from error
        self.state = self.state.with_message(summary(error))

    def watch(self) -> None:
        """Let the loop know when the file is changed by others, where that is wanted."""
        self.news = threading.Event()
        if self.watched:
            self.disk.watch(self.tell)

    def tell(self) -> None:
        """From any thread: the file has changed."""
        self.news.set()
        self.m.mlx_wake(self.mlx)

    def quit(self) -> None:
        self.m.mlx_loop_exit(self.mlx)

    def tick_while_held(self) -> None:
        """Without a held key the loop sleeps until the next event."""
        self.m.mlx_loop_hook(self.mlx, without_parameter(self.on_tick) if self.held else None, None)

    @property
    def picture(self) -> Pixels:
        """What the window shows, without the words on it."""
        return self.screen.bare(self.pictures.latest)

    @property
    def now(self) -> float:
        return self.m.mlx_time(self.mlx)

    @property
    def modifiers(self) -> Modifier:
        return self.m.mlx_get_modifiers(self.win)

    @property
    def step(self) -> float:
        """What Shift makes of a step."""
        return FINE if Modifier.SHIFT in self.modifiers else 1.0


def without_parameter(hook: Callable[..., object]) -> Callable[..., object]:
    """A hook of the contract, which gets its parameter last, from a method that needs none."""
    return lambda *arguments: hook(*arguments[:-1])
