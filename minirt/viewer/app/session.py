"""Session: one scene in one window, with its file, its editor state and its pictures.

It renders only when its scene or the size of its window has changed. Words describe the current state, which may be
newer than the picture: those of a new scene are drawn with its first picture, or over the old one if that is late.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import is_not
from pathlib import Path

from minirt.errors import MiniRTError, RenderError
from minirt.mlx import Cursor, Mlx, Modifier
from minirt.mlx.display import Display
from minirt.rendering.image import Image
from minirt.rendering.queries.pick import Picked
from minirt.rendering.renderer import Renderer
from minirt.scene import Scene
from minirt.viewer.bindings import Keymap
from minirt.viewer.display.jobs import Painted, Pixels
from minirt.viewer.display.painter import Painter
from minirt.viewer.display.refinement import Refinement
from minirt.viewer.display.screen import Screen, give_back_memory
from minirt.viewer.editing.dragging import DragStart
from minirt.viewer.editing.editor import HeldKey
from minirt.viewer.editing.projection import Projection, projection_of
from minirt.viewer.editing.state import Hidden, State, initial_state
from minirt.viewer.files import WatchedFile, contents_differ, create_numbered, error_summary, title_of
from minirt.viewer.recovery import FoundChanges, Recovery, Version

FINE_STEP = 0.1  # of a step, while Shift is held
WORDS_DELAY = 0.04  # seconds in which words wait for their picture, which drawing them twice would delay


class Session:
    """One scene in one window, whichever back end draws the window."""

    def __init__(
        self,
        mlx: Mlx,
        display: Display,
        scene: Scene,
        path: Path,
        size: tuple[int, int],
        renderer: Renderer,
        painter: Callable[[Renderer, Callable[[], object]], Painter] = Painter,
        *,
        keys: str = "auto",
        lenient: bool | str = False,
        samples: int = 1,
        watch: bool = False,
        saved: Scene | None = None,
    ) -> None:
        """Open the window, of `size` in pixels. MlxError.

        `path`: the scene's file. `painter`: is called with the renderer and with what to call when there is a picture.
        `keys`: layout of the keyboard. `lenient`: read dialects as `minirt.load` does. `samples`: rays per pixel of a
        picture that does not move. `watch`: read the file when another program changes it. `saved`: the scene as the
        file holds it, if not `scene`.
        """
        self.mlx = mlx
        self.display = display
        self.lenient = lenient
        self.pick = renderer.pick
        self.state = initial_state(scene)
        self.opened = scene  # the first scene
        self.saved = saved or scene  # the scene as the file holds it
        self.watches_file = watch
        self.recovery: Recovery | None = None  # of unsaved changes
        self.found_changes: FoundChanges | None = None  # of an earlier run, which may be shown instead
        self.slides = False  # whether a number of the panel is dragged
        self.wants_panel = False  # whether the panel opens with the first picture, as it was open in the last window
        self.held_keys: dict[int, HeldKey] = {}  # by their codes
        self.pressed: DragStart | None = None
        self.pointer = size[0] // 2, size[1] // 2  # the pixel where the pointer was last
        self.failures: list[MiniRTError] = []  # that were shown
        self.defect: RenderError | None = None  # the first error of this program, raised when the window is closed
        self.screenshot_pending = False
        self.has_unused_memory = False  # of pictures or scenes that are gone
        self.full_screen = False
        mlx.mlx_set_options(alpha=False, strict=True, symbols=True, application="miniRT")
        mlx.mlx_do_key_autorepeatoff(display)  # `held_keys` repeats what is worth it
        self._title = title_of(path, scene)
        self.title_made_from: tuple[object, ...] = ()  # scenes and path; () has it made anew
        self.window = mlx.mlx_new_window(display, *size, self._title, resizable=True)
        self.refinement = Refinement(painter(renderer, lambda: mlx.mlx_wake(display)), samples)
        self.keymap = Keymap(keys, self.window.letter_at)
        self.screen = Screen(mlx, self.window, self.keymap)
        self._without_hidden = scene, frozenset[int](), scene  # scene, hidden elements, scene without them
        self._described: Scene | None = None  # the scene that the words in the window describe
        self._drawn: Painted | None = None  # the picture in the window
        self._current_at = self.now  # when the window last got a frame, or last had the words of the current scene
        self.watch_file(path)

    def show(self, state: State) -> None:
        """Make `state` the current one."""
        self._current_at = self._current_at if self.words_wait else self.now
        self.state = state
        self.screen.tips = self.screen.tips and not contents_differ(state.scene, self.opened)
        self.update()
        self.refresh()

    def update(self) -> None:
        """Request the next picture of the current scene, if one is missing, and keep its changes on disk."""
        if self.recovery:
            self.recovery.keep(Version(self.state.scene, self.saved, self.path))
        self.show_title()
        moving = bool(self.held_keys) or self.slides
        size = self.window_size if self.screenshot_pending and not moving else self.screen.size
        self.refinement.request_missing(self.shown_scene, size, moving=moving)

    def show_title(self) -> None:
        """Show the title of the window, if it is another one."""
        made_from = self.state.scene, self.saved, self.path
        if len(self.title_made_from) != len(made_from) or any(map(is_not, made_from, self.title_made_from)):
            self.title_made_from = made_from
            title = title_of(self.path, self.saved, contents_differ(self.state.scene, self.saved))
            if title != self._title:
                self._title = title
                self.mlx.mlx_set_window_title(self.window, title)

    def refresh(self) -> None:
        """Draw the window, unless words wait for their picture and it has not come, for at most WORDS_DELAY."""
        is_late = self.now - self._current_at >= WORDS_DELAY
        if is_late or not self.words_wait or self.refinement.latest is not self._drawn:
            self.draw()

    def draw(self) -> None:
        """Draw the latest picture and its overlay in the window, and measure how long that takes."""
        start = self.now
        self._described, self._drawn = self.state.scene, self.refinement.shown(self._drawn, self.screen.size)
        if self.screen.draw(self.state, self._drawn, self.refinement.resolution.rate, keys_held=bool(self.held_keys)):
            self.mlx.mlx_sync(self.display, self.mlx.SYNC_WIN_FLUSH, self.window)
            self._current_at = self.now
            self.refinement.resolution.display_times.append(self._current_at - start)

    def take_screenshot(self) -> None:
        """Save the picture, as large as the window, once it is complete; then the shown one goes on. FileError."""
        pixels = self.refinement.finished(self.window_size) if self.screenshot_pending else None
        if pixels is not None:
            self.screenshot_pending = False
            self.refinement.resume(self._drawn, self.screen.size)
            file = create_numbered(self.path, ".png", Image.from_bgra(pixels).encode())
            self.say(f"picture: {file}")

    def give_back_memory(self) -> None:
        """Give the memory of earlier sizes and files back to the system as soon as a picture of the new is complete."""
        if self.has_unused_memory and self.refinement.complete:
            self.has_unused_memory = False
            give_back_memory()

    def attempt(self, command: Callable[[Session], None]) -> None:
        """Run a command; if it fails, show the reason over the picture."""
        try:
            command(self)
        except Exception as error:
            self.show_error(error)

    def show_error(self, error: Exception) -> None:
        """Show an error over the picture. None ends the window: one that miniRT does not expect is its `defect`."""
        if not isinstance(error, MiniRTError):
            cause, error = error, RenderError(f"miniRT has an error, please report it: {type(error).__name__}: {error}")
            error.__cause__ = cause
            self.defect = self.defect or error
        self.failures.append(error)
        self.say(error_summary(error))

    def say(self, message: str) -> None:
        """Show a message over the next frame."""
        self.state = self.state.with_message(message)

    def show_file(self, state: State, saved: Scene) -> None:
        """Make `state` the current one, of a file that was read or opened and holds the scene `saved`."""
        self.release_button()
        self.state, self.saved = state, saved
        self.screen.banner = ""
        self.has_unused_memory = True

    def surface_at(self, x: int, y: int) -> Picked:
        """Return the shape at a pixel of the window, and the point on it."""
        return self.pick(self.shown_scene, *self.screen.size, x, y)

    def release_button(self) -> None:
        """Forget the mouse button that is down; the edits of a drag are then one undo step."""
        if self.pressed and self.pressed.dragging:
            self.state = self.state.end_merging()
            self.mlx.mlx_set_cursor(self.window, Cursor.ARROW)
        self.pressed = None

    def watch_file(self, path: Path) -> None:
        """Take another file as that of the scene, and watch it for changes by other programs if it was asked for."""
        self.path, self.file = path, WatchedFile(path)
        if self.watches_file:
            self.file.watch(lambda: self.mlx.mlx_wake(self.display))

    def quit(self) -> None:
        self.mlx.mlx_loop_exit(self.display)

    @property
    def shown_scene(self) -> Scene:
        """The scene without hidden elements, made once for each version of the scene."""
        scene, hidden = self.state.scene, self.state.hidden
        if not hidden:
            return scene
        of, without, shown = self._without_hidden
        if of is not scene or without != hidden:
            shown = scene
            for index in hidden:
                shown = shown.edit(index, Hidden())
            self._without_hidden = scene, hidden, shown
        return shown

    @property
    def words_wait(self) -> bool:
        """Whether the words in the window describe an older scene than the current one."""
        return self._described is not self.state.scene

    @property
    def view(self) -> Projection:
        return projection_of(self.state.scene.camera, *self.screen.size)

    @property
    def window_size(self) -> tuple[int, int]:
        return self.window.width, self.window.height

    @property
    def picture(self) -> Pixels:
        """The picture as large as it is shown, without overlay."""
        return self.screen.picture_alone(self.refinement.latest)

    @property
    def now(self) -> float:
        """The time of the back end, in seconds."""
        return self.mlx.mlx_time(self.display)

    @property
    def modifiers(self) -> Modifier:
        return self.mlx.mlx_get_modifiers(self.window)

    @property
    def step(self) -> float:
        """The size of a step: smaller while Shift is down."""
        return FINE_STEP if Modifier.SHIFT in self.modifiers else 1.0
