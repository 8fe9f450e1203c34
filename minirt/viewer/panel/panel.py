"""Panel: what F1 opens at the right of the window: elements and their values, the scene, the history, pictures.

It is a client of the session as keys are: it edits by the same functions. It takes keys only while it has the focus,
and the pointer only while that is over it.
"""

from __future__ import annotations

from collections.abc import Callable

from slimgui import imgui

from minirt.viewer.app.session import Session
from minirt.viewer.bindings import Binding
from minirt.viewer.language import translated
from minirt.viewer.panel.elements import Elements
from minirt.viewer.panel.groups import Groups
from minirt.viewer.panel.gui import Gui
from minirt.viewer.panel.pages import Pages
from minirt.viewer.panel.rows import Rows

WIDTH, SHARE = 21.0, 0.6  # of the panel: in sizes of text, and of a narrow window
LETTERS, READABLE = 30, 12  # in a narrow window text becomes smaller, so that so many fit, but not below so many pixels
FRAME = imgui.WindowFlags.NO_DECORATION | imgui.WindowFlags.NO_MOVE | imgui.WindowFlags.NO_SAVED_SETTINGS
TABS = imgui.TabBarFlags.FITTING_POLICY_SHRINK | imgui.TabBarFlags.DRAW_SELECTED_OVERLINE
ANY_POPUP = imgui.PopupFlags.ANY_POPUP_ID | imgui.PopupFlags.ANY_POPUP_LEVEL


class Panel(Gui):
    """The panel of a session. It is closed at first."""

    def __init__(self, session: Session, perform: Callable[[Binding], None]) -> None:
        """`perform` performs an action of the table of keys, as a press does."""
        super().__init__(session, self.build, perform)
        self.rows = Rows(session, self)
        self._wants_focus = False
        self._shown: tuple[object, ...] = ()  # inputs of the last frame
        groups = Groups(self.rows)
        elements = Elements(session, self.rows, groups)
        self._pages = Pages(session, self.rows, groups)
        self._tabs = {
            translated("Elements"): elements.show,
            translated("Scene"): self._pages.scene,
            translated("History"): self._pages.history,
            translated("Picture, film"): self._pages.picture,
        }

    def open(self, is_open: bool, has_keys: bool) -> None:
        """Open the panel, which then `has_keys`, or close it."""
        self.is_open = is_open
        self._wants_focus, self.is_left = is_open and has_keys, not has_keys
        paint = (lambda painter, _: self.paint(painter)) if is_open else None
        self.session.mlx.mlx_overlay_hook(self.session.window, paint)
        self.session.screen.covered, self.session.slides = 0, False
        self.unsettled, self.session.screen.pointed = 0, None
        if is_open:
            self.settle()
        self.session.update()
        self.session.refresh()

    def follow(self) -> None:
        """Make a frame if the session shows something else than the last one."""
        self._pages.tell_end()
        if self.is_open and self._shown != self.inputs:
            if self.session.held_keys:  # another one follows
                self.frame()
            else:
                self.settle()
            self.session.update()
            self.session.refresh()

    @property
    def inputs(self) -> tuple[object, ...]:
        """Inputs of a frame: the state, the size of the window, the scale of its texts and the film."""
        session, window = self.session, self.session.window
        return session.state, window.width, window.height, session.screen.scale, self._pages.film

    def build(self) -> None:
        """Set the size of text and the border of the panel, and declare the widgets of a frame."""
        window = self.session.window
        self._shown = self.inputs
        self.resize_text(max(READABLE, min(self.session.screen.text_size, window.width // LETTERS)))
        self.left = window.width - min(WIDTH * self.size, SHARE * window.width)
        self.session.screen.covered = window.width - int(self.left)
        self.rows.begin_frame()
        imgui.set_next_window_pos((self.left, 0.0))
        imgui.set_next_window_size((window.width - self.left, float(window.height)))
        if self._wants_focus:
            imgui.set_next_window_focus()
            self._wants_focus = False
        imgui.begin("panel", False, FRAME)
        if imgui.begin_tab_bar("pages", TABS):
            for name, show in self._tabs.items():
                visible, _ = imgui.begin_tab_item(name)
                if visible:
                    if imgui.begin_child(name, (0.0, 0.0), imgui.ChildFlags.NAV_FLATTENED):
                        show()
                    imgui.end_child()
                    imgui.end_tab_item()
            if imgui.tab_item_button("x###close", imgui.TabItemFlags.TRAILING):
                self.wanted = "toggle panel"
            self.hint("close the panel")
            imgui.end_tab_bar()
        self.has_popup = imgui.is_popup_open("", ANY_POPUP)
        imgui.end()
