"""Indexed triangle mesh in arrays: normals, edges, bounding box."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from minirt.element import fields_of
from minirt.fields import PictureFile
from minirt.lanes import Vec, cross, dot, max_norm, maximum, where

BLOCK = 8192  # triangles that are looked at together
FLATNESS = 16 * 2.0**-53  # a triangle lower than this share of its largest coordinate is degenerate


@dataclass(frozen=True, eq=False)
class Triangles:
    """m triangles with corners among n points, in the units of their file; the arrays are read-only by convention."""

    points: np.ndarray  # (n, 3)
    corners: np.ndarray  # (m, 3) indices of points, counter-clockwise as seen from outside
    normals: np.ndarray | None = None  # (m, 3, 3) unit normals at the corners, for smooth shading
    uvs: np.ndarray | None = None  # (m, 3, 2) texture coordinates at the corners
    colours: np.ndarray | None = None  # (m, 3) uint8, by which the colour of the mesh is multiplied
    material_of: np.ndarray | None = None  # (m,) index of the material of each triangle
    materials: tuple[Any, ...] = ()  # `minirt.meshes.mtl.MeshMaterial`
    notices: tuple[str, ...] = ()  # what was left out of the file
    libraries: tuple[Path, ...] = ()  # files of its materials

    def __len__(self) -> int:
        return len(self.corners)

    def __reduce__(self) -> tuple[object, ...]:
        """Give `pickle` the arrays, without what was computed of them."""
        return Triangles, tuple(getattr(self, each.name) for each in fields(self))

    def some(self, indices: np.ndarray) -> Triangles:
        """Return the triangles with those indices, and their points."""
        names = "normals", "uvs", "colours", "material_of"
        of_each = {name: array[indices] for name in names if (array := getattr(self, name)) is not None}
        points, corners = used_points(self.points, self.corners[indices])
        return replace(self, points=points, corners=corners, **of_each)

    def pictures(self) -> Iterator[PictureFile]:
        """The pictures of its materials."""
        for material in self.materials:
            for field in fields_of(type(material)):
                if (value := getattr(material, field.name)) is not None:
                    yield from field.pictures(value)

    @cached_property
    def box(self) -> np.ndarray:
        """Bounding box: least and greatest corner, (2, 3)."""
        return np.stack([self.points.min(axis=0), self.points.max(axis=0)])

    @cached_property
    def edges(self) -> np.ndarray:
        """Numbers of the edges from each corner to the next, (m, 3); edges between the same points share a number."""
        ends = np.sort(np.stack([self.corners, np.roll(self.corners, -1, axis=1)], axis=-1), axis=-1)
        _, numbers = np.unique(ends[..., 0] * len(self.points) + ends[..., 1], return_inverse=True)
        return numbers.reshape(-1, 3)

    @cached_property
    def closed(self) -> bool:
        """Whether each edge is run through equally often in both directions, as in a closed surface."""
        ways = np.sign(np.roll(self.corners, -1, axis=1) - self.corners)
        return not np.bincount(self.edges.ravel(), ways.ravel()).any()

    @cached_property
    def flat_normals(self) -> np.ndarray:
        """Unit normals of the triangles, (m, 3), on the side of the corners' normals, or else on the side from which
        the corners run counter-clockwise. The normal of a sliver is exact to a rounding about its longest edge, as in
        `minirt.shapes.triangle`."""
        found = [np.zeros((0, 3))]
        for some, _, (a, b, c), across in blocks(self.points, self.corners):
            of_a, of_b, of_c = dot(a, a), dot(b, b), dot(c, c)
            longest = where(of_a >= maximum(of_b, of_c), a, where(of_b >= of_c, b, c))
            normal = across - (dot(across, longest) / dot(longest, longest)) * longest
            if self.normals is not None:
                normal = where(dot(Vec(*self.normals[some].sum(axis=1).T), normal) < 0.0, -normal, normal)
            found.append(unit(np.stack([normal.x, normal.y, normal.z], axis=1)))
        return np.concatenate(found)


def blocks(points: np.ndarray, corners: np.ndarray) -> Iterator[tuple[slice, list[Vec], list[Vec], Vec]]:
    """Yield for blocks of triangles, whose numbers stay in the cache of a core, where they are, their corners, the
    edges from each corner to the next, and the cross products of the first two."""
    columns = points.T.copy()
    for start in range(0, len(corners), BLOCK):
        some = slice(start, start + BLOCK)
        ends = [Vec(*(numbers[each] for numbers in columns)) for each in corners[some].T]
        edges = [ends[(i + 1) % 3] - ends[i] for i in range(3)]
        yield some, ends, edges, cross(edges[0], edges[1])


def used_points(points: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the points that are corners of triangles, mostly all, and the corners among these."""
    is_used = np.zeros(len(points), bool)
    is_used[corners] = True
    return (points, corners) if is_used.all() else (points[is_used], (np.cumsum(is_used) - 1)[corners])


def non_degenerate(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return a mask of the triangles that are more than a line or a point."""
    found = []
    for _, ends, edges, across in blocks(points, corners):
        longest = np.sqrt(np.max([dot(edge, edge) for edge in edges], axis=0))
        largest = np.max([max_norm(end) for end in ends], axis=0)
        found.append(np.sqrt(dot(across, across)) > FLATNESS * largest * longest)
    return np.concatenate(found)


def squared_lengths(vectors: np.ndarray) -> np.ndarray:
    """Return the squared lengths of vectors."""
    products: np.ndarray = np.einsum("...i,...i", vectors, vectors)
    return products


def unit(vectors: np.ndarray) -> np.ndarray:
    """Normalise vectors (m, 3), none of them 0."""
    scaled: np.ndarray = vectors / np.abs(vectors).max(axis=-1, keepdims=True)
    scaled /= np.sqrt(squared_lengths(scaled))[..., None]
    return scaled
