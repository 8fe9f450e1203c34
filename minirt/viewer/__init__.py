"""The desktop viewer: a window in which keys and mouse move, turn and resize the elements of a scene.

Importing this package loads neither the window library nor the compiler.
"""

from minirt.viewer.app.desktop import run
from minirt.viewer.app.replay import replay
from minirt.viewer.bindings import keys_text

__all__ = ["keys_text", "replay", "run"]
