"""Writes the meshes of scenes/meshes: python assets/make_meshes.py

A ball of twenty faces and one that was made round from it, a knot, a pot and a wine glass from a lathe, and Newell's
teapot.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from newell_teapot import teapot

FOLDER = Path(__file__).parent.parent / "scenes" / "meshes"
Array = np.ndarray
GOLDEN = (1 + 5**0.5) / 2

# Radius and height along the outline of a pot, from the top of its knob down to its foot; a smooth curve goes through.
POT = [(0, 1.32), (0.09, 1.3), (0.13, 1.2), (0.06, 1.1), (0.1, 1.04), (0.4, 0.95), (0.6, 0.87)]
POT += [(0.66, 0.86), (0.7, 0.8), (0.86, 0.62), (1.0, 0.35), (1.02, 0.1), (0.9, -0.2), (0.7, -0.38), (0.62, -0.45)]
POT += [(0.66, -0.52), (0.64, -0.56), (0.4, -0.56), (0, -0.54)]

# Radius and height along the outline of a wine glass, from the bottom of its bowl up the inside, over the rim, and down
# the outside to the foot. Both sides of the bowl are paraboloids, so that a paraboloid of wine fits into it.
STEM = [(0.12, 1.3), (0.075, 1.2), (0.06, 0.9), (0.06, 0.5), (0.08, 0.25), (0.3, 0.11), (0.6, 0.06)]
FOOT = [(0.65, 0.03), (0.6, 0), (0.3, 0), (0, 0)]


def bowl(bottom: float, top: float, radius: float) -> list[tuple[float, float]]:
    """Radius and height along the outline of a paraboloid, from its vertex to its rim."""
    return [(radius * k / 8, bottom + (top - bottom) * (k / 8) ** 2) for k in range(9)]


GLASS = [*bowl(1.37, 2.98, 0.71), (0.735, 3), *bowl(1.31, 2.98, 0.75)[:1:-1], *STEM, *FOOT]


def icosahedron() -> tuple[Array, Array]:
    """Return the corners of an icosahedron on the unit sphere, and the corner indices of its twenty triangles."""
    flat = np.array([(0.0, a, b * GOLDEN) for a in (-1, 1) for b in (-1, 1)])
    points = np.concatenate([np.roll(flat, turn, axis=1) for turn in range(3)])
    near = np.linalg.norm(points[:, None] - points, axis=-1) < 2.1
    faces = [
        (i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[k, i]
    ]
    corners = np.array(faces)
    a, b, c = (points[corners[:, i]] for i in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    corners[inward] = corners[inward][:, ::-1]
    return points / np.linalg.norm(points[0]), corners


def rounder(points: Array, corners: Array) -> tuple[Array, Array]:
    """Split each triangle into four, with new corners on the unit sphere."""
    pairs = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    edges, which = np.unique(pairs, axis=0, return_inverse=True)
    middles = points[edges].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1, keepdims=True)
    a, b, c = corners.T
    ab, bc, ca = len(points) + which.reshape(3, -1)
    new = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([points, middles]), np.concatenate([np.stack(each, axis=1) for each in new])


def wrapped(surface: Callable[[Array, Array], Array], across: int, down: int, closed: bool) -> tuple[Array, ...]:
    """Sample a parametric surface, periodic in u and, if `closed`, in v.

    Return points, texture coordinates, normals, and quads whose corners have three indices each.
    """
    u, v = np.meshgrid(np.arange(across + 1) / across, np.arange(down + 1) / down)
    points = surface(u, v)
    step = 1e-4
    w = v if closed else np.clip(v, step, 1 - step)  # at a pole the derivative along u is zero
    normals = np.cross(surface(u + step, w) - surface(u - step, w), surface(u, w + step) - surface(u, w - step))
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    rows, columns = down if closed else down + 1, across
    i, j = np.meshgrid(np.arange(across), np.arange(down))
    around = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
    places = np.stack([k * (across + 1) + h for h, k in around], axis=-1)
    corners = np.stack([(k % rows) * columns + h % columns for h, k in around], axis=-1)
    faces = np.stack([corners, places, corners], axis=-1).reshape(-1, 4, 3)
    return (
        points[:rows, :columns].reshape(-1, 3),
        np.stack([u, v], axis=-1).reshape(-1, 2),
        normals[:rows, :columns].reshape(-1, 3),
        faces,
    )


def knot(u: Array, v: Array) -> Array:
    """A tube around a trefoil; u goes around the tube, v along it."""

    def line(at: Array) -> Array:
        turn = 2 * np.pi * at
        x, y = np.sin(turn) + 2 * np.sin(2 * turn), np.cos(turn) - 2 * np.cos(2 * turn)
        return np.stack([x, y, -np.sin(3 * turn)], axis=-1) / 3

    along = line(v + 1e-4) - line(v - 1e-4)
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    aside = np.cross(along, np.array([0.0, 0.0, 1.0]))
    aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
    turn = 2 * np.pi * u[..., None]
    return line(v) + 0.22 * (np.cos(turn) * aside + np.sin(turn) * np.cross(along, aside))


def turned(line: list[tuple[float, float]], u: Array, v: Array) -> Array:
    """A smooth outline turned on a lathe; u goes around it, v from the end of the outline to its beginning."""
    outline = np.array(line[::-1])
    at = np.clip(v, 0, 1) * (len(outline) - 1)
    i = np.clip(at.astype(int), 0, len(outline) - 2)
    t = (at - i)[..., None]
    p = [outline[np.clip(i + k, 0, len(outline) - 1)] for k in (-1, 0, 1, 2)]
    slopes = (p[2] - p[0]) / 2, (p[3] - p[1]) / 2  # Catmull and Rom 1974
    t2, t3 = t * t, t * t * t
    place = p[1] * (2 * t3 - 3 * t2 + 1) + p[2] * (3 * t2 - 2 * t3)
    place += slopes[0] * (t3 - 2 * t2 + t) + slopes[1] * (t3 - t2)
    turn = 2 * np.pi * u
    return np.stack([place[..., 0] * np.cos(turn), place[..., 1], -place[..., 0] * np.sin(turn)], axis=-1)


def save(name: str, title: str, points: Array, places: Array, normals: Array, faces: Array) -> None:
    """Write a mesh; `faces` are (f, corners, 3) indices of the other three, or (f, corners) of points alone."""
    lines = [f"# {title}"]
    for key, rows in (("v", points), ("vt", places), ("vn", normals)):
        lines += [f"{key} " + " ".join(f"{number + 0.0:.5g}" for number in row) for row in np.round(rows, 5).tolist()]
    for face in (faces + 1).tolist():
        lines.append(
            "f " + " ".join("/".join(map(str, each)) if isinstance(each, list) else str(each) for each in face)
        )
    (FOLDER / name).write_text("\n".join(lines) + "\n", encoding="ascii")


def save_teapot(name: str) -> None:
    """Write Newell's teapot, whose faces have indices of points and normals."""
    points, normals, faces = teapot()
    lines = ["# Newell's teapot of 1975, closed"]
    for key, rows in (("v", points), ("vn", normals)):
        lines += [f"{key} " + " ".join(f"{number + 0.0:.4g}" for number in row) for row in rows.tolist()]
    lines += ["f " + " ".join(f"{point}//{normal}" for point, normal in (face + 1).tolist()) for face in faces]
    (FOLDER / name).write_text("\n".join(lines) + "\n", encoding="ascii")


def main() -> None:
    """Write all meshes."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    nothing = np.zeros((0, 3))
    points, corners = icosahedron()
    save("icosahedron.obj", "A ball of twenty faces", points, nothing, nothing, corners)
    for _ in range(3):
        points, corners = rounder(points, corners)
    save("icosphere.obj", "A ball of 1,280 faces", points, nothing, nothing, corners)
    save("knot.obj", "A trefoil knot, round and with places of a picture", *wrapped(knot, 18, 110, closed=True))
    save("pot.obj", "A pot, round and with places of a picture", *wrapped(partial(turned, POT), 40, 54, closed=False))
    save("wineglass.obj", "A wine glass, round", *wrapped(partial(turned, GLASS), 40, len(GLASS) - 1, closed=False))
    save_teapot("teapot.obj")


if __name__ == "__main__":
    main()
