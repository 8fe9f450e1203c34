"""Scenes: elements, parser, writer and edits of `.rt` files."""

from minirt.scene.elements import Ambient, Background, Camera, Resolution
from minirt.scene.lights import FurtherLight, Lamp, Light, ParallelLight, SpotLight
from minirt.scene.pages import Item
from minirt.scene.parser import Reading, load, loads, parse
from minirt.scene.scene import DEFAULT_SIZE, Scene, check_scene, dumps, size_of
from minirt.scene.scene import dumps as dump
from minirt.scene.writer import describe
