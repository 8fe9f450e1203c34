"""Write SVG elements as text."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

Point = tuple[float, float]  # pixels, y counts downwards


def element(name: str, /, *content: str, **attributes: object) -> str:
    """Return an element: `element("text", "a < b", x=1)` is `<text x="1">a &lt; b</text>` once `text` has escaped it.

    `class_` becomes `class`, other underscores become hyphens, and numbers are rounded to a tenth of a pixel.
    """
    written = "".join(f' {key.rstrip("_").replace("_", "-")}="{value_text(each)}"' for key, each in attributes.items())
    return f"<{name}{written}>{''.join(content)}</{name}>" if content else f"<{name}{written}/>"


def value_text(value: object) -> str:
    """Format the value of an attribute."""
    return f"{round(value, 1):g}" if isinstance(value, float) else escape(str(value))


def text(content: str, at: Point, **attributes: object) -> str:
    """Return a line of text whose baseline begins at a point."""
    return element("text", escape(content), x=at[0], y=at[1], **attributes)


def group(content: Iterable[str], **attributes: object) -> str:
    """Return a group of elements."""
    return element("g", *content, **attributes)


def path(points: Iterable[Point], **attributes: object) -> str:
    """Return a polyline through some points."""
    return element("path", d="M" + "L".join(f"{x:.1f},{y:.1f}" for x, y in points), **attributes)
