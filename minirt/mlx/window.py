"""Window: its size, canvas, keyboard and hooks, the events that a back end reports to it, and what it lets one do."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import ClassVar

from minirt.mlx.arguments import Hooks, Host, MlxImage, NumberedObject, Options
from minirt.mlx.canvas import Canvas
from minirt.mlx.events import MODIFIER_KEYS, Button, Cursor, Event, Modifier

REPEAT_DELAY = 0.5  # seconds until a held key repeats
REPEAT_INTERVAL = 0.04  # seconds


class Keyboard:
    """Pairs every press of a key with a release, although platforms lose releases.

    Releases are lost when the window loses the focus, when Cmd is held on macOS, and, if keys are reported as symbols,
    when the symbol of a held key changes (Shift and = is +; with Shift released first, the platform reports the
    release of =). This class releases the keys concerned.
    """

    def __init__(self, report: Callable[[Event, int], None], options: Options) -> None:
        self._report = report
        self._options = options
        self.held: list[int] = []  # oldest first
        self.modifiers = Modifier.NONE
        self._repeating: int | None = None  # the newest key, while it is held
        self._repeat_at = 0.0

    def press(self, key: int, now: float, modifiers: Modifier | None = None) -> None:
        """Hold a key down. `modifiers`: the held modifiers by the platform; None derives them from the held keys."""
        self.modifiers = self._held_modifiers() if modifiers is None else modifiers
        self.modifiers |= MODIFIER_KEYS.get(key, Modifier.NONE)
        if key not in self.held:
            self.held.append(key)
            if key not in MODIFIER_KEYS:
                self._repeating, self._repeat_at = key, now + REPEAT_DELAY
            self._report(Event.KEY_PRESS, key)

    def release(self, key: int, modifiers: Modifier | None = None) -> list[int]:
        """Release a key. Returns the released keys: this key, and the keys whose releases a modifier hides."""
        modifier = MODIFIER_KEYS.get(key, Modifier.NONE)
        released = [key] if key in self.held else []
        if modifier:
            released += [other for other in self.held if other != key and self._hides_release(modifier, other)]
        self.held = [other for other in self.held if other not in released]
        held = self._held_modifiers()
        self.modifiers = held if modifiers is None else modifiers & ~modifier | held
        for lost in released:
            self._report(Event.KEY_RELEASE, lost)
        return released

    def release_all(self) -> None:
        """Release all keys, when the focus is lost and no release will come."""
        released, self.held = self.held, []
        self.modifiers = Modifier.NONE
        for key in released:
            self._report(Event.KEY_RELEASE, key)

    @property
    def repeating(self) -> bool:
        """Whether the newest key is still held; modifiers do not repeat."""
        return self._repeating in self.held

    def repeat(self, now: float) -> None:
        """Report a release and a press of the newest key, as X11 does, when its repeat is due."""
        if self._repeating in self.held and now >= self._repeat_at:
            self._repeat_at = max(self._repeat_at + REPEAT_INTERVAL, now)
            self._report(Event.KEY_RELEASE, self._repeating)
            self._report(Event.KEY_PRESS, self._repeating)

    def _hides_release(self, modifier: Modifier, key: int) -> bool:
        """Whether releasing `modifier` may hide the release of `key`: symbols change with it, letters do not."""
        is_symbol = self._options.symbols and 0x20 < key < 0xFF00 and not 0x61 <= key <= 0x7A
        return key not in MODIFIER_KEYS and (modifier is Modifier.COMMAND or is_symbol)

    def _held_modifiers(self) -> Modifier:
        return Modifier(sum({MODIFIER_KEYS.get(key, Modifier.NONE) for key in self.held}))


@dataclass(eq=False, repr=False)
class Window(NumberedObject, ABC):
    """An open window. The size of a resizable window is that of its frame buffer.

    A window of fixed size keeps the requested size: if the platform shows it larger, its picture is stretched
    and mouse positions are scaled back to that size.
    """

    has_overlay: ClassVar[bool] = True  # whether triangles can be drawn over the canvas

    display: Host
    width: int  # the size of the surface for the next drawing call; the canvas follows then
    height: int
    title: str
    resizable: bool
    hooks: Hooks = field(default_factory=dict)
    is_open: bool = True
    pointer: tuple[int, int] = (0, 0)
    cursor: Cursor = Cursor.ARROW
    icons: tuple[MlxImage, ...] = ()
    scale: float = 1.0  # of its screen: 2 where dots are half as large as usual

    # Between the window and its display:
    visible: bool = True
    stale: bool = True  # the screen does not show the canvas any more
    resized: bool = False  # a resize is not reported to the program yet
    announced: bool = False  # the first MAP_NOTIFY was delivered

    def __post_init__(self) -> None:
        """Open the window, and set the size that a resizable one really got. Raises MlxError."""
        self.shown = self._new_canvas()  # as last drawn on: after a resize of the old size, and stretched on the screen
        self.keyboard = Keyboard(self.deliver, self.display.options)

    @property
    def canvas(self) -> Canvas:
        """The canvas to draw on: of the window's size, black where it is new."""
        if (self.shown.width, self.shown.height) != (self.width, self.height):
            self.shown = self._new_canvas()
        return self.shown

    def _new_canvas(self) -> Canvas:
        return Canvas(self.width, self.height, alpha=self.display.options.alpha)

    def show(self) -> None:
        """Bring the canvas to the screen now."""
        self.stale = False
        self.blit()

    def deliver(self, event: Event | str, *arguments: int) -> None:
        """Call the hook on `event`, if there is one, with plain integers: programs print them."""
        if self.is_open:
            self.display.call(self.hooks, event, *map(int, arguments))

    # --- what a back end does; what is not abstract may be missing where the platform has no such thing ---

    @abstractmethod
    def blit(self) -> None:
        """Bring `shown` to the screen now, stretched to the window (nearest pixel) if the sizes differ."""

    def close(self) -> None:
        """Take the window from the screen. Never called inside a hook."""

    @abstractmethod
    def set_fullscreen(self, on: bool) -> None:
        """Cover the screen, or return to the size before; the new size is reported as a resize."""

    def set_title(self) -> None:
        """Show `title`."""

    def set_icons(self) -> None:
        """Show one of `icons` where the desktop shows an icon of the window."""

    def set_cursor(self) -> None:
        """Give the pointer the shape of `cursor`."""

    def show_pointer(self, on: bool) -> None:
        """Show or hide the pointer over the window."""

    def move_pointer(self, x: int, y: int) -> None:
        """Move the pointer to x, y from the window's top left corner."""

    def letter_at(self, american: str) -> str:
        """The letter that a key prints which has another one on American keyboards, '' if the platform tells none."""
        return ""

    def get_clipboard(self) -> str:
        """The text on the clipboard, or an empty string; that of this program alone if the platform has none."""
        return self.display.clipboard

    def set_clipboard(self, text: str) -> None:
        """Put text on the clipboard."""
        self.display.clipboard = text

    # --- events, as back ends report them; keys go to `keyboard` ---

    def on_text(self, text: str) -> None:
        """Report typed text; control characters are ignored."""
        if self.is_open and text.isprintable():
            self.display.call(self.hooks, "text", text)

    def on_drop(self, files: Iterable[str]) -> None:
        """Report files that were dropped on the window, one by one."""
        for file in files:
            if self.is_open:
                self.display.call(self.hooks, "drop", file)

    def place_pointer(self, x: int, y: int) -> None:
        """Note the pointer's position from the top left corner, clamped to the window, without an event."""
        self.pointer = min(max(x, 0), self.width - 1), min(max(y, 0), self.height - 1)

    def on_button(self, event: Event, button: int, x: int, y: int) -> None:
        """Report a button that was pressed or released at x, y."""
        self.place_pointer(x, y)
        self.deliver(event, button, *self.pointer)

    def on_motion(self, x: int, y: int) -> None:
        """Report that the pointer moved to x, y."""
        self.place_pointer(x, y)
        self.deliver(Event.MOTION_NOTIFY, *self.pointer)

    def on_scroll(self, right: int, up: int, x: int, y: int) -> None:
        """Report steps of the wheel as presses and releases of its buttons; negative steps go left and down."""
        steps = [Button.WHEEL_UP if up > 0 else Button.WHEEL_DOWN] * abs(up)
        steps += [Button.WHEEL_RIGHT if right > 0 else Button.WHEEL_LEFT] * abs(right)
        for step in steps:
            self.on_button(Event.BUTTON_PRESS, step, x, y)
            self.on_button(Event.BUTTON_RELEASE, step, x, y)

    def on_focus(self, focused: bool) -> None:
        """Report that the window got or lost the focus; held keys are released when it is lost."""
        if not focused:
            self.keyboard.release_all()
        self.deliver(Event.FOCUS_IN if focused else Event.FOCUS_OUT)

    def on_resize(self, width: int, height: int) -> None:
        """Note the new size of the frame buffer. The next turn reports the latest size to the program."""
        self.stale = True
        if self.resizable and (width, height) != (self.width, self.height):
            self.width, self.height = width, height
            self.resized = True

    def on_expose(self) -> None:
        """Report that the window has to be drawn again; the first time comes with MAP_NOTIFY."""
        self.stale = True
        if self.announced:
            self.deliver(Event.EXPOSE)

    def on_visibility(self, visible: bool) -> None:
        """Report that the window was hidden or shown. A hidden window is not drawn; everything else goes on."""
        if visible != self.visible:
            self.visible = visible
            self.stale = True
            self.deliver(Event.MAP_NOTIFY if visible else Event.UNMAP_NOTIFY)

    def on_close_button(self) -> None:
        """Report a click on the close button."""
        self.deliver(Event.DESTROY_NOTIFY)
        self.deliver(Event.CLIENT_MESSAGE)
