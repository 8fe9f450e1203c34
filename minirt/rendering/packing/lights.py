"""Packs colours and lights: as shares of light, decoded where the scene's tone asks for it, and exposed.

Light is linear in its sources: an exposure multiplies each source, and so the whole picture.
"""

from __future__ import annotations

from math import cos, radians, sin, tan
from pathlib import Path
from typing import NamedTuple

import numpy as np

from minirt.kernel.projection import MARGIN, signed_height
from minirt.kernel.shading.lights import FARTHER, LightGrid
from minirt.lanes import Vec
from minirt.materials import pictures
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.tone_mapping import decode_srgb, tone_named
from minirt.scene import Camera, Lamp, Scene

BYTES = np.arange(256, dtype=np.float32) * np.float32(1 / 255)  # as the kernel reads bytes that are shares of light


class Colours(NamedTuple):
    """The reading of a scene's colours, as its tone and exposure ask for it."""

    decodes: bool = False  # whether they are decoded by the transfer function of sRGB
    gain: float = 1.0  # factor of each source of light

    def shares(self, colour: tuple[float, ...]) -> np.ndarray:
        """Return the shares of light of a colour, such as that of a surface: red, green, blue in [0, 1]."""
        return self.decoded(np.divide(colour, 255))

    def light(self, colour: tuple[float, ...], brightness: float = 1.0) -> np.ndarray:
        """Return the light of a source of that colour at full incidence."""
        return self.shares(colour) * (brightness * self.gain)

    def decoded(self, colours: np.ndarray) -> np.ndarray:
        return decode_srgb(colours) if self.decodes else colours

    def surface_colours(self, colours_and_extents: np.ndarray) -> np.ndarray:
        """Return `minirt.kernel.scene_arrays.SceneArrays.colours_and_extents` with colours as shares of light."""
        if not self.decodes:
            return colours_and_extents
        return np.hstack([decode_srgb(colours_and_extents[:, :3]), colours_and_extents[:, 3:]])

    def texture(self, path: Path, colour: tuple[float, ...]) -> np.ndarray:
        """Read a picture file as shares of light, multiplied by those of a colour."""
        return self.of_bytes.take(pictures.picture(path)) * self.shares(colour).astype(np.float32)

    def sky(self, path: Path) -> np.ndarray:
        """Read a picture file as the light of a sky, exposed; bytes where they are in proportion to light in [0, 1]."""
        pixels = pictures.sky(path)
        if pixels.dtype == np.uint8 and (self.decodes or self.gain != 1):
            pixels = self.of_bytes.take(pixels)
        if self.gain == 1:
            return pixels
        with np.errstate(over="ignore"):
            return np.minimum(pixels * np.float32(self.gain), np.finfo(np.float32).max)

    @property
    def of_bytes(self) -> np.ndarray:
        """The share of light that each byte stands for, float32 (256,)."""
        return self.decoded(np.arange(256) / 255).astype(np.float32) if self.decodes else BYTES


def colours_of(camera: Camera) -> Colours:
    """Return how the colours of a scene with this camera are read."""
    return Colours(tone_named(camera.tone).decodes, 2.0**camera.exposure)


TURN = 2.4  # radians, from the samples of one light to those of the next: the golden angle, rounded


def emitting_lights(scene: Scene) -> list[Lamp]:
    return [light for light in scene.lights if light.brightness and any(light.colour)]


def positions_and_intensities(lights: list[Lamp], colours: Colours) -> np.ndarray:
    """A row for each of m lights, (m, 6): position and intensity."""
    rows = [(*light_position(light), *colours.light(light.colour, light.brightness)) for light in lights]
    return np.array(rows, np.float64).reshape(len(lights), 6)


def light_position(light: Lamp) -> np.ndarray:
    """The position of a light; the origin for parallel light, which has none."""
    return np.array(light.position or (0.0, 0.0, 0.0), np.float64)


def radius_of(light: Lamp) -> float:
    """The radius of a light with a place; 0 for a point and for parallel light."""
    return (light.size or 0.0) / 2 if light.position else 0.0


def tangent_of(light: Lamp) -> float:
    """The tangent of half the angular diameter of parallel light; 0 for other light."""
    return 0.0 if light.position else tan(radians(light.size or 0.0) / 2)


def light_sizes(lights: list[Lamp]) -> np.ndarray:
    """A row for each of m lights, (m, 4): see `minirt.kernel.shading.lights`."""
    rows = [(radius_of(each), tangent_of(each), cos(TURN * i), sin(TURN * i)) for i, each in enumerate(lights)]
    return np.array(rows, np.float64).reshape(len(lights), 4)


def spot_parameters(lights: list[Lamp]) -> np.ndarray:
    """A row for each of m lights, (m, 7): the 5 numbers of its cone, fading, and 1 if it is parallel, else 0."""
    rows = [(*light.cone(), light.fading(), not light.position) for light in lights]
    return np.array(rows, np.float64).reshape(len(lights), 7)


# Light sources that fade have lists where there are so many. Cells along the usual reach, by how much the cells of one
# grid are longer than those of the last, and entries of all lists of a grid, at most.
MANY, CELLS_IN_REACH, COARSER, MOST_ENTRIES = 8, 3, 4, 2**19
FADING = 5  # column of `spot_parameters`


def light_grid(sources: np.ndarray, spots: np.ndarray | None) -> LightGrid | None:
    """List the light sources that reach each cell of grids around all sources that fade.

    `sources` (m, 6) are `positions_and_intensities`, `spots` (m, 7) `spot_parameters`; None for None. There are no
    grids where less than MANY sources fade, else finer and coarser ones, as far as their lists are short enough. The
    last list is that of all sources.
    """
    if spots is None:
        return None
    with np.errstate(divide="ignore"):
        reach, centres = 1 / spots[:, FADING, None], sources[:, :3]
    fades = np.isfinite(reach[:, 0])
    grids, sizes, members = np.zeros((0, 8)), [np.zeros(1, np.int64)], [np.zeros(0, np.int64)]
    if fades.sum() >= MANY:
        low, high = (centres - reach)[fades].min(axis=0), (centres + reach)[fades].max(axis=0)
        edge, counts = float(np.median(reach[fades])) / CELLS_IN_REACH, np.full(3, np.inf)
        while counts.max() > COARSER:
            counts = np.ceil((high - low) / edge)
            lists = sources_of_cells((centres - low) / edge, reach / edge, counts)
            if lists:
                first_list = sum(map(len, sizes)) - 1
                grids = np.vstack([grids, [*low, 1 / edge, *counts, first_list]])
                lengths, members_of_grid = lists
                sizes.append(lengths)
                members.append(members_of_grid)
            edge *= COARSER
    starts = np.cumsum(np.concatenate([*sizes, [len(reach)]]))
    return LightGrid(grids, starts.astype(np.int32), np.concatenate([*members, np.arange(len(reach))]).astype(np.int32))


def sources_of_cells(
    centres: np.ndarray, reach: np.ndarray, counts: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the lengths of the lists of all cells, and their members one after the other; None where they are too
    long.

    Centres (m, 3) and reach (m, 1) are in edges of a cell. There are `counts` (3,) cells along x, y and z. The list of
    a cell also holds for points up to an edge above it on each axis.
    """
    ends = centres - reach - 1 - FARTHER, centres + reach + FARTHER
    first, last = (np.clip(end, 0, counts - 1).astype(np.int64) for end in ends)
    spans = last - first + 1
    entries = spans.prod(axis=1)
    if max(counts.prod(), entries.sum()) > MOST_ENTRIES:
        return None
    # All pairs of a source and a cell of the box around its reach, of which `number` counts the cells.
    source = np.repeat(np.arange(len(reach)), entries)
    number = np.arange(len(source)) - np.repeat(np.cumsum(entries) - entries, entries)
    row, layer = spans[source, 0], spans[source, 0] * spans[source, 1]  # cells of a row and of a layer of the box
    cell = first[source] + np.stack([number % row, number % layer // row, number // layer], axis=1)
    apart = np.clip(centres[source], cell, cell + 2) - centres[source]
    meets = (apart * apart).sum(axis=1) <= (reach[source, 0] + FARTHER) ** 2
    place = (cell @ [1, counts[0], counts[0] * counts[1]]).astype(np.int64)[meets]
    lengths = np.bincount(place, minlength=int(counts.prod()))
    return lengths, source[meets][np.argsort(place, kind="stable")]


def never_occludes(shape_arrays: ShapeArrays, eye: np.ndarray, light: Lamp, radius: float = 0.0) -> np.ndarray:
    """Whether each plane, (p,), never lies between the light and what the eye sees. The eye is anywhere in a ball of
    some radius about `eye`, (3,): in a lens.

    Whatever an eye sees lies on its side of every opaque plane, because the plane hides the rest. So a plane occludes
    nothing if the light is on that side, too, or if parallel light comes from there, whatever the rounding. Transparent
    planes do not hide the rest: False.
    """
    planes = shape_arrays.planes
    heights = signed_heights(planes, eye, radius)
    if light.position:
        harmless = heights * signed_heights(planes, light_position(light), radius_of(light)) > 0
    else:
        cosines = planes[:, :3] @ -np.array(light.cone()[:3])  # of the normals with the direction to the light
        harmless = (heights * cosines > 0) & (np.abs(cosines) > MARGIN + tangent_of(light))
    owners = shape_arrays.owner[shape_arrays.plane_indices].tolist()
    glass = [shape_arrays.shape(owner).glass for owner in owners]
    return harmless & np.array([each is None or each.share <= 0 for each in glass], bool)


def signed_heights(planes: np.ndarray, point: np.ndarray, radius: float = 0.0) -> np.ndarray:
    """Signed heights (p,) of the points of a ball above planes, (p, 5), whose magnitudes are lower bounds: 0 where the
    ball meets a plane, see `signed_height`."""
    heights: np.ndarray = signed_height(planes.T, Vec(*point), MARGIN * np.abs(point).max() + radius)
    return heights
