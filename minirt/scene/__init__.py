"""Scenes: elements, parser, writer and edits of `.rt` files."""

from minirt.scene.elements import *  # noqa: F403
from minirt.scene.elements import DEFAULT_SIZE
from minirt.scene.pages import Item
from minirt.scene.parser import Reading, load, loads, parse
from minirt.scene.scene import Scene, check_scene, dumps, size_of
from minirt.scene.scene import dumps as dump
from minirt.scene.writer import describe
