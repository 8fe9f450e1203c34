"""The table of hypotheses: what another ray tracer may do in another way, and the sentence that says what to change.

A row is one difference from this program. The search tries its changes, one after the other and together; a new
hypothesis is a row here, and where it needs one a line in `geometry` or `lighting`, which read the changes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

Guess = dict[str, Any]  # the values of all parameters, by their names: how the other program draws

# What this program does.
OURS: Guess = {
    "mirrored": False,
    "flipped": False,
    "direction": "as given",
    "up": "y",
    "roll": 0.0,  # degrees
    "fov": "horizontal",
    "scale": 1.0,  # of the tangent of half the field of view
    "pixel": "centre",
    "radius": "none",
    "cylinder": "centre",
    "axis": "as given",
    "cone": "apex",
    "caps": True,
    "inside": True,
    "ambient": "object x light",
    "ambient_in_shadow": True,
    "shadows": "to the lamp",
    "normals": "facing",
    "fading": 0,
    "colours": "as given",
    "specular": None,  # or the form, the exponent, and whose colour
    "gamma": 1.0,
    "overflow": "clamped",
    "background": "as given",
    "acne": False,
}


class Hypothesis(NamedTuple):
    """A row of the table."""

    name: str  # stable: part of the answer in JSON
    value: Any  # what the other program does
    changes: Guess
    sentence: str  # what it means and what to change


GEOMETRY = (
    Hypothesis("mirrored", True, {"mirrored": True},
               "left and right are swapped: negate the camera's right vector (right = direction x up)"),
    Hypothesis("flipped", True, {"flipped": True},
               "the picture is upside down: row 0 is the upper one, y grows downwards in pictures"),
    Hypothesis("direction", "reversed", {"direction": "reversed"},
               "the camera looks backwards: negate the viewing direction"),
    *(Hypothesis("up", up, {"up": up}, f"the camera's up is {up}: the reference builds right = direction x (0,1,0)")
      for up in ("z", "-z", "x", "-x", "-y")),
    *(Hypothesis("up", up, {"up": up}, f"the camera is turned by the shortest rotation {up} axis onto its direction, "
                 "which rolls it: build right = direction x (0,1,0), up = right x direction")
      for up in ("from the z", "from the -z")),
    Hypothesis("up", "x first", {"up": "x first"},
               "the camera's up is built from a fixed right of -x: build right = direction x (0,1,0) first"),
    Hypothesis("fov", "vertical", {"fov": "vertical"},
               "the field of view is taken as vertical: your rays use tan(fov/2) for y; the subject's is horizontal"),
    Hypothesis("fov", "square", {"fov": "square"},
               "the field of view is used for x and y alike: multiply y by height/width"),
    Hypothesis("fov", "full angle", {"fov": "full angle"},
               "tan(fov) is used in place of tan(fov/2): the field of view is the whole angle"),
    Hypothesis("fov", "not normalised", {"fov": "not normalised"},
               "right and up are too short where the camera looks up or down: normalise the product direction x up"),
    Hypothesis("fov", "too near", {"fov": "too near"},
               "the picture plane is too near where the camera looks up or down: put it at distance 1 along the "
               "direction, not along the ground"),
    Hypothesis("pixel", "corner", {"pixel": "corner"},
               "rays go through the corners of pixels: add 0.5 to x and y to hit their centres"),
    Hypothesis("radius", "spheres", {"radius": "spheres"},
               "the diameter of spheres is used as their radius: divide it by 2"),
    Hypothesis("radius", "cylinders", {"radius": "cylinders"},
               "the diameter of cylinders is used as their radius: divide it by 2"),
    Hypothesis("radius", "all", {"radius": "all"},
               "diameters are used as radii: divide them by 2"),
    Hypothesis("cylinder", "base", {"cylinder": "base"},
               "the point of a cylinder is taken as the centre of its base: it is half-way up"),
    Hypothesis("cylinder", "top", {"cylinder": "top"},
               "the point of a cylinder is taken as the centre of its top: it is half-way up"),
    Hypothesis("cylinder", "doubled", {"cylinder": "doubled"},
               "cylinders reach by their whole height to either side of their point: use half of it"),
    Hypothesis("axis", "upright", {"axis": "upright"},
               "the axis of cylinders is ignored: they all stand along y"),
    Hypothesis("axis", "-x", {"axis": "-x"}, "the x of cylinders' axes is negated: they lean to the other side"),
    Hypothesis("axis", "-z", {"axis": "-z"}, "the z of cylinders' axes is negated: they lean to the other side"),
    Hypothesis("axis", "swapped", {"axis": "swapped"}, "x and z of cylinders' axes are swapped"),
    Hypothesis("cone", "base", {"cone": "base"},
               "the point of a cone is taken as the centre of its base: here it is the apex"),
    Hypothesis("cone", "reversed", {"cone": "reversed"},
               "cones open against their axis: here the axis runs from the apex to the base"),
    Hypothesis("caps", False, {"caps": False}, "cylinders and cones have no caps: one looks into them"),
    Hypothesis("inside", False, {"inside": False},
               "surfaces are not drawn from inside: take the larger root where the smaller one is behind the eye"),
)  # fmt: skip

EXPONENTS = 4, 8, 16, 32, 50, 64, 100, 128, 200, 256, 512
LIGHT = (
    Hypothesis("ambient", "light alone", {"ambient": "light alone"},
               "the ambient light is added as it is: multiply it by the colour of the object"),
    Hypothesis("ambient", "light plus object", {"ambient": "light plus object"},
               "the ambient light and a share of the object's colour are added: multiply one by the other instead"),
    Hypothesis("ambient", "object alone", {"ambient": "object alone"},
               "the colour of the ambient light is ignored: multiply it by the colour of the object"),
    Hypothesis("ambient", "none", {"ambient": "none"}, "there is no ambient light"),
    Hypothesis("ambient", "not in shadow", {"ambient_in_shadow": False},
               "shadows are without ambient light: it reaches all surfaces"),
    Hypothesis("shadows", "none", {"shadows": "none"},
               "there are no shadows: send a ray from the point to the lamp"),
    Hypothesis("shadows", "behind the lamp", {"shadows": "behind the lamp"},
               "things behind the lamp cast shadows, too: only hits nearer than the lamp count"),
    Hypothesis("normals", "outward", {"normals": "outward"},
               "normals are not turned towards the eye: flip them where they face away from it"),
    Hypothesis("normals", "both sides", {"normals": "both sides"},
               "the absolute value of the cosine is used: surfaces are lit from both sides"),
    Hypothesis("fading", 1, {"fading": 1},
               "light fades as 1/distance: often the direction to the lamp is not normalised; here it does not fade"),
    Hypothesis("fading", 2, {"fading": 2}, "light fades as 1/distance^2: here it does not fade"),
    Hypothesis("colours", "light ignored", {"colours": "light ignored"}, "the colours of the lamps are ignored"),
    Hypothesis("colours", "object ignored", {"colours": "object ignored"}, "the colours of the objects are ignored"),
    Hypothesis("colours", "swapped", {"colours": "swapped"}, "red and blue are swapped: pixels are blue, green, red"),
    Hypothesis("gamma", 2.2, {"gamma": 2.2},
               "levels are light^(1/2.2): the reference writes light without a curve"),
    Hypothesis("gamma", 2.0, {"gamma": 2.0},
               "levels are the square root of light: the reference writes light without a curve"),
    Hypothesis("gamma", 0.5, {"gamma": 0.5}, "levels are the square of light: the reference writes light itself"),
    Hypothesis("overflow", "wrapped", {"overflow": "wrapped"},
               "bright levels wrap around at 256: clamp them to 255 before they become bytes"),
    *(Hypothesis("specular", f"{form} {exponent}{of}", {"specular": (form, exponent, of)},
                 f"there are highlights{of} ({form}, exponent about {exponent}), for which the scene does not ask")
      for form in ("phong", "blinn") for of in ("", " in the object's colour") for exponent in EXPONENTS),
    Hypothesis("background", "own", {"background": "own"}, "the background is {colour}: here it is {ours}"),
    Hypothesis("acne", True, {"acne": True},
               "lit surfaces have dark specks: start shadow rays a little (0.0001) above the surface"),
)  # fmt: skip
# Numbers that are found without a row for each value.
FREE = {
    "roll": "the camera is rolled by {value} degrees",
    "scale": "the field of view is {value} degrees across where the scene says {ours}",
    "ambient": "the ambient light is {value} times that of the scene",
    "diffuse": "the light of the lamps is {value} times that of the scene: no factor but brightness, colour and cosine",
    "specular": "highlights are {value} times as bright as those of the scene",
    "share": "{sentence}; their share is {value}",
}
TABLE = GEOMETRY + LIGHT
