"""The desktop viewer: a window in which the keys move, turn and resize what a scene is made of.

Importing this loads neither the window library nor the compiler.
"""

from minirt.viewer.bindings import keys_markdown, keys_text
from minirt.viewer.desktop import run, view
from minirt.viewer.replay import replay

__all__ = ["keys_markdown", "keys_text", "replay", "run", "view"]
