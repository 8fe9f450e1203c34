"""Explanations of pixels as text: a tree to read, and to show on a wall."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from minirt.fields import Triple
from minirt.rendering.queries.explanation import Explanation, LightPart, Meeting, RayNode, SurfacePoint
from minirt.rendering.tone_mapping import tone_named

MOST = 4  # shapes that are named of those along a ray
TIMES = "\N{MULTIPLICATION SIGN}"
LEAST = 0.0005  # light that is shown
NOTHING = 1e-9  # of a vector's largest coordinate: a smaller one is rounding


class TreeText:
    """The lines of an explanation; with `swatches` each light is followed by its colour, for a terminal."""

    def __init__(self, explanation: Explanation, swatches: bool = False) -> None:
        self.explanation, self.swatches = explanation, swatches
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
        yield f"● {ray.kind} ray{'' if ray.weight == 1 else f', {ray.weight:.1%} of the pixel'}"
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
        shares = "".join(f", {share:.1%} {word}" for word, share in parts.items() if share)
        yield f"  colour {self.shown(at.colour)}{f', {own:.1%} its own{shares}' if shares else ''}"
        if own or at.specular[0]:
            yield from self.lights(at)
        factor = "" if own == 1.0 else f"{own:.3g} {TIMES} "
        highlights = " + highlights" if at.specular[0] else ""
        glow = f" + {at.glow:.3g} {TIMES} colour" if at.glow else ""
        yield f"  {factor}colour {TIMES} light{highlights}{glow} = {self.shown(at.light)}"

    def lights(self, at: SurfacePoint) -> Iterator[str]:
        """Yield the table of the lights that fall onto a surface."""
        table = [("light", "cosine", "way", "falls onto it", "highlight" if at.specular[0] else "")]
        table.append(("ambient", "", "", shares(at.ambient), ""))
        for each in at.lights:
            cosine = f"{each.cosine:.3f}" + ("" if each.strength == 1.0 else f" {TIMES} {each.strength:.2g}")
            highlight = shares(each.highlight) if max(each.highlight) >= LEAST else ""
            table.append((f"light {each.light + 1}", cosine, way_of(each), shares(each.diffuse), highlight))
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        swatches = "", self.swatch(at.ambient), *(self.swatch(each.diffuse) for each in at.lights)
        for cells, swatch in zip(table, swatches, strict=True):
            yield "  " + "  ".join(map(str.ljust, cells, widths)).rstrip() + swatch

    def shown(self, light: Triple) -> str:
        return shares(light) + self.swatch(light)

    def swatch(self, light: Triple) -> str:
        """Return a block of the colour that light has in the picture."""
        if not self.swatches:
            return ""
        return "  \x1b[38;2;{};{};{}m██\x1b[0m".format(*np.searchsorted(self.halfway, light, "right"))


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
    return f"through {named(light.meets)}: {shares(light.passes)}"


def named(meets: tuple[Meeting, ...]) -> str:
    """Name the first of some shapes, and where a ray meets them."""
    names = ", ".join(f"{each.name} at {each.distance:.4g}" for each in meets[:MOST])
    return names + (", ..." if len(meets) > MOST else "")


def numbers(values: tuple[float, ...]) -> str:
    """Return coordinates as a scene file has them."""
    least = NOTHING * max(map(abs, values))
    return ",".join(f"{value if abs(value) > least else 0.0:.4g}" for value in values)


def shares(light: Triple) -> str:
    return " ".join(f"{part:.3f}" for part in light)
