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
    "roll": 0.0,  # degrees, as are the next two
    "yaw": 0.0,  # by which the camera is turned to its right
    "pitch": 0.0,  # up
    "fov": "horizontal",
    "scale": 1.0,  # of the tangent of half the field of view
    "pixel": "centre",
    "radius": "none",
    "cylinder": "centre",
    "axis": "as given",
    "cone": "apex",
    "caps": True,
    "missing": (),  # kinds of shapes
    "inside": True,
    "brightness": 1,  # the power in which that of lamps counts
    "ambient": "object x light",
    "ambient_in_shadow": True,
    "shadows": "to the lamp",
    "normals": "facing",
    "fading": 0,
    "colours": "as given",
    "specular": None,  # or the form, the exponent, and whose colour
    "reflections": False,
    "gamma": 1.0,
    "overflow": "clamped",
    "background": "as given",
    "acne": False,
}


class Hypothesis(NamedTuple):
    """A row of the table."""

    name: str  # stable: part of the answer in JSON
    value: Any  # what the other program does
    sentence: str  # what it means and what to change
    others: Guess = {}  # noqa: RUF012 - what is changed, where that is not the parameter of this name to this value

    @property
    def changes(self) -> Guess:
        """The parameters that the other program has in another way."""
        return self.others or {self.name: self.value}


def rows(*given: tuple[Any, ...]) -> tuple[Hypothesis, ...]:
    """Return rows of the table."""
    return tuple(Hypothesis(*each) for each in given)


SHORTEST = "which rolls it: build right = direction x (0,1,0), up = right x direction"
GEOMETRY = rows(
    ("mirrored", True, "left and right are swapped: negate the camera's right vector (right = direction x up)"),
    ("flipped", True, "the picture is upside down: row 0 is the upper one, y grows downwards in pictures"),
    ("direction", "reversed", "the camera looks backwards: negate the viewing direction"),
    ("direction", "angles",
     "the camera's direction is taken as angles by which it is turned: it is a vector, the way that the camera looks"),
    ("direction", "position added",
     "the camera's position is added to the direction of its rays: it is only where they begin"),
    *(("up", up, f"the camera's up is {up}: the reference builds right = direction x (0,1,0)")
      for up in ("-y", "z", "-z", "x", "-x")),
    *(("up", up, f"the camera is turned by the shortest rotation {up} axis onto its direction, {SHORTEST}")
      for up in ("from the z", "from the -z")),
    ("up", "x first", "the camera's up is built from a fixed right of -x: build right = direction x (0,1,0) first"),
    ("fov", "vertical",
     "the field of view is taken as vertical: your rays use tan(fov/2) for y; the subject's is horizontal"),
    ("fov", "square", "the field of view is used for x and y alike: multiply y by height/width"),
    ("fov", "full angle", "tan(fov) is used in place of tan(fov/2): the field of view is the whole angle"),
    ("fov", "sine", "sin(fov/2) is used in place of tan(fov/2)"),
    ("fov", "ignored", "the field of view of the scene is not used: your rays always see 90 degrees across"),
    ("fov", "not normalised",
     "right and up are too short where the camera looks up or down: normalise the product direction x up"),
    ("fov", "too near", "the picture plane is too near where the camera looks up or down: normalise the product "
     "direction x up, and put the plane at distance 1 along the direction"),
    ("fov", "equal angles", "neighbouring rays differ by equal angles, as of a fish eye: lay them through a plane of "
     "equal pixels, direction + x * right + y * up"),
    ("pixel", "corner", "rays go through the corners of pixels: add 0.5 to x and y to hit their centres"),
    ("radius", "spheres", "the diameter of spheres is used as their radius: divide it by 2"),
    ("radius", "cylinders", "the diameter of cylinders is used as their radius: divide it by 2"),
    ("radius", "all", "diameters are used as radii: divide them by 2"),
    ("cylinder", "base", "the point of a cylinder is taken as the centre of its base: it is half-way up"),
    ("cylinder", "top", "the point of a cylinder is taken as the centre of its top: it is half-way up"),
    ("cylinder", "doubled", "cylinders reach by their whole height to either side of their point: use half of it"),
    ("cylinder", "turned",
     "the point of a cylinder is turned with its axis about the origin: turn it first, then move it"),
    ("axis", "upright", "the axis of cylinders is ignored: they all stand along y"),
    ("axis", "-x", "the x of cylinders' axes is negated: they lean to the other side"),
    ("axis", "-z", "the z of cylinders' axes is negated: they lean to the other side"),
    ("axis", "swapped", "x and z of cylinders' axes are swapped"),
    ("axis", "not normalised", "the ends of cylinders and cones lie further off where their axis is longer: "
     "scale the axis to length 1"),
    ("axis", "in the formula", "an axis that is not of length 1 bends or shortens cylinders and cones: "
     "scale it to length 1 before it enters the formula"),
    ("cone", "base", "the point of a cone is taken as the centre of its base: here it is the apex"),
    ("cone", "reversed", "cones open against their axis: here the axis runs from the apex to the base"),
    ("cone", "both halves", "cones go on beyond their apex, with a second half: leave out hits at negative heights"),
    ("cone", "whole angle", "the diameter of cones is taken as their angle in degrees, from side to side"),
    ("cone", "angle", "the diameter of cones is taken as the angle in degrees from their axis to their side"),
    ("caps", False, "cylinders and cones have no caps: one looks into them"),
    *(("missing", missing, f"{' and '.join(missing)} are not drawn")
      for missing in (("planes",), ("cylinders",), ("planes", "cylinders"))),
    ("inside", False,
     "surfaces are not drawn from inside: take the larger root where the smaller one is behind the eye"),
)  # fmt: skip

# Shares by which light fades at distance 1, by the name of its form.
SOFT_FADING = {f"1/(1 + {each} distance)": each for each in (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0)}
EXPONENTS = 4, 8, 16, 32, 50, 64, 100, 128, 200, 256, 360, 512, 1000
FIRST_EXPONENTS, STEPS = (16, 64, 512), 2  # of highlights: those that are tried first, and how far others are from them
LIGHT = rows(
    ("ambient", "light alone", "the ambient light is added as it is: multiply it by the colour of the object"),
    ("ambient", "light plus object",
     "the ambient light and a share of the object's colour are added: multiply one by the other instead"),
    ("ambient", "object alone",
     "the colour of the ambient light is ignored: multiply it by the colour of the object"),
    ("ambient", "in light of the lamps",
     "the ambient light is multiplied by that of the lamps, too: it does not depend on them"),
    ("ambient", "of the lamps",
     "the ambient light is a share of the lamps': use brightness and colour of the line A instead"),
    ("ambient", "none", "there is no ambient light"),
    ("ambient", "not in shadow", "shadows are without ambient light: it reaches all surfaces",
     {"ambient_in_shadow": False}),
    ("diffuse", "brightness squared",
     "the brightness of lamps counts twice: multiply by it once", {"brightness": 2}),
    ("shadows", "none", "there are no shadows: send a ray from the point to the lamp"),
    ("shadows", "behind the lamp",
     "things behind the lamp cast shadows, too: only hits nearer than the lamp count"),
    ("normals", "outward", "normals are not turned towards the eye: flip them where they face away from it"),
    ("normals", "both sides", "the absolute value of the cosine is used: surfaces are lit from both sides"),
    ("fading", 1, "light fades as 1/distance, often for a direction that is not normalised: here it does not fade"),
    ("fading", 2, "light fades as 1/distance^2: here it does not fade"),
    ("fading", "linear", "light fades in proportion to the distance from the lamp: here it does not fade"),
    *(("fading", form, f"light fades as about {form}: here it does not fade") for form in SOFT_FADING),
    ("colours", "light ignored", "the colours of the lamps are ignored"),
    ("colours", "object ignored", "the colours of the objects are ignored"),
    ("colours", "object squared", "the colours of the objects count twice: multiply the sum of the light by them once"),
    ("colours", "swapped", "red and blue are swapped: pixels are blue, green, red"),
    ("gamma", 2.2, "levels are light^(1/2.2): the reference writes light without a curve"),
    ("gamma", 2.0, "levels are the square root of light: the reference writes light without a curve"),
    ("gamma", 0.5, "levels are the square of light: the reference writes light itself"),
    ("overflow", "wrapped", "bright levels wrap around at 256: clamp them to 255 before they become bytes"),
    *(("specular", f"{form} {exponent}{of}",
       f"there are highlights{of} ({form}, exponent about {exponent}), for which the scene does not ask",
       {"specular": (form, exponent, of)})
      for form in ("phong", "blinn") for of in ("", " in the object's colour") for exponent in EXPONENTS),
    ("reflections", True, "all shapes are mirrors, too, for which the scene does not ask"),
    ("background", "own", "the background is {colour}: here it is {ours}"),
    ("background", "gradient", "the background goes from one colour to another from below to above: here it is {ours}"),
    ("acne", True, "lit surfaces have dark specks: start shadow rays a little (0.0001) above the surface"),
)  # fmt: skip
# Numbers that are found without a row for each value.
FREE = {
    "roll": "the camera is rolled by {value} degrees",
    "direction": "the camera looks along {value} where the scene says {ours}: its frame is made in another way",
    "scale": "the field of view is {value} degrees across where the scene says {ours}",
    "ambient": "the ambient light is {value} times that of the scene",
    "diffuse": "the light of the lamps is {value} times that of the scene: no factor but brightness, colour and cosine",
    "specular": "highlights are {value} times as bright as those of the scene",
    "share": "{sentence}; their share is {value}",
}
TABLE = GEOMETRY + LIGHT


def is_near(highlight: Any, other: tuple[str, int, str]) -> bool:
    """Whether the exponent of a highlight is a step from that of another; without a highlight, whether that of the
    other is one of the first to be tried."""
    (_, exponent, _) = other
    if not highlight:
        return exponent in FIRST_EXPONENTS
    return abs(EXPONENTS.index(highlight[1]) - EXPONENTS.index(exponent)) <= STEPS


def values(name: str) -> list[Any]:
    """Return all values of a parameter: that of this program first, then those of the rows."""
    return [OURS[name], *(row.changes[name] for row in TABLE if name in row.changes)]
