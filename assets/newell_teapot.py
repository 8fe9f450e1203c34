"""Newell's teapot of 1975, from the Bezier patches that he published: 32 patches of 4x4 control points.

24 of them are quarters of a body of revolution, given here by its outline; the handle and the spout have four each, of
which two mirror the others. The published surface has gaps. Further patches close them, so that the mesh can be of
glass: a ring between lid and rim, the ends of handle and spout inside the body, and the inside of the mouth.
"""

from __future__ import annotations

import numpy as np

Array = np.ndarray
Rows = list[tuple[float, ...]]
ARC = 0.56  # control points of a quarter of a circle, in radii; 4/3 (sqrt(2) - 1) = 0.5523 would be closer to a circle
AROUND, ALONG = 12, 12  # quads of a patch

# Radius and height of the outline's cubic curves, from the middle of the bottom up to the top of the knob.
OUTLINE: list[Rows] = [
    [(0, 0), (1.425, 0), (1.5, 0.075), (1.5, 0.15)],
    [(1.5, 0.15), (1.5, 0.225), (2, 0.45), (2, 0.9)],
    [(2, 0.9), (2, 1.35), (1.75, 1.875), (1.5, 2.4)],
    [(1.5, 2.4), (1.4375, 2.53125), (1.3375, 2.53125), (1.4, 2.4)],
    [(1.4, 2.4), (1.4 - 0.1 / 3, 2.4), (1.3 + 0.1 / 3, 2.4), (1.3, 2.4)],  # not Newell's: between rim and lid
    [(1.3, 2.4), (1.3, 2.55), (0.4, 2.55), (0.2, 2.7)],
    [(0.2, 2.7), (0, 2.85), (0.8, 3.15), (0, 3.15)],
]

# Rows of half tubes, from end to end: x and z where a row begins and where it ends, both at y = 0, and its breadth.
HANDLE: list[Rows] = [
    [
        (-1.6, 2.025, -1.5, 2.25, 0.3),
        (-2.3, 2.025, -2.5, 2.25, 0.3),
        (-2.7, 2.025, -3, 2.25, 0.3),
        (-2.7, 1.8, -3, 1.8, 0.3),
    ],
    [
        (-2.7, 1.8, -3, 1.8, 0.3),
        (-2.7, 1.575, -3, 1.35, 0.3),
        (-2.5, 1.125, -2.65, 0.9375, 0.3),
        (-2, 0.9, -1.9, 0.6, 0.3),
    ],
]
SPOUT: list[Rows] = [
    [
        (1.7, 1.425, 1.7, 0.6, 0.66),
        (2.6, 1.425, 3.1, 0.825, 0.66),
        (2.3, 2.1, 2.4, 2.025, 0.25),
        (2.7, 2.4, 3.3, 2.4, 0.25),
    ],
    [
        (2.7, 2.4, 3.3, 2.4, 0.25),
        (2.8, 2.475, 3.525, 2.49375, 0.25),
        (2.9, 2.475, 3.45, 2.5125, 0.15),
        (2.8, 2.4, 3.2, 2.4, 0.15),
    ],
]


def quarter(outline: Rows, turn: int) -> Array:
    """Control points (4, 4, 3) of a quarter of a surface of revolution about z; the knob's 0.45 is 0.5625 x 0.8."""
    rows = []
    for radius, height in outline:
        aside = 0.45 if radius == 0.8 else ARC * radius
        rows.append([(radius, 0, height), (radius, aside, height), (aside, radius, height), (0, radius, height)])
    cosine, sine = [(1, 0), (0, 1), (-1, 0), (0, -1)][turn]
    return np.array(rows, float) @ np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]])


def halves(rows: Rows) -> list[Array]:
    """Control points of both halves of a tube, which mirror each other in the plane y = 0."""
    net = np.array([[(a, 0, b), (a, -y, b), (c, -y, d), (c, 0, d)] for a, b, c, d, y in rows], float)
    return [net, net[:, ::-1] * [1, -1, 1]]


def between(first: Array, last: Array) -> Array:
    """Control points of the ruled surface between two curves of four control points."""
    return np.stack([first + (last - first) * share for share in (0, 1 / 3, 2 / 3, 1)])


def tube(parts: list[Rows], mouth: bool) -> list[Array]:
    """Control points of a tube with both ends closed; with a mouth, its end goes on into the tube before that."""
    nets = [net for rows in parts for net in halves(rows)]
    front, back = nets[-2][-1], nets[-1][-1]
    if mouth:
        middle, inside = (front[0] + front[3]) / 2, np.array([2.84, 0, 2.23])
        inner = [inside + 0.75 * (curve - middle) for curve in (front, back)]
        nets += [between(front, inner[0]), between(back, inner[1])]
        front, back = inner
    return [*nets, between(nets[0][0], nets[1][0][::-1])[::-1], between(front, back[::-1])]


def bernstein(t: Array) -> tuple[Array, Array]:
    """The four cubic Bernstein polynomials at places (n,), and their derivatives, each (n, 4)."""
    s = 1 - t
    slopes = [-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t]
    return np.stack([s**3, 3 * s * s * t, 3 * s * t * t, t**3], axis=-1), np.stack(slopes, axis=-1)


def sampled(net: Array) -> tuple[Array, Array]:
    """Points and unit normals (ALONG + 1, AROUND + 1, 3) of a patch; normals are limits where it shrinks to a point."""
    places = np.arange(ALONG + 1) / ALONG, np.arange(AROUND + 1) / AROUND
    (down, _), (across, _) = map(bernstein, places)
    points = np.einsum("ia,jb,abk->ijk", down, across, net)
    (down, falls), (across, turns) = (bernstein(np.clip(each, 1e-5, 1 - 1e-5)) for each in places)
    normals = np.cross(np.einsum("ia,jb,abk->ijk", down, turns, net), np.einsum("ia,jb,abk->ijk", falls, across, net))
    return points, normals / np.linalg.norm(normals, axis=-1, keepdims=True)


def teapot() -> tuple[Array, Array, list[Array]]:
    """Points (n, 3), normals (m, 3), and faces, (3 or 4, 2) indices of both; y is up, and the foot stands at y = 0."""
    nets = [quarter(curve, turn) for curve in OUTLINE for turn in range(4)]
    nets += tube(HANDLE, mouth=False) + tube(SPOUT, mouth=True)
    points, normals = (
        np.round(np.concatenate([each.reshape(-1, 3) for each in part]), 6) + 0.0
        for part in zip(*map(sampled, nets), strict=True)
    )
    points, place = np.unique(points, axis=0, return_inverse=True)
    normals, turned = np.unique(np.round(normals, 3) + 0.0, axis=0, return_inverse=True)
    j, i = np.meshgrid(np.arange(AROUND), np.arange(ALONG))
    quads = np.stack([k * (AROUND + 1) + h for h, k in ((j, i), (j + 1, i), (j + 1, i + 1), (j, i + 1))], axis=-1)
    starts = np.arange(len(nets)) * (AROUND + 1) * (ALONG + 1)
    corners = (starts[:, None, None, None] + quads).reshape(-1, 4)
    both = np.stack([place.reshape(-1)[corners], turned.reshape(-1)[corners]], axis=-1)
    faces = [face[face[:, 0] != np.roll(face[:, 0], 1)] for face in both]
    up = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])  # z is up in the published data
    return points @ up, normals @ up, [face for face in faces if len(face) > 2]
