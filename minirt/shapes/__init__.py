"""The registry of shapes: each import below is one kind of shape, and the only list of them.

Another shape is a file beside these, with the names that `minirt.shapes.shape` asks for, and a line here. Parser,
kernel, editor, documentation, the public name `minirt.Sphere` and the tests of every kind derive from it.
"""

# The order is that of the key N and of the table of the format.
# isort: off
from minirt.shapes.sphere import Sphere as Sphere
from minirt.shapes.plane import Plane as Plane
from minirt.shapes.cylinder import Cylinder as Cylinder
from minirt.shapes.cone import Cone as Cone
from minirt.shapes.paraboloid import Paraboloid as Paraboloid
from minirt.shapes.hyperboloid import Hyperboloid as Hyperboloid
from minirt.shapes.triangle import Triangle as Triangle
from minirt.shapes.square import Square as Square
from minirt.shapes.disc import Disc as Disc
from minirt.shapes.box import Box as Box
from minirt.shapes.torus import Torus as Torus
from minirt.shapes.ellipsoid import Ellipsoid as Ellipsoid
from minirt.shapes.mesh import Mesh as Mesh

# isort: on
from minirt.shapes.shape import Ball as Ball
from minirt.shapes.shape import Kind as Kind
from minirt.shapes.shape import Shape as Shape
from minirt.shapes.shape import kind_of

PUBLIC: dict[str, type] = {
    name: each
    for name, each in vars().items()
    if isinstance(each, type) and issubclass(each, Shape) and each is not Shape
}

ALL_KINDS = tuple(map(kind_of, PUBLIC.values()))
KINDS = tuple(kind for kind in ALL_KINDS if not kind.element.batched)  # each shape a formula
(MESH,) = (kind for kind in ALL_KINDS if kind.element.batched)  # each shape many triangles
