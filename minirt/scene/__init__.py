"""What a scene is: its elements, how they are read from a file and written to one, and how they are edited."""

from minirt.scene.elements import Ambient, Camera, FurtherLight, Light, Resolution
from minirt.scene.pages import Item
from minirt.scene.parser import Reading, load, parse
from minirt.scene.rewriting import describe
from minirt.scene.scene import Scene
from minirt.scene.table import format_table
from minirt.scene.writer import dump, save

__all__ = [
    "Ambient",
    "Camera",
    "FurtherLight",
    "Item",
    "Light",
    "Reading",
    "Resolution",
    "Scene",
    "describe",
    "dump",
    "format_table",
    "load",
    "parse",
    "save",
]
