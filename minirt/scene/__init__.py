"""Scenes: elements, parser, writer and edits of `.rt` files."""

from minirt.scene.elements import Ambient, Background, Camera, Resolution
from minirt.scene.format_table import format_table
from minirt.scene.lights import FurtherLight, Lamp, Light, ParallelLight, SpotLight
from minirt.scene.line_rewriting import describe
from minirt.scene.pages import Item
from minirt.scene.parser import Reading, load, loads, parse
from minirt.scene.scene import Scene
from minirt.scene.writer import dump, dumps, save

__all__ = [
    "Ambient",
    "Background",
    "Camera",
    "FurtherLight",
    "Item",
    "Lamp",
    "Light",
    "ParallelLight",
    "Reading",
    "Resolution",
    "Scene",
    "SpotLight",
    "describe",
    "dump",
    "dumps",
    "format_table",
    "load",
    "loads",
    "parse",
    "save",
]
