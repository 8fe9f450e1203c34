"""The oracle: hits and normals of all shapes to 60 digits, computed differently from the program.

A shape is given here by implicit functions: polynomials of the coordinates of a point, which are <= 0 inside (`Body`).
Along a ray each is a polynomial in t, which is expanded by calling the function with the ray's coordinates; its roots
are found between its turning points. No formula is solved for t by hand.

The numbers of scene, ray and shape are taken as they are, to the last bit; only axes and normals are scaled to exact
unit length, as a scene intends. t is in lengths of `direction`, which may be any but 0.

For another shape add a function to `bodies.py`, or a file beside it that is named as the shape's own: the function,
which it registers with `body`, takes the shape and a `swell` by which its surface is moved outwards, of a sheet its
edges, and returns

    Body((F,))                         a solid without edges
    Body((F, G, H))                    a solid that several surfaces bound, as a cylinder by its side and caps
    Body((F,), clips=(G, H))           a surface of which only a part is there, but which has an inside
    Body((F,), clips=(G, H), solid=False)    a sheet, seen from both sides: G and H <= 0 are its extent
"""

from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from gmpy2 import mpfr

from minirt.shapes import KINDS, Shape
from tests.oracle.body import Body, Vector, body, crossings, dot, exact, file_of, normals
from tests.oracle.body import inside as inside_of

import_module(f"{__package__}.bodies")  # registers the bodies
for _file in map(file_of, (kind.element for kind in KINDS)):
    if find_spec(_file):
        import_module(_file)

__all__ = ["Body", "body", "dot", "exact", "inside", "nearest", "normal"]


def nearest(shape: Shape, origin: Sequence[Any], direction: Sequence[Any], swell: Any = 0) -> mpfr | None:
    """The least t > 0 at which origin + t direction lies on the surface, or None.

    A right answer in fewer digits lies between those for a shape a little larger (`swell` > 0) and a little smaller.
    """
    hits = crossings(body(shape, mpfr(swell)), list(origin), list(direction))
    return next((t for t in hits if t > 0), None)


def normal(shape: Shape, point: Sequence[Any]) -> Vector:
    """The outward unit normal at a point of the surface, or that of the wall nearest to a point beside it."""
    return normals(body(shape), list(point))[0][1]


def inside(shape: Shape, point: Sequence[Any]) -> bool:
    """Whether a point is inside a solid."""
    return inside_of(body(shape), list(point))
