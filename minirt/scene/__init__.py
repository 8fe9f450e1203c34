"""Scenes: elements, parser, writer and edits of `.rt` files."""

from minirt.scene.arguments import check_scene
from minirt.scene.elements import *  # noqa: F403
from minirt.scene.elements import DEFAULT_SIZE
from minirt.scene.pages import Item
from minirt.scene.parser import Reading, dumps, load, loads, parse
from minirt.scene.parser import dumps as dump
from minirt.scene.scene import Scene
from minirt.scene.sizes import size_of
from minirt.scene.writer import describe
