"""Newell's teapot: closed, smooth, and of the volume of its published outline."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from minirt.meshes import load_mesh
from tests.paths import ROOT, SCENES

PATH = SCENES / "meshes" / "teapot.obj"
BODY = [  # the published outline up to the rim, in Bernstein form: radii and heights
    ((0, 1.425, 1.5, 1.5), (0, 0, 0.075, 0.15)),
    ((1.5, 1.5, 2, 2), (0.15, 0.225, 0.45, 0.9)),
    ((2, 2, 1.75, 1.5), (0.9, 1.35, 1.875, 2.4)),
]


def power(points: tuple[float, ...]) -> np.polynomial.Polynomial:
    """A cubic from Bernstein form."""
    a, b, c, d = points
    return np.polynomial.Polynomial([a, 3 * (b - a), 3 * (a - 2 * b + c), d - a + 3 * (b - c)])


def published_volume() -> float:
    """Volume below the height 2.4 of the body, whose level sections are four cubic arcs of Bezier."""
    x, y = power((1, 1, 0.56, 0)), power((0, 0.56, 1, 1))
    quarter = (x * y.deriv() - y * x.deriv()).integ()(1) / 2
    return float(sum(4 * quarter * (power(r) ** 2 * power(z).deriv()).integ()(1) for r, z in BODY))


def read() -> tuple[np.ndarray, list[list[int]]]:
    """Points and faces of the file."""
    lines = PATH.read_text().splitlines()
    points = np.array([line.split()[1:] for line in lines if line.startswith("v ")], float)
    faces = [[int(each.split("/")[0]) - 1 for each in line.split()[1:]] for line in lines if line.startswith("f ")]
    return points, faces


def open_edges(faces: list[list[int]]) -> int:
    """Number of edges that have no neighbour which runs along them the other way, or more than one."""
    edges = Counter(edge for face in faces for edge in zip(face, face[1:] + face[:1], strict=True))
    return sum(edges[edge] != 1 or edges[edge[::-1]] != 1 for edge in edges)


def volume(points: np.ndarray, faces: list[list[int]]) -> float:
    """Volume that the faces enclose, by the divergence theorem."""
    fans = np.array([(face[0], *pair) for face in faces for pair in pairwise(face[1:])])
    return float(np.linalg.det(points[fans]).sum() / 6)


def parts(faces: list[list[int]]) -> list[list[list[int]]]:
    """Faces that are connected over edges: some parts touch in a point."""
    owner = {edge: i for i, face in enumerate(faces) for edge in zip(face, face[1:] + face[:1], strict=True)}
    found, left = [], set(range(len(faces)))
    while left:
        part, front = [], [left.pop()]
        while front:
            part.append(face := faces[front.pop()])
            near = {owner[edge] for edge in zip(face[1:] + face[:1], face, strict=True)} & left
            left -= near
            front += near
        found.append(part)
    return found


def test_it_is_closed() -> None:
    _, faces = read()
    assert open_edges(faces) == 0
    assert open_edges(faces[1:]) > 0
    assert open_edges([faces[0][::-1], *faces[1:]]) > 0


def test_its_body_has_the_volume_of_the_published_outline() -> None:
    points, faces = read()
    below = np.minimum(points, [9, 2.4, 9])  # what is above collapses into the level of the rim
    body, handle, spout = sorted(parts(faces), key=len, reverse=True)
    assert volume(below, body) == pytest.approx(published_volume(), rel=0.01)
    assert volume(points, handle) > 0
    assert volume(points, spout) > 0


def test_its_normals_point_outwards() -> None:
    mesh = load_mesh(PATH)
    assert mesh.normals is not None
    a, b, c = np.moveaxis(np.asarray(mesh.points)[mesh.corners], 1, 0)
    flat = np.cross(b - a, c - a)
    agree = np.einsum("ij,ikj->ik", flat / np.linalg.norm(flat, axis=1)[:, None], np.asarray(mesh.normals))
    assert agree.min() > 0
    assert np.median(agree) > 0.99


def test_the_script_writes_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "assets"))
    import newell_teapot  # type: ignore[import-not-found]

    points, _, faces = newell_teapot.teapot()
    stored, stored_faces = read()
    assert np.abs(points - stored).max() < 6e-4
    assert [face[:, 0].tolist() for face in faces] == stored_faces
