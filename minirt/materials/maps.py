"""Materials that vary over a surface: checkerboard, textures, relief, and solid textures such as marble.

Each is a class whose text is its manual page, or a field that names a picture.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from minirt.fields import Angle, Colour, Length, Picture, Real, Triple, Whole, declare
from minirt.materials.compound import Material
from minirt.records import record


@record()
class Checker(Material):
    """Checkerboard: `checker:size[,R,G,B]`; `checker` alone is `checker:0.125`, on planes `checker:1`.

    Squares with sides of length `size` in the surface's coordinates u and v have in turn the colour of the surface (or
    its texture) and the second colour, black when left out. The square with 0 <= u < size and 0 <= v < size has the
    colour of the surface. On a plane u and v are lengths; on other shapes they run from 0 to 1 from edge to edge or
    once around, as their manual pages say, so that a size of 0.125 makes a board of 8 by 8.

        pl 0,-1,0 0,1,0 255,255,255 checker:2,40,40,60
    """

    title, feature, in_albedo = "checker", "checks", True
    size: float = declare(Length, "side of a square, in u and v", unit="")
    colour: Triple = declare(Colour, "the second colour", default=(0, 0, 0))

    def rows(self, shape: Any, reader: Any) -> dict[str, Any]:
        return {"checks": (self.size, *reader.shares(self.colour))}


@record(kw_only=True)
class TextureField(Picture):
    """The picture of a texture."""

    def rows(self, value: str, shape: Any, reader: Any) -> dict[str, Any]:
        return {self.feature: reader.texture(value, shape.filter)}


# Texture: `texture:file`.
#
# A picture that gives the surface its colours. It lies on the surface's coordinates u, from its left to its right
# border, and v, from its lower to its upper border, and is repeated beyond them. PNG, JPEG and other raster formats are
# read. The path begins at the folder of the scene file; one with spaces stands within quotes, and none has a `#`.
#
#     sp 0,0,20 8 255,255,255 texture:textures/planet.png
Texture = partial(TextureField, feature="textures", in_albedo=True)


@record()
class Bump(Material):
    """Bump map: `bump:file[,strength]`.

    Bump mapping (Blinn 1978, Simulation of Wrinkled Surfaces): the picture is a height map, and the surface is lit as
    if it were higher where the picture is lighter; its shape stays as it is. The picture lies on the surface as a
    texture does; of a coloured one the luminance counts. White is higher than black by `strength` times the width of
    the picture on the surface; a negative strength turns heights into depths. The slope at a point is the difference
    over one pixel around it. Mirrored and refracted rays follow the bumped normal, too, unless they would leave on the
    wrong side of the surface.

        sp 0,0,20 8 200,120,80 bump:textures/bricks-height.png,0.02
    """

    title, feature = "bump", "bumps"
    file: str = declare(partial(Picture, also=","), "the heights", heights=True)
    strength: float = declare(Real, "height of white above black", low=-10.0, high=10.0, step=0.005, default=0.02)

    def has_effect(self) -> bool:
        return self.strength != 0.0

    def rows(self, shape: Any, reader: Any) -> dict[str, Any]:
        return {"bumps": (reader.heights(self.file), self.strength)} if self.has_effect() else {}


# Normal map: `normal:file`.
#
# A picture whose colours are the normals with which the surface is lit; it lies on the surface as a texture does. Red
# is the component along u, green that along v, blue that along the surface's own normal: 1 means -1, 128 means 0, 255
# means 1. The colour 128,128,255 changes nothing (Cohen, Olano and Manocha 1998, Appearance-Preserving Simplification).
#
#     sp 0,0,20 8 200,120,80 normal:textures/bricks-normal.png
NormalMap = partial(Picture, feature="normals", packed=lambda file, reader: reader.normals(file))

FARTHEST = 1e6  # in u or v
Scale = partial(Length, unit="", initial=2.0)
Shift = partial(Real, low=-FARTHEST, high=FARTHEST, step=0.05)


@record()
class Placement(Material):
    """Placement of pictures: `uv:su,sv[,ou[,ov[,degrees]]]`.

    Scales, turns and shifts the surface's u and v for its checkerboard, texture, bump map and normal map. A picture
    becomes `su` times narrower and `sv` times lower, so that there are `su` times `sv` pictures where one was; it is
    turned by `degrees` about its lower left corner, counter-clockwise as seen from outside; and that corner is put at u
    = `ou`, v = `ov`. On a plane, where u and v are lengths, `uv:0.25,0.5` makes pictures four units wide and two units
    high.

        pl 0,-1,0 0,1,0 255,255,255 texture:textures/bricks.png uv:0.25,0.5
    """

    title, feature, in_albedo = "uv", "placements", True
    needs = "checker", "texture", "bump", "normal_map"
    scale_u: float = declare(Scale, "pictures in a unit of u", placeholder="su")
    scale_v: float = declare(Scale, "pictures in a unit of v", placeholder="sv")
    shift_u: float = declare(Shift, "u of the lower left corner", placeholder="ou", default=0.0)
    shift_v: float = declare(Shift, "v of the lower left corner", placeholder="ov", default=0.0)
    turn: float = declare(
        Angle, "turn about that corner, counter-clockwise", placeholder="degrees", step=5.0, default=0.0
    )

    def has_effect(self) -> bool:
        return self != Placement(1.0, 1.0)


@record()
class Pattern(Material):
    """Base of solid textures: `pattern:marble`, `pattern:wood` and `pattern:clouds` have the same values.

    They are formulas of space in the frame of the shape, computed by `minirt.kernel.shading.patterns`.
    """

    feature, in_albedo = "patterns", True
    size: float = declare(Length, "size of the pattern")
    colour: Triple = declare(Colour, "the second colour", default=(0, 0, 0))
    octaves: int = declare(Whole, "levels of detail", low=1, high=12, default=6)
    height: float = declare(Real, "height of the second colour, in sizes", low=-10.0, high=10.0, step=0.01, default=0.0)

    def features(self) -> tuple[str, ...]:
        return ("raised_patterns" if self.height else self.feature,)


@record()
class Marble(Pattern):
    """Marble: `pattern:marble,size[,R,G,B[,octaves[,height]]]`.

    Veins of a second colour, about `size` scene units apart, run through the shape and are moved by turbulence: fractal
    noise of absolute values (Perlin 1985, An Image Synthesizer). They move and turn with the shape, and have no seam.
    They cover its texture and checkerboard, and lie below wood and clouds, if it has those, too.

    The surface is lit as if it were higher where the second colour is, by `height` sizes; a negative height makes
    grooves. `octaves` are levels of detail, each twice as fine as the one before; those that are finer than the
    spacing of a pixel's samples fade.

        sp 0,0,20 8 235,232,225 pattern:marble,1.5,70,75,90
    """

    title = "marble"
    size: float = declare(Length, "distance of the veins", initial=0.25)
    colour: Triple = declare(Colour, "colour of the veins", default=(70, 75, 90))


@record()
class Wood(Pattern):
    """Wood: `pattern:wood,size[,R,G,B[,octaves[,height]]]`.

    Rings of a second colour around the axis of the shape, `size` scene units apart, with fine grain along it. On flat
    shapes the grain runs to the right, and the middle of the rings lies behind the surface. The rings move and turn
    with the shape. They cover its texture, checkerboard and marble.

    `octaves` and `height` are those of marble; the grain begins with the third octave.

        cy 0,0,20 0,1,0 6 9 200,150,90 pattern:wood,0.7
    """

    title = "wood"
    size: float = declare(Length, "distance of the rings", initial=0.25)
    colour: Triple = declare(Colour, "colour of the late wood", default=(95, 50, 20))


@record()
class Clouds(Pattern):
    """Clouds: `pattern:clouds,size[,R,G,B[,octaves[,height]]]`.

    Soft spots of a second colour, about `size` scene units wide: fractal noise (Perlin 1985, An Image Synthesizer).
    They move and turn with the shape, and have no seam. They cover its texture, checkerboard and all other patterns.

    `octaves` and `height` are those of marble.

        sp 0,0,20 8 60,120,210 pattern:clouds,3
    """

    title = "clouds"
    size: float = declare(Length, "width of a large cloud", initial=0.25)
    colour: Triple = declare(Colour, "colour of the clouds", default=(255, 255, 255))
