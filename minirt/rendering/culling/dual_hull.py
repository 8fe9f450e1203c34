"""Culling of planes by duality: the planes that are seen from a point are the corners of a convex hull.

A plane at height h with the unit normal n has the dual point n / h. In direction d the reciprocal of its depth is the
product of d with that point, so that a plane is hidden wherever one looks if its dual point is within the hull of
those of other planes and the origin: de Berg et al., Computational Geometry, 2008, section 11.4.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from minirt.kernel.binning import MARGIN

DIRECTIONS = 32  # in which extreme points are looked for
LEAST = 1e-99  # height, so that no square of a reciprocal overflows
SAMPLE, LARGE_SAMPLE = 1024, 8192  # planes of which the principal axes are computed, and the extreme points
THINNEST = 1e-12  # least spread along a principal axis, of the greatest
ROUNDS = 4
WORTHWHILE = 0.9  # a round that would leave more of a sample is left out, and all behind it
FLATTEST = 1e-4  # volume of a tetrahedron whose edges from the origin have length 1: flatter ones are not used
ROUNDING = 1e-9  # error of barycentric coordinates in such a tetrahedron
TRIPLES = np.array(list(combinations(range(DIRECTIONS), 3)))


def sphere_points(count: int, turn: float) -> np.ndarray:
    """Return unit vectors (count, 3) that are evenly spread (Fibonacci lattice), turned about an axis."""
    z = 1 - (2 * np.arange(count) + 1) / count
    angle = turn + np.arange(count) * np.pi * (3 - np.sqrt(5))
    across = np.sqrt(1 - z * z)
    return np.stack([across * np.cos(angle), across * np.sin(angle), z], axis=1)


SPHERES = [sphere_points(DIRECTIONS, turn) for turn in range(ROUNDS)]


def within_hull(
    normals: np.ndarray, heights: np.ndarray, error: np.ndarray, hides: np.ndarray, ratio: float
) -> np.ndarray:
    """Whether other planes hide each plane (p,) from a point, wherever one looks.

    `normals` (p, 3) point towards the planes, and `heights` (p,) are the least distances to them, too small by up to
    `error` (p,); planes hide those behind them that are farther by the factor `ratio`, where `hides` (p,) is true.
    """
    hidden = np.zeros(len(heights), bool)
    candidates = np.flatnonzero(heights > LEAST)
    for sphere in SPHERES:
        hiding = candidates[hides[candidates]]
        if len(hiding) < 4:
            break
        hiding = hiding[:: -(-len(hiding) // LARGE_SAMPLE)]
        points = (normals[hiding] / (heights[hiding] + error[hiding])[:, None]).T
        frame = principal_frame(points)
        corners = frame @ points[:, np.unique((sphere @ frame @ points).argmax(axis=1))]
        triangles = [corners[:, triangle] for triangle in hull_triangles(corners)]
        duals = (frame * ratio) @ (normals[candidates] / heights[candidates, None]).T
        few = duals[:, :: -(-len(candidates) // SAMPLE)]
        if len(candidates) > 2 * SAMPLE and len(outside(few, triangles, frame)) > WORTHWHILE * few.shape[1]:
            break
        hidden[candidates] = True
        candidates = candidates[outside(duals, triangles, frame)]
        hidden[candidates] = False
    return hidden


def outside(points: np.ndarray, triangles: list[np.ndarray], frame: np.ndarray) -> np.ndarray:
    """Return the indices of points (3, n) that lie in none of the tetrahedra of the origin and triangles."""
    rest = np.arange(points.shape[1])
    for corners in triangles:
        out = ~in_tetrahedron(points, corners, frame)
        rest, points = rest[out], points[:, out]
    return rest


def principal_frame(points: np.ndarray) -> np.ndarray:
    """Return the matrix (3, 3) that maps points (3, n) to coordinates along their principal axes, of similar spread."""
    axes, spread, _ = np.linalg.svd(points[:, :: -(-points.shape[1] // SAMPLE)], full_matrices=False)
    frame: np.ndarray = axes.T / np.maximum(spread, spread[0] * THINNEST)[:, None]
    return frame


def hull_triangles(points: np.ndarray) -> np.ndarray:
    """Return triangles (t, 3), indices of points (3, k), that no other point is beyond as seen from the origin."""
    triples = TRIPLES[TRIPLES[:, 2] < points.shape[1]]
    a, b, c = points.T[triples].swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    reach = (normal * a).sum(axis=1)
    beyond = (normal @ points) * np.sign(reach)[:, None]
    triangles: np.ndarray = triples[(beyond <= np.abs(reach)[:, None] * (1 + ROUNDING)).all(axis=1)]
    return triangles


def in_tetrahedron(points: np.ndarray, corners: np.ndarray, frame: np.ndarray) -> np.ndarray:
    """Whether points (3, n) lie within the tetrahedron of the origin and three corners (3, 3), all in a frame.

    They lie so deep in it that one of the corners' planes is hit, whatever the rounding, where that of the point is.
    """
    if not abs(np.linalg.det(corners / np.sqrt((corners * corners).sum(axis=0)))) > FLATTEST:
        return np.zeros(points.shape[1], bool)
    inverse = np.linalg.inv(corners)
    first, second, third = inverse @ points
    sums = np.concatenate([inverse, inverse.sum(axis=0, keepdims=True)])
    farthest = np.sqrt((np.linalg.solve(frame, corners) ** 2).sum(axis=0)).max()  # the reciprocal of a height
    slack = 2 * MARGIN * farthest * np.sqrt(((sums @ frame) ** 2).sum(axis=1)) + ROUNDING
    inside: np.ndarray = (first >= slack[0]) & (second >= slack[1]) & (third >= slack[2])
    inside &= first + second + third <= 1 - slack[3]
    return inside
