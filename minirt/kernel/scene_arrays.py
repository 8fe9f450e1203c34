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
    tile_starts: Any  # (tiles + 1,)
    light_starts: Any  # (m, cells + 1)


class SceneArrays(NamedTuple):
    """What a frame is made from; m lamps and n shapes, the shapes numbered from 0 in the order of the file.

    A cone from a point encloses a shape: axis, and cosine of the half-angle; -2 where it takes in all directions.
    """

    camera: Any  # (12,) eye, direction through the upper left corner, what a pixel to the right and one down add to it
    ambient: Any  # (3,) light, red green blue
    lights: Any  # (m, 6) place and light of each lamp
    colours_and_extents: Any  # (n, 4) colour of each shape, red green blue in [0, 1], and its largest coordinate
    slots: Any  # (n, 2) where each shape is: its group and its row there
    tile_shapes: Any  # the shapes in each tile, the nearest first
    cones: Any  # (n, 5) the cone from the eye; no point of the shape is nearer to it than the last number
    light_buffer_cells: int  # cells along an edge of the cubes around the lamps; 1 where they have no cells
    light_buffers: (
        Any  # (m, 11) how directions from each lamp are sorted into cells, see `minirt.kernel.culling.light_buffer`
    )
    light_shapes: Any  # the shapes in each cell of each cube, the nearest first
    light_cones: Any  # (m, n, 5) the same from each lamp
    groups: Any  # a tuple of Group: one for each kind of shape that the scene has
    # What most scenes do without, and then None: code for it is compiled only where it is there.
    spots: Any = None  # (m, 7) see `minirt.kernel.shading.lights`
    specular: Any = None  # (n, 3) see `minirt.kernel.shading.specular`
    reflective: Any = None  # (n, 3) see `minirt.kernel.shading.whitted`
    surface_maps: Any = None  # `minirt.kernel.shading.texturing.SurfaceMaps`
    depth: int = 0  # how often light may be mirrored or refracted on its way
    background: Any = None  # (3,) light from where no shape is
    environment: Any = None  # `minirt.kernel.shading.environment.Environment`
    bvh: Any = None  # `minirt.kernel.bvh.nodes.Tree` of the shapes, for rays that share no origin


def by_reference(table: Any) -> Any:
    """A scene, or another tuple of arrays, as it is. Compiled functions then pass it to each other by its address."""
    return table
