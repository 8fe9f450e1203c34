"""MiniLibX in Python: windows, pixels and events, on a screen (pyglet) or without a screen (memory).

    from minirt.mlx import Button, Event, Key, Mlx

Importing this package opens no display and loads no window library; `Mlx.mlx_init` does both. `python -m
minirt.mlx program.py` runs a program that says `from mlx import Mlx`.
"""

from minirt.errors import MlxError
from minirt.mlx.api import Mlx
from minirt.mlx.arguments import MlxImage
from minirt.mlx.events import Button, Cursor, Event, Key, Modifier
from minirt.mlx.window import Window

__all__ = ["Button", "Cursor", "Event", "Key", "Mlx", "MlxError", "MlxImage", "Modifier", "Window"]
