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
        edges, across = edges_of(self.points[self.corners])
        longest = np.argmax(squared_lengths(edges), axis=1)
        edge = edges[np.arange(len(edges)), longest]
        across -= ((across * edge).sum(axis=1) / squared_lengths(edge))[:, None] * edge
        if self.normals is not None:
            across[(self.normals.sum(axis=1) * across).sum(axis=1) < 0] *= -1
        return unit(across)


def used_points(points: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the points that are corners of triangles, mostly all, and the corners among these."""
    is_used = np.zeros(len(points), bool)
    is_used[corners] = True
    return (points, corners) if is_used.all() else (points[is_used], (np.cumsum(is_used) - 1)[corners])


def edges_of(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges of triangles (m, 3, 3) from each corner to the next, and the cross products of the first two."""
    edges = corners[:, [1, 2, 0]] - corners
    return edges, np.cross(edges[:, 0], edges[:, 1])


def non_degenerate(corners: np.ndarray) -> np.ndarray:
    """Return a mask of the triangles (m, 3, 3) that are more than a line or a point."""
    edges, across = edges_of(corners)
    longest = np.sqrt(squared_lengths(edges).max(axis=1))
    larger: np.ndarray = np.sqrt(squared_lengths(across)) > FLATNESS * np.abs(corners).max(axis=(1, 2)) * longest
    return larger


def squared_lengths(vectors: np.ndarray) -> np.ndarray:
    """Return the squared lengths of vectors."""
    products: np.ndarray = np.einsum("...i,...i", vectors, vectors)
    return products


def unit(vectors: np.ndarray) -> np.ndarray:
    """Normalise vectors (m, 3), none of them 0."""
    scaled: np.ndarray = vectors / np.abs(vectors).max(axis=-1, keepdims=True)
    scaled /= np.sqrt(squared_lengths(scaled))[..., None]
    return scaled
