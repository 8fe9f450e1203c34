"""Drop files on an X11 window as a file manager does (XDND, version 5).

python -m tests.mlx.drag_source WINDOW x y TYPES FILE...        # TYPES: number of offered data types
"""

from __future__ import annotations

import sys
from ctypes import POINTER, c_int, c_ulong, cast, create_string_buffer
from pathlib import Path
from typing import Any

from pyglet.libs.x11 import xlib

from tests.waiting import until

VERSION = 5


class DragSource:
    """An invisible window that owns the dragged files."""

    def __init__(self, target: int, types: int) -> None:
        self.display = xlib.XOpenDisplay(None)
        root = xlib.XDefaultRootWindow(self.display)
        self.window = xlib.XCreateSimpleWindow(self.display, root, 0, 0, 1, 1, 0, 0, 0)
        self.target = target
        self.types = [self.atom(f"text/x-test-{n}") for n in range(types - 1)] + [self.atom("text/uri-list")]

    def atom(self, name: str) -> int:
        """X11's number of a name."""
        return int(xlib.XInternAtom(self.display, name.encode(), 0))

    def send(self, name: str, *data: int) -> None:
        """Send a message to the target."""
        event = xlib.XEvent()
        event.xclient.type = xlib.ClientMessage
        event.xclient.display = cast(self.display, POINTER(xlib.Display))
        event.xclient.window = self.target
        event.xclient.message_type = self.atom(name)
        event.xclient.format = 32
        for index, value in enumerate((self.window, *data)):
            event.xclient.data.l[index] = value
        xlib.XSendEvent(self.display, self.target, 0, 0, event)
        xlib.XFlush(self.display)

    def next_event(self, kind: int) -> Any:
        """Wait for the next event of this kind."""
        event = xlib.XEvent()
        while event.type != kind:
            until(lambda: bool(xlib.XPending(self.display)), f"an event {kind}")
            xlib.XNextEvent(self.display, event)
        return event

    def write(self, window: int, name: int, kind: int, bits: int, data: bytes) -> None:
        """Set a property of a window."""
        count = len(data) * 8 // (64 if bits == 32 else bits)  # 32-bit numbers are passed as longs
        buffer = cast(create_string_buffer(data), POINTER(xlib.c_ubyte))
        xlib.XChangeProperty(self.display, window, name, kind, bits, 0, buffer, count)

    def drop(self, x: int, y: int, files: list[str]) -> None:
        """Drag the files to x, y of the window and drop them."""
        selection = self.atom("XdndSelection")
        xlib.XSetSelectionOwner(self.display, selection, self.window, 0)
        names = b"".join(each.to_bytes(8, sys.byteorder) for each in self.types)
        self.write(self.window, self.atom("XdndTypeList"), 4, 32, names)
        first = [*self.types, 0, 0, 0][:3]
        self.send("XdndEnter", VERSION << 24 | (len(self.types) > 3), *first)
        root, child = xlib.XDefaultRootWindow(self.display), c_ulong()
        at_x, at_y = c_int(), c_int()
        xlib.XTranslateCoordinates(self.display, self.target, root, x, y, at_x, at_y, child)
        self.send("XdndPosition", 0, at_x.value << 16 | at_y.value, 0, self.atom("XdndActionCopy"))
        status = self.next_event(xlib.ClientMessage)
        if not status.xclient.data.l[1] & 1:
            raise SystemExit("refused")
        self.send("XdndDrop", 0, 0)
        request = self.next_event(xlib.SelectionRequest).xselectionrequest
        uris = "".join(f"{Path(file).as_uri()}\r\n" for file in files).encode()
        self.write(request.requestor, request.property, request.target, 8, uris)
        answer = xlib.XEvent()
        answer.xselection.type = xlib.SelectionNotify
        answer.xselection.requestor, answer.xselection.selection = request.requestor, request.selection
        answer.xselection.target, answer.xselection.property = request.target, request.property
        xlib.XSendEvent(self.display, request.requestor, 0, 0, answer)
        xlib.XSync(self.display, 0)  # the target has the files and the notification, even if this window is closed


if __name__ == "__main__":
    window, x, y, types = map(int, sys.argv[1:5])
    DragSource(window, types).drop(x, y, sys.argv[5:])
