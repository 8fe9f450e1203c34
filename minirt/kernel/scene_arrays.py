"""A scene in the arrays that the kernel reads: all of them float64, or all of them float32."""

from __future__ import annotations

from typing import Any, NamedTuple


class Group(NamedTuple):
    """The shapes of one kind, and which of them may be met in which direction.

    Directions are sorted into cells: those from the eye into the tiles of the picture, those from a lamp into squares
    on the faces of a cube around it, or ahead of it. What may be met in cell c is `seen[starts[c]:starts[c + 1]]` of
    the scene, and for lamp i `lit[lamp_starts[i, c]:lamp_starts[i, c + 1]]`.
    """

    rows: Any  # a row a shape
    starts: Any  # (tiles + 1,)
    lamp_starts: Any  # (m, cells + 1)


class Traced(NamedTuple):
    """What a frame is made from; m lamps and n shapes, the shapes numbered from 0 in the order of the file.

    A cone from a point encloses a shape: axis, and cosine of the half-angle; -2 where it takes in all directions.
    """

    camera: Any  # (12,) eye, direction through the upper left corner, what a pixel to the right and one down add to it
    ambient: Any  # (3,) light, red green blue
    lights: Any  # (m, 6) place and light of each lamp
    looks: Any  # (n, 4) colour of each shape, red green blue in [0, 1], and its largest coordinate
    places: Any  # (n, 2) where each shape is: its group and its row there
    seen: Any  # the shapes in each tile, the nearest first
    views: Any  # (n, 5) the cone from the eye; no point of the shape is nearer to it than the last number
    grid: int  # cells along an edge of the cubes around the lamps; 1 where they have no cells
    around: Any  # (m, 11) how directions from each lamp are sorted into cells, see `minirt.kernel.culling.light_buffer`
    lit: Any  # the shapes in each cell of each cube, the nearest first
    lamp_views: Any  # (m, n, 5) the same from each lamp
    groups: Any  # a tuple of Group: one for each kind of shape that the scene has
    # What most scenes do without, and then None: code for it is compiled only where it is there.
    beams: Any = None  # (m, 7) see `minirt.kernel.shading.lights`
    gloss: Any = None  # (n, 3) see `minirt.kernel.shading.specular`
    bounces: Any = None  # (n, 3) see `minirt.kernel.shading.whitted`
    skins: Any = None  # `minirt.kernel.shading.texturing.Skins`
    depth: int = 0  # how often light may be mirrored or refracted on its way
    sky: Any = None  # (3,) light from where no shape is
    dome: Any = None  # `minirt.kernel.shading.environment.Dome`
    tree: Any = None  # `minirt.kernel.bvh.nodes.Tree` of the shapes, for rays that share no origin


def placed(table: Any) -> Any:
    """A scene, or another tuple of arrays, as it is. Compiled functions then pass it to each other by its address."""
    return table
