"""Why a pixel has its colour: as a record, for JSON, and as text, a tree to read and to show on a wall."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from math import inf
from typing import Any

import numpy as np

from minirt.fields import Triple
from minirt.rendering.queries.ray_tree import COLOURS, LightPart, Meeting, RayNode, SurfacePoint
from minirt.rendering.tone_mapping import tone_named

MOST = 4  # shapes that are named of those along a ray
TIMES = "\N{MULTIPLICATION SIGN}"
SHORT = 3  # digits of directions
LEAST = 0.0005  # light that is shown
NOTHING = 1e-9  # of a vector's largest coordinate: a smaller one is rounding


@dataclass(frozen=True)
class Explanation:
    """The tree of rays of a pixel. `print` shows it, and `as_dict` is for JSON."""

    x: int
    y: int
    width: int
    height: int
    ray: RayNode
    light: Triple  # the sum over all rays
    tone: str
    level: tuple[int, int, int]  # of the pixel in a picture of 8 bits

    def __str__(self) -> str:
        return str(TreeText(self))

    def as_dict(self) -> dict[str, Any]:
        """Return dictionaries and sequences by the names of the fields; what is infinite is None."""
        return asdict(self, dict_factory=lambda pairs: {name: None if each == inf else each for name, each in pairs})


class TreeText:
    """The lines of an explanation; in a terminal that has colours, each light is followed by its own."""

    def __init__(self, explanation: Explanation, has_colours: bool = False) -> None:
        self.explanation, self.has_colours = explanation, has_colours
        self.halfway = tone_named(explanation.tone).halfway

    def __str__(self) -> str:
        it = self.explanation
        red, green, blue = it.level
        way = "times 255, rounded" if it.tone == "plain" else f"by the tone {it.tone}"
        head = f"pixel {it.x},{it.y} of {it.width}x{it.height}: red {red}, green {green}, blue {blue}"
        total = f"the sum of all rays: {self.shown(it.light)}, {way}: {red} {green} {blue}"
        return "\n".join([f"{head}{self.swatch(it.light)}", "", *self.tree(it.ray), total])

    def tree(self, ray: RayNode) -> Iterator[str]:
        """Yield the lines of a ray and, indented, those of the rays that it becomes."""
        share = "" if ray.weight == 1.0 else f", {ray.weight:.1%} of the pixel"
        yield f"{self.coloured('●', COLOURS[ray.kind])} {ray.kind} ray{share}"
        is_last = not ray.rays
        for line in self.about(ray):
            yield f"{' ' if is_last else '│'}   {line}".rstrip()
        for number, each in enumerate(ray.rays, 1):
            is_last = number == len(ray.rays)
            first, *others = self.tree(each)
            yield f"{'╰' if is_last else '├'}─{first}"
            yield from (f"{' ' if is_last else '│'} {line}".rstrip() for line in others)

    def about(self, ray: RayNode) -> Iterator[str]:
        """Yield what a ray meets and the light that it adds."""
        yield f"from {numbers(ray.origin)} towards {numbers(ray.direction)}"
        if len(ray.meets) > 1:
            yield f"along it: {named(ray.meets)}"
        if ray.surface:
            yield from self.surface(ray.surface)
        else:
            yield "it meets nothing: the light is that of the background"
        tinted = "" if ray.tint == (1.0, 1.0, 1.0) else f", of which coloured glass leaves {numbers(ray.tint)}"
        yield f"⇒ adds {self.shown(ray.light)} to the pixel{tinted}"
        yield ""

    def surface(self, at: SurfacePoint) -> Iterator[str]:
        """Yield the surface that a ray hits, and its light."""
        yield ""
        yield f"◆ {at.name}{', left from inside,' if at.leaves else ''} at the distance {at.distance:.5g}"
        yield f"  point {numbers(at.point)}   normal {numbers(at.normal)}   u,v {numbers(at.uv)}"
        if at.shading_normal != at.normal:
            yield f"  normal for light {numbers(at.shading_normal)}"
        parts = {"mirrored": at.mirror, "refracted": at.glass}
        own = max(1.0 - at.mirror - at.glass, 0.0)
        sent_on = "".join(f", {share:.1%} {word}" for word, share in parts.items() if share)
        kept = f", {own:.1%} its own" if sent_on else ""
        yield f"  colour {self.shown(at.colour)}{kept}{sent_on}"
        if own or at.specular[0]:
            yield from self.lights(at)
        factor = "" if own == 1.0 else f"{own:.3g} {TIMES} "
        highlights = " + highlights" if at.specular[0] else ""
        glow = f" + {at.glow:.3g} {TIMES} colour" if at.glow else ""
        yield f"  {factor}colour {TIMES} light{highlights}{glow} = {self.shown(at.light)}"

    def lights(self, at: SurfacePoint) -> Iterator[str]:
        """Yield the table of the lights that fall onto a surface."""
        table = [("light", "towards", "cosine", "way", "falls onto it", "highlight" if at.specular[0] else "")]
        table.append(("ambient", "", "", "", shares(at.ambient), ""))
        for each in at.lights:
            cosine = f"{each.cosine:.3f}" + ("" if each.strength == 1.0 else f" {TIMES} {each.strength:.2g}")
            highlight = shares(each.highlight) if max(each.highlight) >= LEAST else ""
            towards = numbers(each.direction, SHORT)
            table.append((f"light {each.light + 1}", towards, cosine, way_of(each), shares(each.diffuse), highlight))
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        swatches = "", self.swatch(at.ambient), *(self.swatch(each.diffuse) for each in at.lights)
        for cells, swatch in zip(table, swatches, strict=True):
            yield "  " + "  ".join(map(str.ljust, cells, widths)).rstrip() + swatch

    def shown(self, light: Triple) -> str:
        return shares(light) + self.swatch(light)

    def swatch(self, light: Triple) -> str:
        """Return a block of the colour that light has in the picture."""
        levels = np.searchsorted(self.halfway, light, "right")
        return " " + self.coloured("██", levels) if self.has_colours else ""

    def coloured(self, text: str, colour: Iterable[int]) -> str:
        """Return a text with the control characters that give it a colour in a terminal."""
        return "\x1b[38;2;{};{};{}m{}\x1b[0m".format(*colour, text) if self.has_colours else text


def way_of(light: LightPart) -> str:
    """Return what is between a surface and a light."""
    if light.cosine <= 0.0:
        return "comes from behind"
    if not light.strength:
        return "does not reach it"
    if not any(light.passes):
        return f"in the shadow of {named(light.meets)}" if light.meets else "in shadow"
    if light.passes == (1.0, 1.0, 1.0):
        return "free"
    share = f"{light.passes[0]:.1%}" if len({*light.passes}) == 1 else shares(light.passes)
    return f"through {named(light.meets)}: {share}"


def named(meets: tuple[Meeting, ...]) -> str:
    """Name the first of some shapes, and where a ray meets them."""
    names = ", ".join(f"{each.name} at {each.distance:.4g}" for each in meets[:MOST])
    return names + (", ..." if len(meets) > MOST else "")


def numbers(values: tuple[float, ...], digits: int = 4) -> str:
    """Return coordinates as a scene file has them."""
    least = NOTHING * max(map(abs, values))
    return ",".join(f"{value if abs(value) > least else 0.0:.{digits}g}" for value in values)


def shares(light: Triple) -> str:
    return " ".join(f"{part:.3f}" for part in light)
