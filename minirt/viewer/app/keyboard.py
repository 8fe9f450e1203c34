"""Keys and typed characters: the help, typed values and lists take them first; then their bindings are performed."""

from __future__ import annotations

from collections.abc import Callable

from minirt.mlx.events import MODIFIER_KEYS, Key
from minirt.viewer.app.choosing import Choosing
from minirt.viewer.app.holding import hold, release
from minirt.viewer.app.open_help import HELP, help_takes
from minirt.viewer.app.session import Session
from minirt.viewer.app.typed_value import Typing
from minirt.viewer.bindings import BY_ACTION, SIGNIFICANT, Binding

REPEATED = ("grow", "shrink")  # actions of characters that go on while their key is held


class KeyDispatcher:
    """Handlers of keys; `perform` does what a binding names."""

    def __init__(
        self, session: Session, typing: Typing, choosing: Choosing, perform: Callable[[Binding], None]
    ) -> None:
        self.session = session
        self.typing = typing
        self.choosing = choosing
        self.perform = perform
        self._unbound: int | None = None  # the key without a binding that is down: it types the next character

    def on_press(self, code: int | str) -> None:
        """Handle a key that goes down, by its code, or one or more characters that were typed."""
        session = self.session
        if isinstance(code, str):  # Shift may be a part of typing them
            for character in code:
                self.on_character(character)
            return
        session.keymap.follow(session.window.letter_at)
        session.screen.tool = None
        pressed = session.keymap.find(code, session.modifiers)
        self._unbound = None if pressed or code in MODIFIER_KEYS else code
        if help_takes(session, code, pressed) or self.typing.takes(code):
            return
        if self.choosing.is_open and self.choosing.names_value and code == Key.TAB:  # the next value after a colour
            self.choosing.take()
            self.typing.go_on(whole=True)
            return
        if self.choosing.takes(code, pressed):
            return
        is_letter = Key.A <= code <= Key.Z and not session.modifiers & SIGNIFICANT
        if self.typing.is_colour and is_letter:  # the first letter of the word for a colour
            self.typing.end()
            self.perform(BY_ACTION["choose colour"])
            self.choosing.takes(code, None)
            self.choosing.names_value = True
            return
        if pressed:  # any other key that does something closes a list or a typed value
            self.typing.end()
            self.choosing.end()
            if pressed.held:
                hold(session, pressed, code)
            else:
                self.perform(pressed)

    def on_character(self, character: str) -> None:
        """Handle a typed character: a part of a value, or one that a binding names.

        Others do nothing. While the help is open, only the character that closes the help counts.
        """
        session = self.session
        if self.typing.text:
            self.typing.on_text(character)
            return
        binding, key = session.keymap.find(character), self._unbound
        if session.screen.help and (not binding or binding.action != HELP):
            return
        if character.isascii() and character.isdigit():
            self.choosing.end()
            self.typing.begin(character)
        elif binding:
            self.choosing.end()
            if binding.action not in REPEATED or key is None:
                self.perform(binding)
            elif key not in session.held_keys:
                hold(session, binding, key, is_typed=True)

    def on_release(self, code: int) -> None:
        """A key goes up: its last steps are done, and a still picture is requested."""
        release(self.session, code)
        self._unbound = None if code == self._unbound else self._unbound
        self.session.update()
