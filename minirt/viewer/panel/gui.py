"""Gui: Dear ImGui in a window of MiniLibX: its font and colours, events in, frames, and triangles out.

Only this package imports `slimgui`, and it is imported when the panel first opens. Frames are made after events alone.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from PIL import ImageFont
from slimgui import imgui

from minirt.mlx.events import Button, Event, Key, Modifier
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import BY_ACTION, Binding
from minirt.viewer.editing.state import State
from minirt.viewer.language import translated
from minirt.viewer.panel.style import set_colours, set_spaces

ARROWS = {key: f"KEY_{key.name}_ARROW" for key in (Key.LEFT, Key.RIGHT, Key.UP, Key.DOWN)}
ENTER = {Key.RETURN: "KEY_ENTER", Key.KEYPAD_ENTER: "KEY_ENTER"}
NAMED = {each: f"KEY_{each.name}" for each in Key if f"KEY_{each.name}" in imgui.Key.__members__}
KEYS: dict[int, Any] = {key: imgui.Key[name] for key, name in (NAMED | ARROWS | ENTER).items()}
FUNCTION_KEYS = range(Key.F1, Key.F12 + 1)  # of the window even while the panel has the keys
OF_THE_PICTURE = (*range(Key.A, Key.Z + 1), Key.DELETE)  # unless a text is edited
MODIFIERS = {Modifier.ACCEL: imgui.Key.MOD_CTRL, Modifier.SHIFT: imgui.Key.MOD_SHIFT, Modifier.ALT: imgui.Key.MOD_ALT}
BUTTONS = {Button.LEFT: 0, Button.MIDDLE: 2, Button.RIGHT: 1}
WHEEL = {Button.WHEEL_UP: 1.0, Button.WHEEL_DOWN: -1.0}
NOWHERE = -3.4028234663852886e38  # where the pointer is when it has left the window
SETTLING = 2  # frames after an event: the second one shows what the first one has changed
SHORTEST = 1e-3  # seconds between two frames
LONGEST = 0.05  # seconds between two frames while a key is held: a slow picture does not repeat a short press


class Gui:
    """A context of Dear ImGui for the window of a session."""

    def __init__(self, session: Session, build: Callable[[], None], perform: Callable[[Binding], None]) -> None:
        """`build` declares the widgets of a frame; `perform` performs an action of the table of keys."""
        self.session, self._build, self._perform = session, build, perform
        self.wanted = ""  # the action of a button that was clicked, until the end of the frame
        self.is_open = False
        self.io = imgui.create_context().io
        self.size = 0  # of text, in pixels
        self.left = 0.0  # border of the panel, in pixels
        self.typed = ""  # characters since the last frame
        self.has_popup = False  # whether a list or a picker is open
        self.unsettled = 0  # frames that have to follow
        self.is_left = False  # by Escape
        self._held: set[int] = set()  # keys that are down in the panel
        self._context = imgui.get_current_context()
        self._time = session.now
        self._is_changed = False  # whether the frame that is being made has changed the session's state
        self.io.ini_filename = self.io.log_filename = None
        self.io.config_input_text_cursor_blink = False
        self.io.config_nav_escape_clear_focus_window = True
        self.io.config_flags |= imgui.ConfigFlags.NAV_ENABLE_KEYBOARD
        self.io.backend_flags |= imgui.BackendFlags.RENDERER_HAS_VTX_OFFSET
        self.io.backend_flags |= imgui.BackendFlags.RENDERER_HAS_TEXTURES
        font: Any = ImageFont.load_default(16)  # that of the window's own texts
        self.io.fonts.add_font_from_memory_ttf(font.font_bytes)
        accented = imgui.FontConfig()  # letters that the first font lacks
        accented.merge_mode = True
        self.io.fonts.add_font_default(accented)
        set_colours()

    @property
    def is_busy(self) -> bool:
        """Whether frames follow each other: a key is held in the panel, which repeats with time."""
        return self.is_open and bool(self._held)

    @property
    def has_keys(self) -> bool:
        """Whether keys go to the panel: after it was opened or clicked, until Escape or a click on the picture."""
        return bool(self.io.want_capture_keyboard) and not self.is_left

    @property
    def types(self) -> bool:
        """Whether a text is being edited."""
        return bool(self.io.want_text_input)

    def takes(self, event: Event | str, *arguments: Any) -> bool:
        """Pass an event to Dear ImGui; return whether the panel takes it, so that it is not one of the picture.

        `arguments`: x, y of a motion; button, x, y; the code of a key; the characters of "text". After a button that
        goes down on the picture the panel wants no keys.
        """
        taken = False
        match event, arguments:
            case Event.MOTION_NOTIFY, (x, y):
                is_needed = x >= self.left or self.has_popup or self.io.want_capture_mouse
                if is_needed and not self.session.pressed:
                    self.point(x, y)
                    taken = bool(self.io.want_capture_mouse)
            case ((Event.BUTTON_PRESS | Event.BUTTON_RELEASE), (button, x, y)):
                taken = self.on_button(button, event == Event.BUTTON_PRESS, x, y)
            case ((Event.KEY_PRESS | Event.KEY_RELEASE), (code,)):
                taken = self.on_key(code, event == Event.KEY_PRESS)
            case "text", (text,) if self.has_keys:
                self.typed = text
                self.io.add_input_characters_utf8(text)
                self.settle()
                taken = True
            case (Event.LEAVE_NOTIFY, ()):
                self.point(NOWHERE, NOWHERE)
            case ((Event.FOCUS_IN | Event.FOCUS_OUT), ()):
                self._held.clear()
                self.io.add_focus_event(event == Event.FOCUS_IN)
                self.settle()
        return taken

    def point(self, x: float, y: float) -> None:
        """Move the pointer to a pixel."""
        self.io.add_mouse_pos_event(x, y)
        self.settle()

    def on_button(self, button: int, down: bool, x: int, y: int) -> bool:
        """A mouse button goes down or up, or the wheel turns."""
        self.point(x, y)
        taken = bool(self.io.want_capture_mouse)
        self.is_left &= not taken
        if button in BUTTONS:
            self.io.add_mouse_button_event(BUTTONS[Button(button)], down)
        elif button in WHEEL and taken and down:
            self.io.add_mouse_wheel_event(0.0, WHEEL[Button(button)])
        self.settle()
        return taken

    def on_key(self, code: int, down: bool) -> bool:
        """Handle a key that goes down or up; return whether the panel takes it.

        The window has the function keys and, unless a text is edited, shortcuts, letters and all keys of an open list.
        After a letter, as after Escape, all keys are those of the picture.
        """
        if down:
            is_shortcut = Modifier.ACCEL in self.session.modifiers
            if is_shortcut and self.types and code == Key.S:  # what is typed is set, and then saved
                self.on_key(Key.RETURN, down=True)
                self.on_key(Key.RETURN, down=False)
            is_for_picture = is_shortcut or code in OF_THE_PICTURE or self.session.screen.list_box is not None
            is_for_window = code in FUNCTION_KEYS or (is_for_picture and not self.types)
            taken = self.has_keys and not is_for_window
            ends = code in (*OF_THE_PICTURE, Key.ESCAPE) and not is_shortcut
            self.is_left |= ends and not self.types and not self.has_popup
        else:  # a key that went down in the panel goes up there
            taken = code in self._held
        if taken:
            (self._held.add if down else self._held.discard)(code)
            self.io.add_key_event(KEYS.get(code, imgui.Key.KEY_NONE), down)
            self.settle()
        return taken

    def settle(self) -> None:
        """Make the frames that follow an event."""
        imgui.set_current_context(self._context)
        for modifier, key in MODIFIERS.items():
            self.io.add_key_event(key, modifier in self.session.modifiers)
        self.unsettled = SETTLING
        while self.unsettled:
            self.unsettled -= 1
            self.frame()

    def show(self, state: State) -> None:
        """Make `state` the current one; the window shows it after the frame, as none is drawn while one is made."""
        self.session.state, self._is_changed = state, True

    def frame(self) -> None:
        """Make a frame, let the window show what it has changed, and perform the action of a clicked button."""
        imgui.set_current_context(self._context)
        now, window = self.session.now, self.session.window
        longest = LONGEST if self._held else inf
        self.io.delta_time, self._time = min(max(now - self._time, SHORTEST), longest), now
        self.io.display_size = window.width, window.height
        imgui.new_frame()
        imgui.push_font(None, float(self.size))
        self._build()
        imgui.pop_font()
        imgui.render()
        self.typed = ""
        window.stale = True
        if self._is_changed:
            self._is_changed = False
            self.session.show(self.session.state)
        if self.wanted:
            action, self.wanted = self.wanted, ""
            self._perform(BY_ACTION[action])
            self.is_left |= self.session.screen.list_box is not None  # a list that opened has the keys

    def buttons(self, titles: dict[str, str]) -> None:
        """Show buttons for actions of the table of keys, beside each other as far as they fit."""
        for number, (action, title) in enumerate(titles.items()):
            if number:
                self.go_on(imgui.calc_text_size(translated(title))[0] + 2 * imgui.get_style().frame_padding[0])
            if imgui.button(f"{translated(title)}###{action}"):
                self.wanted = action

    def hint(self, text: str, limits: str = "") -> None:
        """Show a text while the pointer rests on the last widget, with the limits of a value."""
        if text and imgui.begin_item_tooltip():
            imgui.text(translated(text) + (f", {translated('in')} {limits}" if limits else ""))
            imgui.end_tooltip()

    def go_on(self, width: float) -> None:
        """Show the next widget beside the last one if there is so much room, below it otherwise."""
        imgui.same_line()
        if imgui.get_content_region_avail()[0] < width:
            imgui.new_line()

    def resize_text(self, size: int) -> None:
        """Set the size of text, and of all spaces with it, from the next frame on."""
        if size != self.size:
            self.size = size
            set_spaces(size)

    def paint(self, painter: Any) -> None:
        """Draw the last frame over the canvas: see `Mlx.mlx_overlay_hook`."""
        imgui.set_current_context(self._context)
        data = imgui.get_draw_data()
        for texture in data.textures or ():
            update(texture, painter)
        for each in data.commands_lists:
            runs = [
                (run.tex_ref.get_tex_id(), run.clip_rect, run.elem_count, run.idx_offset, run.vtx_offset)
                for run in each.commands
            ]
            painter.draw(each.vtx_buffer_data, each.vtx_buffer_size, each.idx_buffer_data, each.idx_buffer_size, runs)


def update(texture: Any, painter: Any) -> None:
    """Copy a texture of letters to the graphics card, if it is new or has new letters; free one that is not used."""
    status = imgui.TextureStatus
    if texture.status in (status.WANT_CREATE, status.WANT_UPDATES):
        pixels = texture.get_pixels().ctypes.data
        texture.set_tex_id(painter.upload(texture.get_tex_id(), texture.width, texture.height, pixels))
        texture.set_status(status.OK)
    elif texture.status == status.WANT_DESTROY and texture.unused_frames > 0:
        painter.delete(texture.get_tex_id())
        texture.set_tex_id(0)
        texture.set_status(status.DESTROYED)
