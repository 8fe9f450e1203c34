"""Event dispatch: the hooks of a window call the session, the editor, the commands and the mouse."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from minirt.errors import MlxError
from minirt.mlx.events import Button, Event
from minirt.viewer.app.choosing import ADDING, LISTS, Choosing
from minirt.viewer.app.commands import COMMANDS, follow_change, offer_found, open_another
from minirt.viewer.app.explaining import choose_row
from minirt.viewer.app.holding import advance
from minirt.viewer.app.judging import PictureJudge
from minirt.viewer.app.keyboard import KeyDispatcher
from minirt.viewer.app.menu import OPEN_MENU
from minirt.viewer.app.mouse import Mouse
from minirt.viewer.app.open_help import help_takes
from minirt.viewer.app.session import Session
from minirt.viewer.app.typed_value import BEGUN, EMPTY, Typing
from minirt.viewer.bindings import Binding
from minirt.viewer.editing.editor import EDITS, apply
from minirt.viewer.recovery import remember_panel

if TYPE_CHECKING:
    from minirt.viewer.panel.panel import Panel

PANEL = "toggle panel"  # the action that opens the panel
NO_PANEL = "the panel needs a window of its own, and slimgui: pip install 'minirt[panel]'"
BESIDE = 30  # pixels from the pointer on a tool to the list that it opens
BELOW = 3  # sizes of text from the top to a list beside the panel
NEAR = 3.0  # sizes of the tab of the panel: a pointer so close to it shows it


class EventDispatcher:
    """Handlers for the events of a session's window."""

    def __init__(self, session: Session) -> None:
        """Make the handlers the hooks of the window."""
        self.session = session
        self.mouse = Mouse(session, self.perform)
        self.typing = Typing(session)
        self.judge = PictureJudge(session)
        self.choosing = Choosing(session, self.perform)
        self.keyboard = KeyDispatcher(session, self.typing, self.choosing, self.perform)
        self.panel: Panel | None = None  # once it was opened
        self._tick_hook = self.as_hook(self.on_tick)
        mlx, window = session.mlx, session.window
        handlers: dict[Event, Callable[..., None]] = {
            Event.EXPOSE: session.update,
            Event.KEY_PRESS: self.keyboard.on_press,
            Event.KEY_RELEASE: self.keyboard.on_release,
            Event.BUTTON_PRESS: self.on_button,
            Event.BUTTON_RELEASE: lambda button, _x, _y: self.mouse.on_release(button),
            Event.MOTION_NOTIFY: self.mouse.on_motion,
            Event.ENTER_NOTIFY: partial(setattr, self.mouse, "inside", True),
            Event.LEAVE_NOTIFY: partial(setattr, self.mouse, "inside", False),
            Event.FOCUS_IN: lambda: None,  # for the panel alone
            Event.FOCUS_OUT: session.release_button,
            Event.DESTROY_NOTIFY: session.quit,
        }
        for event, handler in handlers.items():
            mlx.mlx_hook(window, event, 0, self.as_hook(partial(self.offer, event, handler)), None)
        mlx.mlx_text_hook(window, self.as_hook(partial(self.offer, "text", self.keyboard.on_press)))
        mlx.mlx_drop_hook(window, self.as_hook(self.on_drop))
        mlx.mlx_resize_hook(window, self.as_hook(self.on_resize))
        mlx.mlx_wake_hook(session.display, self.as_hook(self.on_wake))

    def offer(self, event: Event | str, handler: Callable[..., object], *arguments: Any) -> None:
        """Offer an event, with the arguments of its hook, to the panel, the tab, the list of rays, the tool row and the
        line on top; call `handler` with the arguments if none of them takes the event."""
        if self.panel and self.panel.is_open and self.panel.takes(event, *arguments):
            if event == Event.BUTTON_PRESS:  # a click on the panel closes a list or a typed value
                self.typing.end()
                self.choosing.end()
            self.session.screen.tool = None
            return
        session, screen = self.session, self.session.screen
        match event, arguments:
            case Event.BUTTON_PRESS, (Button.LEFT, x, y) if screen.has_tab and screen.is_on_tab(x, y):
                self.toggle_panel()
            case Event.BUTTON_PRESS, (button, x, y) if choose_row(session, button, x, y):
                pass  # the row is chosen by the condition
            case Event.BUTTON_PRESS, (Button.LEFT, x, y) if not self.choosing.row_at(x, y) and screen.tool_at(x, y):
                self.use_tool(x, y)
            case Event.BUTTON_PRESS, (Button.RIGHT | Button.MIDDLE, x, y) if screen.tool_at(x, y):
                pass  # what lies behind the tool is not meant
            case Event.BUTTON_PRESS, (Button.LEFT, x, y) if self.is_on_line(x, y):
                if value := screen.value_at(session.state, x, y):  # beside the values a click does nothing
                    session.show(session.state.with_active(value))
                    self.typing.begin(EMPTY)
            case Event.MOTION_NOTIFY, (x, y) if self.choosing.takes_motion(x, y):
                pass  # the row under the pointer is marked by the condition
            case Event.MOTION_NOTIFY, (x, y):
                handler(x, y)
                self.show_controls(x, y)
            case _:
                handler(*arguments)

    def show_controls(self, x: int, y: int) -> None:
        """Show the tab of the panel where the pointer is near it, and the name of the tool that it is on."""
        session, screen = self.session, self.session.screen
        screen.has_tab = not (session.pressed or (self.panel and self.panel.is_open)) and screen.is_on_tab(x, y, NEAR)
        screen.tool = None if session.pressed or screen.list_box else screen.tool_at(x, y)
        session.refresh()  # handles may come or go, too

    def is_on_line(self, x: int, y: int) -> bool:
        """Whether a pixel is on the line on top, and on no list or icon there."""
        session = self.session
        is_free = not self.choosing.is_open and session.screen.is_on_line(session.state, x, y)
        return is_free and not self.mouse.icon_at(x, y)

    def use_tool(self, x: int, y: int) -> None:
        """Use the tool at a pixel, where one must be. An open list or a typed value is closed first; after an open list
        a tool that opens a list does no more."""
        session, is_open = self.session, self.choosing.is_open
        session.pointer, tool = (x, y), session.screen.tool_at(x, y)
        assert tool
        self.typing.end()
        self.choosing.end()
        session.screen.tool = None  # its name would cover a list
        if tool.handles:
            session.screen.handle_kind = "" if session.screen.handle_kind == tool.handles else tool.handles
            session.refresh()
        elif not (is_open and tool.action in LISTS):
            self.choosing.perform_at((x + BESIDE, y), tool.action)

    def on_button(self, button: int, x: int, y: int) -> None:
        """A mouse button goes down, or the wheel turns."""
        if self.session.screen.help:
            help_takes(self.session, button, None)
            return
        if self.choosing.takes_button(button, x, y):
            return
        shows_handles = self.session.screen.shows_handles(self.session.state)
        self.typing.end()
        self.choosing.end()
        self.mouse.on_press(button, x, y, shows_handles)

    def on_tick(self) -> None:
        """A sixtieth of a second passed while a key is held, the panel is busy, or words wait for their picture."""
        advance(self.session)
        if self.panel and self.panel.is_busy:
            self.panel.frame()

    def on_wake(self) -> None:
        """Show what another thread has woken the event loop for: results of the painter, or a change of the file."""
        session = self.session
        if session.file.news.is_set():
            session.file.news.clear()
            session.attempt(follow_change)
        for error in session.refinement.collect():
            session.show_error(error)
        session.attempt(Session.take_screenshot)
        self.judge.judge()
        session.refresh()
        session.update()
        session.give_back_memory()
        if session.wants_panel:
            session.wants_panel = False
            self.toggle_panel(has_keys=False)

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

    def perform(self, binding: Binding) -> None:
        """Perform the action of a key binding: an edit of the scene, or a command."""
        session, action = self.session, binding.action
        session.release_button()
        if action == PANEL:
            self.toggle_panel()
            return
        if action in BEGUN:
            if self.panel:
                self.panel.is_left = True  # the keys are those of the picture
            self.typing.begin(BEGUN[action](session.state.element))
            return
        if action == OPEN_MENU:
            self.choosing.begin_menu(session.pointer, self.mouse.select_for_menu())
            return
        if action in LISTS:
            aim = self.mouse.aim(self.choosing.target) if action in ADDING else session.state.aim
            self.choosing.begin(action, replace(session.state, aim=aim))
            return
        if action in EDITS:
            session.state = apply(session.state, action, 1.0, session.now)
        else:
            session.say("")
            session.attempt(COMMANDS[action])
        session.show(session.state)

    def perform_for_panel(self, binding: Binding) -> None:
        """Perform the action of a button of the panel; a list that it opens is beside the panel."""
        screen = self.session.screen
        self.choosing.perform_at((screen.size[0], BELOW * screen.text_size), binding.action)

    def toggle_panel(self, has_keys: bool = True) -> None:
        """Open the panel, or close it if it is open; a message says if the window cannot have one. `has_keys`: whether
        keys go to the panel once it is open. slimgui is imported when the panel first opens."""
        session = self.session
        session.screen.has_tab, session.screen.help = False, 0
        try:
            if not session.window.has_overlay:
                raise ImportError
            from minirt.viewer.panel.panel import Panel
        except ImportError:
            session.say(NO_PANEL)
            session.refresh()
        else:
            self.panel = self.panel or Panel(session, self.perform_for_panel)
            self.panel.open(is_open=not self.panel.is_open, has_keys=has_keys)
        if session.recovery:
            remember_panel(is_open=bool(self.panel and self.panel.is_open))

    def as_hook(self, handler: Callable[..., object]) -> Callable[..., object]:
        """Wrap a handler as a hook of MiniLibX, whose last argument is a parameter that the handler does not need.

        After each call of the handler the event loop ticks while a key is held, the panel is busy, or the words in the
        window describe an older scene than the current one; otherwise it sleeps until the next event.
        An error of the handler is shown as a message. Only an MlxError is raised again, and ends the window.
        """

        def hook(*arguments: object) -> None:
            session, panel = self.session, self.panel  # not a panel that the handler makes: that one shows itself
            try:
                handler(*arguments[:-1])
            except MlxError:
                raise
            except Exception as error:
                session.show_error(error)
            self.judge.judge()  # a list that hid what is to be said may be closed now
            if panel:
                panel.follow()
            ticks = session.held_keys or session.words_wait or (panel and panel.is_busy)
            session.mlx.mlx_loop_hook(session.display, self._tick_hook if ticks else None, None)

        return hook
