"""A pixel explained over the picture: its rays, coloured by their kind, and a list with the numbers of each.

The rays are in the scene, and stay there while the camera moves.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import floor, hypot
from typing import NamedTuple

import numpy as np

from minirt.fields import Triple
from minirt.rendering.queries.explanation import Explanation, numbers, shares, way_of
from minirt.rendering.queries.ray_tree import COLOURS, LightPart, RayNode
from minirt.scene import Scene
from minirt.scene.elements import linear_combination
from minirt.viewer.display.jobs import Pixels
from minirt.viewer.display.lists import MARGIN, ListBox
from minirt.viewer.display.tool_row import SIDE
from minirt.viewer.editing.projection import Pixel, Projection, projection_of
from minirt.viewer.language import GAP

FREE, SHADOWED, HALO = (255, 215, 60), (230, 70, 50), (0, 0, 0)  # colours of rays to lights, and around all rays
FAR = 20.0  # lengths of the first ray: where rays end that meet nothing
NEAR = 1e-3  # of the length of a ray: how much of it lies at least before the eye
WIDTH, CHOSEN_WIDTH, HALO_WIDTH, DOT = 2.0, 4.0, 1.0, 6.0  # pixels, times the scale
OPACITY, HALO_OPACITY = 0.85, 0.5  # of rays beside the chosen one, and around all


class ExplainedRay(NamedTuple):
    """A ray, or one to a light, as it is drawn, and its row of the list."""

    title: str
    light: str  # that it adds, red, green and blue
    details: str
    start: Triple
    end: Triple
    colour: tuple[int, int, int]


class Explained(NamedTuple):
    """An explanation in the window; a row of its list is chosen."""

    explanation: Explanation
    scene: Scene
    parts: tuple[ExplainedRay, ...]
    chosen: int = 0

    def box(self, scale: float) -> ListBox:
        """Return the list: what the pixel shows, and its rays with the light that they add.

        It leaves the pixel and the tool row free, if the window is wide enough.
        """
        it = self.explanation
        title = f"pixel {it.x},{it.y}: {' '.join(map(str, it.level))}"
        lights = tuple(part.light for part in self.parts)
        titles, is_right = tuple(part.title for part in self.parts), it.x < it.width / 2
        return ListBox(title, titles, self.chosen, lights, left=MARGIN + round(SIDE * scale), is_right=is_right)

    def fits(self, scene: Scene) -> bool:
        """Whether the rays are those of a scene, wherever its camera is."""
        mine, other = ((each.runs, each.lights, each.ambient, each.background) for each in (self.scene, scene))
        return mine == other


def explained(explanation: Explanation, scene: Scene) -> Explained:
    """Return what the window shows of an explanation."""
    first = explanation.ray.surface
    far = FAR * (first.distance if first else 1.0)
    return Explained(explanation, scene, tuple(parts_of(explanation.ray, far)))


def parts_of(ray: RayNode, far: float, level: int = 0) -> Iterator[ExplainedRay]:
    """Yield a ray, those from its surface to lights, and those that it becomes."""
    at, indent = ray.surface, GAP * level
    end = at.point if at else linear_combination(1.0, ray.origin, far, ray.direction)
    share = "" if ray.weight == 1.0 else f" {ray.weight:.1%}"
    title = f"{indent}{ray.kind} ray{share}: {at.name if at else 'background'}"
    yield ExplainedRay(title, f"+ {shares(ray.light)}", details_of(ray), ray.origin, end, COLOURS[ray.kind])
    for light in at.lights if at else ():
        yield light_part(light, far, indent + GAP)
    for each in ray.rays:
        yield from parts_of(each, far, level + 1)


def light_part(light: LightPart, far: float, indent: str) -> ExplainedRay:
    """Return the ray to a light: up to what casts the shadow, and of no length if the light comes from behind."""
    is_dark, reach = not any(light.passes), 0.0
    if light.cosine > 0.0:
        reach = light.meets[0].distance if is_dark and light.meets else min(light.distance, far)
    details = f"cosine {light.cosine:.3f}{GAP}falls onto it {shares(light.diffuse)}"
    if any(light.highlight):
        details += f"{GAP}highlight {shares(light.highlight)}"
    end = linear_combination(1.0, light.origin, reach, light.direction)
    title = f"{indent}light {light.light + 1}: {way_of(light)}"
    return ExplainedRay(title, shares(light.diffuse), details, light.origin, end, SHADOWED if is_dark else FREE)


def details_of(ray: RayNode) -> str:
    """Return the numbers of a ray and of the surface that it hits."""
    lines = [f"from {numbers(ray.origin)}{GAP}towards {numbers(ray.direction)}"]
    if at := ray.surface:
        lines.append(f"point {numbers(at.point)}{GAP}normal {numbers(at.normal)}{GAP}u,v {numbers(at.uv)}")
        sent_on = {"mirrored": at.mirror, "refracted": at.glass}
        words = [f"colour {shares(at.colour)}", *(f"{word} {share:.1%}" for word, share in sent_on.items() if share)]
        lines.append(GAP.join(words))
    return "\n".join(lines)


def draw_explained(pixels: Pixels, shown: Explained, scene: Scene, scale: float) -> None:
    """Draw the rays over `pixels`, a picture of `scene`, unless it has changed; the chosen ray is on top."""
    if not shown.fits(scene):
        return
    view = projection_of(scene.camera, pixels.shape[1], pixels.shape[0])
    chosen = shown.parts[shown.chosen]
    for part in (*(each for each in shown.parts if each is not chosen), chosen):
        ends = ends_in_picture(view, part.start, part.end)
        if ends and part.start != part.end:
            width, opacity = (CHOSEN_WIDTH, 1.0) if part is chosen else (WIDTH, OPACITY)
            draw_soft_line(pixels, *ends, HALO, (width + 2 * HALO_WIDTH) * scale, HALO_OPACITY)
            draw_soft_line(pixels, *ends, part.colour, width * scale, opacity)
        if place := view.pixel(part.end):  # a dot: a line that is as short as a pixel
            draw_soft_line(pixels, place, (place[0] + 1, place[1]), part.colour, DOT * scale, 1.0)


def ends_in_picture(view: Projection, start: Triple, end: Triple) -> tuple[Pixel, Pixel] | None:
    """Return where the part of a line that is before the eye and in the picture begins and ends; None without one."""
    depths = [view.depth(point) for point in (start, end)]
    least = NEAR * max(map(abs, depths))
    if max(depths) <= least:
        return None
    points = [start, end]
    for here, there in ((0, 1), (1, 0)):
        if depths[here] < least:  # behind the eye: move it before the eye
            share = (least - depths[here]) / (depths[there] - depths[here])
            points[here] = linear_combination(1.0 - share, points[here], share, points[there])
    first, second = (view.pixel(point) for point in points)
    return clipped(first, second, view.width, view.height) if first and second else None


def clipped(start: Pixel, end: Pixel, width: int, height: int) -> tuple[Pixel, Pixel] | None:
    """Clip a line to a picture (Liang and Barsky 1984); None if no point of it is in the picture."""
    low, high = 0.0, 1.0  # the part of the line that is inside, 0 at the start and 1 at the end
    for at, way, size in ((start[0], end[0] - start[0], width), (start[1], end[1] - start[1], height)):
        if way == 0.0:  # along a border
            if not 0.0 <= at <= size:
                return None
            continue
        enter, leave = sorted((-at / way, (size - at) / way))
        low, high = max(low, enter), min(high, leave)
    if low > high:
        return None
    first, second = ((start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1])) for t in (low, high))
    return first, second


def draw_soft_line(
    pixels: Pixels, start: Pixel, end: Pixel, colour: tuple[int, int, int], width: float, opacity: float
) -> None:
    """Draw a line with soft edges, `width` pixels wide, between two points of the picture; `colour` is RGB."""
    is_steep = abs(end[1] - start[1]) > abs(end[0] - start[0])
    canvas = pixels.swapaxes(0, 1) if is_steep else pixels  # in which the line is not steep, and runs along axis 1
    (x, y), (to_x, to_y) = ((each[::-1] if is_steep else each) for each in (start, end))
    if x > to_x:
        (x, y), (to_x, to_y) = (to_x, to_y), (x, y)
    columns = np.arange(max(0, floor(x)), min(canvas.shape[1], floor(to_x) + 1))
    if not len(columns):
        return
    slope = (to_y - y) / (to_x - x) if to_x > x else 0.0
    middles = y + slope * (columns + 0.5 - x)  # of the line, in each column
    reach = floor(width / 2 * hypot(1.0, slope)) + 2  # rows on either side of the middle that the line may touch
    rows = np.floor(middles).astype(np.int64)[:, None] + np.arange(-reach, reach + 1)  # (columns, touched rows)
    distance = np.abs(rows + 0.5 - middles[:, None]) / hypot(1.0, slope)
    is_inside = (rows >= 0) & (rows < len(canvas))
    cover = np.where(is_inside, opacity * np.clip(width / 2 + 0.5 - distance, 0.0, 1.0), 0.0)
    rows = rows.clip(0, len(canvas) - 1)
    below = canvas[rows, columns[:, None], :3]
    bgr = np.array(colour[::-1])
    canvas[rows, columns[:, None], :3] = np.rint(below + cover[..., None] * (bgr - below))
