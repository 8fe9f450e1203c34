"""A made-up key for `minirt/viewer/app/commands.py`: it copies the line of the selected element."""

from __future__ import annotations

from minirt.scene import describe
from minirt.viewer.app.session import Session


# What goes into minirt/viewer/app/commands.py.
def copy_line(session: Session) -> None:
    """Put the line of the selected element on the clipboard."""
    line = describe(session.state.element)
    session.mlx.mlx_set_clipboard(session.window, line)
    session.say(f"copied: {line}")
