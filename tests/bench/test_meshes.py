"""The meshes of the benchmark are closed, have outward normals and the stated size."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import minirt
from tests.bench.meshes import compared, waves


@pytest.mark.parametrize("count", [1_000, 10_000])
def test_a_ball_of_waves(tmp_path: Path, count: int) -> None:
    (shape,) = minirt.load(waves(tmp_path, count)).meshes
    assert shape.parts == pytest.approx(count, rel=0.05)
    made = shape.triangles
    a, b, c = made.points[made.corners].transpose(1, 0, 2)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(4 / 3 * np.pi, rel=0.02)  # the volume
    assert (np.bincount(made.edges.ravel()) == 2).all()  # every edge is one of two triangles
    path = tmp_path / "meshes" / f"{count}.obj"
    stamp = path.stat().st_mtime_ns
    waves(tmp_path, count)
    assert path.stat().st_mtime_ns == stamp  # written once


def test_the_compared_mesh_has_a_hundred_thousand_triangles(tmp_path: Path) -> None:
    path = compared(tmp_path)
    assert path.stem == "mesh"
    assert minirt.load(path).meshes[0].parts == pytest.approx(100_000, rel=0.01)
