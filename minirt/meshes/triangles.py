"""Triangles in arrays, and what follows from their corners."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

FLATNESS = 16 * 2.0**-53  # of its largest coordinate: a triangle that is no higher is none


@dataclass(frozen=True, eq=False)
class Triangles:
    """m triangles with corners among n points, in units of their file; not to be written to."""

    points: np.ndarray  # (n, 3)
    corners: np.ndarray  # (m, 3) indices of points, counter-clockwise as seen from outside
    normals: np.ndarray | None = None  # (m, 3, 3) unit normal at each corner of what the triangles stand for
    uvs: np.ndarray | None = None  # (m, 3, 2) coordinates of a picture at each corner

    def __len__(self) -> int:
        return len(self.corners)

    def some(self, indices: np.ndarray) -> Triangles:
        """Some of the triangles."""
        normals = None if self.normals is None else self.normals[indices]
        uvs = None if self.uvs is None else self.uvs[indices]
        return Triangles(self.points, self.corners[indices], normals, uvs)

    @cached_property
    def used(self) -> np.ndarray:
        """The points that are corners."""
        return np.unique(self.corners)

    @cached_property
    def box(self) -> np.ndarray:
        """Least and greatest corner of the box around them, (2, 3)."""
        used = self.points[self.used]
        return np.stack([used.min(axis=0), used.max(axis=0)])

    @cached_property
    def edges(self) -> np.ndarray:
        """Numbers of their edges, (m, 3), each from a corner to the next; those between the same points have the
        same."""
        ends = np.sort(np.stack([self.corners, np.roll(self.corners, -1, axis=1)], axis=-1), axis=-1)
        _, numbers = np.unique(ends[..., 0] * len(self.points) + ends[..., 1], return_inverse=True)
        return numbers.reshape(-1, 3)

    @cached_property
    def closed(self) -> bool:
        """Whether all edges are edges of as many triangles in either direction."""
        ways = np.sign(np.roll(self.corners, -1, axis=1) - self.corners)
        return not np.bincount(self.edges.ravel(), ways.ravel()).any()

    @cached_property
    def flat_normals(self) -> np.ndarray:
        """The unit normal of each, (m, 3): on the side of the corners' normals, or else where the corners are seen in
        counter-clockwise order. Of a sliver it is exact to a rounding about the longest edge, as that of a `tr`."""
        edges, across = edges_of(self.points[self.corners])
        longest = np.argmax(squared_lengths(edges), axis=1)
        edge = edges[np.arange(len(edges)), longest]
        across -= ((across * edge).sum(axis=1) / squared_lengths(edge))[:, None] * edge
        if self.normals is not None:
            across[(self.normals.sum(axis=1) * across).sum(axis=1) < 0] *= -1
        return unit(across)


def edges_of(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The edges of triangles (m, 3, 3), each from a corner to the next, and the products of the first two, (m, 3)."""
    edges = np.roll(corners, -1, axis=1) - corners
    return edges, np.cross(edges[:, 0], edges[:, 1])


def non_degenerate(corners: np.ndarray) -> np.ndarray:
    """Which triangles (m, 3, 3) are more than a line or a point."""
    edges, across = edges_of(corners)
    longest = np.sqrt(squared_lengths(edges).max(axis=1))
    larger: np.ndarray = np.sqrt(squared_lengths(across)) > FLATNESS * np.abs(corners).max(axis=(1, 2)) * longest
    return larger


def squared_lengths(vectors: np.ndarray) -> np.ndarray:
    """The squared lengths of vectors."""
    products: np.ndarray = np.einsum("...i,...i", vectors, vectors)
    return products


def unit(vectors: np.ndarray) -> np.ndarray:
    """The vectors (m, 3), none of them 0, at length 1."""
    scaled: np.ndarray = vectors / np.abs(vectors).max(axis=-1, keepdims=True)
    scaled /= np.sqrt(squared_lengths(scaled))[..., None]
    return scaled
