"""MiniLibX's contract in Python: windows, pixels and events, on a screen (pyglet) or without one (memory).

    from minirt.mlx import Button, Event, Key, Mlx

Importing this opens no display and loads no window library; `Mlx.mlx_init` does.
"""

from minirt.errors import MlxError
from minirt.mlx.api import Mlx
from minirt.mlx.events import Button, Event
from minirt.mlx.handles import Image, Window
from minirt.mlx.keys import Key, Modifier

__all__ = ["Button", "Event", "Image", "Key", "Mlx", "MlxError", "Modifier", "Window"]
