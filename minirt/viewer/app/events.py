"""Event dispatch: the hooks of a window call the session, the editor, the commands and the mouse."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from minirt.mlx import Event
from minirt.mlx.events import MODIFIER_KEYS
from minirt.viewer.app.commands import COMMANDS, follow_change, offer_found, open_another
from minirt.viewer.app.mouse import Mouse
from minirt.viewer.app.panels import ADDING, LISTS, TYPE, Choosing, Typing
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import SIGNIFICANT, Binding
from minirt.viewer.editing import structure
from minirt.viewer.editing.editor import EDITS, apply
from minirt.viewer.editing.state import State
from minirt.viewer.key_repeat import Advance

REPEATED = ("grow", "shrink")  # actions of characters that go on while their key is held


class EventDispatcher:
    """Handlers for the events of a session's window."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.mouse = Mouse(session, self.perform)
        self.held_edits = HeldEdits()
        self.typing = Typing(session)
        self.choosing = Choosing(session)
        self._unbound: int | None = None  # the key without a binding that is down: it types the next character
        self._typed: int | None = None  # the last key that repeats because its character is bound
        self._tick_hook = self.as_hook(self.on_tick)

    def connect(self) -> None:
        """Install the handlers as hooks of the window."""
        session = self.session
        mlx, window = session.mlx, session.window
        handlers: dict[Event, Callable[..., None]] = {
            Event.EXPOSE: session.update,
            Event.KEY_PRESS: self.on_press,
            Event.KEY_RELEASE: self.on_release,
            Event.BUTTON_PRESS: self.on_button,
            Event.BUTTON_RELEASE: lambda button, _x, _y: self.mouse.on_release(button),
            Event.MOTION_NOTIFY: self.mouse.on_motion,
            Event.ENTER_NOTIFY: lambda: self.mouse.on_crossing(True),
            Event.LEAVE_NOTIFY: lambda: self.mouse.on_crossing(False),
            Event.FOCUS_OUT: session.release_button,
            Event.DESTROY_NOTIFY: session.quit,
        }
        for event, handler in handlers.items():
            mlx.mlx_hook(window, event, 0, self.as_hook(handler), None)
        mlx.mlx_text_hook(window, self.as_hook(self.on_press))
        mlx.mlx_drop_hook(window, self.as_hook(self.on_drop))
        mlx.mlx_resize_hook(window, self.as_hook(self.on_resize))
        mlx.mlx_wake_hook(session.display, self.as_hook(self.on_wake))

    def on_press(self, code: int | str) -> None:
        """A key goes down, or a character was typed."""
        session = self.session
        if isinstance(code, str):  # one or more characters; Shift may be part of typing them
            for character in code:
                self.on_character(character)
            return
        pressed = session.keymap.find(code, session.modifiers)
        self._unbound = None if pressed or code in MODIFIER_KEYS else code
        if self.is_for_panel(code, pressed):
            return
        if pressed and pressed.held:
            self.hold(pressed, code)
        elif pressed:
            self.perform(pressed, session.step)

    def is_for_panel(self, key: int, pressed: Binding | None) -> bool:
        """Let the typed value or the open list take a key press; any other key that does something closes them."""
        if self.typing.text:
            if self.typing.on_key(key):
                return True
            if pressed:
                self.typing.show("")
        elif self.choosing.is_open:
            again = pressed and pressed.action in LISTS and not self.choosing.is_filtered
            if not again and not self.session.modifiers & SIGNIFICANT and self.choosing.on_key(key):
                return True
            if pressed and not again:
                self.choosing.end()
        return False

    def on_button(self, button: int, x: int, y: int) -> None:
        """A mouse button goes down, or the wheel turns: what is typed is left, and the list is closed."""
        if self.typing.text:
            self.typing.show("")
        self.choosing.end()
        self.mouse.on_press(button, x, y)

    def on_character(self, character: str) -> None:
        """A character was typed: of a value, or one that a binding names."""
        if self.typing.text:
            self.typing.on_text(character)
            return
        binding = self.session.keymap.find(character)
        if character.isascii() and character.isdigit():
            self.choosing.end()
            self.typing.begin(character)
        elif binding:
            self.choosing.end()
            if binding.action not in REPEATED or self._unbound is None:
                self.perform(binding, 1.0)
            elif not self.session.key_repeat.holds(self._unbound):
                self._typed = self._unbound
                self.hold(binding, self._unbound)

    def on_release(self, code: int) -> None:
        """A key goes up: its last steps are done, and a still picture is requested."""
        session = self.session
        self.apply_advances(session.key_repeat.release(code, session.now))
        self._unbound = None if code == self._unbound else self._unbound
        session.update()

    def on_tick(self) -> None:
        """A sixtieth of a second passed while a key is held or words wait for their picture."""
        session = self.session
        waited = session.words_wait
        self.apply_advances(session.key_repeat.advance(session.now))
        if waited:
            session.draw_late_words()

    def on_wake(self) -> None:
        """Another thread woke the event loop: the painter has a result, or the file has changed."""
        session = self.session
        if session.file_changed.is_set():
            session.file_changed.clear()
            follow_change(session)
        for error in session.refinement.collect():
            session.show_error(error)
        session.attempt(Session.take_screenshot)
        session.judge_view()
        session.refresh()
        session.update()
        session.give_back_memory()

    def on_resize(self, _width: int, _height: int) -> None:
        """The window has another size: the pointer is over another part of the picture, so a drag ends."""
        self.session.release_button()
        self.session.has_unused_memory = True
        self.session.update()

    def on_drop(self, file: str) -> None:
        """A file was dropped on the window."""
        self.session.attempt(lambda session: open_another(session, Path(file)))
        if self.session.path == Path(file):
            offer_found(self.session)
        self.session.show(self.session.state)

    def perform(self, binding: Binding, step: float) -> None:
        """Perform the action of a key binding: an edit of the scene, or a command."""
        session = self.session
        session.release_button()
        if binding.action in ADDING and not structure.is_adding(session.state):
            session.state = replace(session.state, aim=self.mouse.aim())
        if binding.action in EDITS:
            before = session.state
            session.state = apply(before, binding.action, step if binding.fine else 1.0, session.now)
            if binding.action in LISTS:
                self.choosing.begin(binding.action, before)
            session.show(session.state)
            return
        if binding.action == TYPE:
            self.typing.begin("=")
            return
        session.state = session.state.with_message("")
        session.attempt(COMMANDS[binding.action])
        session.show(session.state)

    def hold(self, binding: Binding, key: int) -> None:
        """Begin the action of a key that goes on while the key is held."""
        self.session.release_button()
        self.apply_advances(self.session.key_repeat.press(key, binding.action, self.session.now))

    def apply_advances(self, advances: list[Advance]) -> None:
        """Continue the actions of held keys."""
        session = self.session
        state = session.state
        for advance in advances:
            step = 1.0 if advance.key == self._typed else session.step  # Shift may be part of typing a character
            state = self.held_edits.apply(state, advance, step, session.now)
        if state is not session.state:
            session.show(state)

    def as_hook(self, handler: Callable[..., object]) -> Callable[..., object]:
        """Wrap a handler as a hook of MiniLibX, whose last argument is a parameter that the handler does not need.

        After it, the event loop ticks while a key is held or words wait, and sleeps until the next event otherwise.
        """

        def hook(*arguments: object) -> None:
            handler(*arguments[:-1])
            session = self.session
            ticks = session.key_repeat or session.words_wait
            session.mlx.mlx_loop_hook(session.display, self._tick_hook if ticks else None, None)

        return hook


class FirstStep(NamedTuple):
    """The first step of a held key, of which a part was taken."""

    key: int
    size: float  # of a step when the key was pressed
    before: State  # the state before the key was pressed
    after: State  # the state after the part


class HeldEdits:
    """Applies the progress of held keys to the state of the editor.

    The first step comes in parts, so that the picture moves at once and never stands still. Each part replaces the part
    before: a tap leaves what one whole step leaves, to the last digit.
    """

    def __init__(self) -> None:
        self._first: FirstStep | None = None  # of the last pressed key

    def apply(self, state: State, advance: Advance, size: float, now: float) -> State:
        """Return the state after the progress of a key; `size` is that of a step now."""
        if advance.after == advance.before:
            return state
        done, first = advance.before, self._first
        if first and first.key == advance.key and first.after is state:
            done, state, size = 0.0, first.before, first.size
        before = state
        if done < 1:
            state = apply(before, advance.action, (min(advance.after, 1.0) - done) * size, now)
        if advance.after > 1:
            state = apply(state, advance.action, (advance.after - max(done, 1.0)) * size, now)
        self._first = FirstStep(advance.key, size, before, state) if done == 0.0 and advance.after < 1 else None
        return state
