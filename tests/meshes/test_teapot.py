"""Newell's teapot is closed, its normals point outwards, and the script writes it."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.meshes import load_mesh
from tests.paths import ROOT, SCENES

PATH = SCENES / "meshes" / "teapot.obj"


def read() -> tuple[np.ndarray, list[list[int]]]:
    """Points and faces of the file."""
    lines = PATH.read_text().splitlines()
    points = np.array([line.split()[1:] for line in lines if line.startswith("v ")], float)
    faces = [[int(each.split("/")[0]) - 1 for each in line.split()[1:]] for line in lines if line.startswith("f ")]
    return points, faces


def test_it_is_closed_and_its_normals_point_outwards() -> None:
    mesh = load_mesh(PATH)
    assert mesh.closed
    assert not mesh.some(np.arange(1, len(mesh))).closed
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
