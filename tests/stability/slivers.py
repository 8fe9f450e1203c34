"""Slivers: triangles that are much longer than high, as shapes, as meshes and in scenes whose light is known."""

from __future__ import annotations

import numpy as np

from minirt.fields import MeshFile
from minirt.meshes import Triangles
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes.mesh import Mesh
from minirt.shapes.triangle import Triangle
from tests.shapes.regimes import GREY, Array, Random, random_directions, random_perpendiculars, unit

ASPECTS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-12)  # height by longest edge
SCALES = (1e-6, 1e-3, 1.0, 60.0, 1e4, 1e9)  # longest edge
WHITE = (255, 255, 255)
AMBIENT = 0.25


def sliver(random: Random, aspect: float, scale: float) -> Triangle:
    """A triangle about the origin, its corners in any order and its highest point anywhere above the longest edge."""
    along = scale * random_directions(random)
    foot = random.uniform(0, 1) * along
    corners = np.array([0 * along, along, foot + aspect * scale * random_perpendiculars(random, along)])
    corners += random.uniform(-1, 0) * along
    return Triangle(*map(tuple, random.permutation(corners).tolist()), GREY)


def corners_of(triangle: Triangle) -> Array:
    return np.array([triangle.a, triangle.b, triangle.c])


def mesh_of(triangles: list[Triangle]) -> Mesh:
    """A mesh of triangles that share no corners."""
    points = np.concatenate([corners_of(each) for each in triangles])
    return Mesh(MeshFile("slivers.obj", Triangles(points, np.arange(len(points)).reshape(-1, 3))), (0, 0, 0), 1.0, GREY)


def scene_of(random: Random, aspect: float, scale: float) -> tuple[Scene, float]:
    """A mesh of one sliver, seen from as near as the sliver is high, and its light: ambient and diffuse."""
    shape = sliver(random, aspect, scale)
    normal = np.array(shape.normal()) * random.choice([-1.0, 1.0])
    spot = random.dirichlet(np.full(3, 4.0)) @ corners_of(shape)
    view = unit(-normal + 0.5 * random_directions(random))
    eye = Camera(tuple(spot - aspect * scale * view), tuple(view.clip(-1, 1)), 50)
    cosine = random.uniform(0.05, 1)
    to_light = cosine * normal + np.sqrt(1 - cosine**2) * random_perpendiculars(random, normal)
    light = Light(tuple(spot + 1e4 * scale * to_light), 0.5, WHITE)
    drawn = mesh_of([shape]).replace(colour=WHITE)
    return Scene((Ambient(AMBIENT, WHITE), eye, light, drawn)), AMBIENT + 0.5 * cosine
