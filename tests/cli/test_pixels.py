"""The program explains a pixel, and writes what each pixel shows: numbers where a format holds them, else colours."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import minirt
from tests.cli.program import Run
from tests.cli.test_output import pixels

SIZE = ("--size", "40x30")
MIDDLE = ("--explain", "20,15")


def test_a_pixel_is_explained_as_a_tree(run: Run, folder: Path) -> None:
    explanation = minirt.explain(minirt.load("ball.rt"), 40, 30, 20, 15)
    assert run("ball.rt", *SIZE, *MIDDLE) == (0, f"{explanation}\n".encode(), "")


def test_a_pixel_is_explained_as_json_with_the_options_of_the_picture(run: Run, folder: Path) -> None:
    ended = run("ball.rt", *SIZE, *MIDDLE, "--json", "--tone", "filmic", "--exposure", "1", "--depth", "2")
    assert (ended.status, ended.err) == (0, "")
    assert run("ball.rt", *SIZE, "--tone", "filmic", "--exposure", "1", "-o", "x.png").status == 0
    assert json.loads(ended.out)["level"] == pixels("x.png")[15, 20].tolist()


def test_a_pixel_outside_is_an_error(run: Run, folder: Path) -> None:
    told = "Error\npixel 40,0 does not lie in the picture of 40x30 pixels\n"
    assert run("ball.rt", *SIZE, "--explain", "40,0") == (1, b"", told)


@pytest.mark.parametrize("kind", ["normals", "depth", "ids", "uv", "point"])
def test_files_of_numbers_have_the_buffers(run: Run, folder: Path, kind: str) -> None:
    tifffile, exr = pytest.importorskip("tifffile"), pytest.importorskip("OpenEXR")
    seen = minirt.buffers(minirt.load("ball.rt"), 40, 30)
    expected = {"normals": seen.normal, "depth": seen.depth, "ids": seen.shape, "uv": seen.uv, "point": seen.point}
    for name in ("x.tif", "x.exr"):
        assert run("ball.rt", *SIZE, "--buffers", kind, "-o", name).status == 0
    with exr.File("x.exr") as file:
        found = file.channels()["RGB"].pixels.copy()
    assert np.array_equal(found, tifffile.imread("x.tif"), equal_nan=True)
    wanted = expected[kind].reshape(30, 40, -1).astype(np.float32)
    assert np.array_equal(found[..., : wanted.shape[-1]], wanted, equal_nan=True)


def test_pictures_of_levels_have_colours_for_the_buffers(run: Run, folder: Path) -> None:
    seen = minirt.buffers(minirt.load("ball.rt"), 40, 30)
    made = {}
    for kind in ("normals", "depth", "ids", "uv", "point"):
        assert run("ball.rt", *SIZE, "--buffers", kind, "-o", "x.png").status == 0
        made[kind] = pixels("x.png").astype(int)
        assert (made[kind][seen.shape < 0] == 0).all()
    is_hit = seen.shape >= 0
    assert np.abs(made["normals"][is_hit] - 255 * (seen.normal[is_hit] + 1) / 2).max() <= 0.5
    assert made["depth"][seen.depth == seen.depth.min()].tolist()[0] == [255, 255, 255]
    assert len(np.unique(made["ids"][is_hit], axis=0)) == 2
    assert np.abs(made["uv"][is_hit][:, :2] - 255 * (seen.uv[is_hit] % 1)).max() <= 0.5
    right = seen.point[..., 0] == np.nanmax(seen.point[..., 0])
    assert (made["point"][right][:, 0] == 255).all()


def test_a_format_without_numbers_below_0_is_refused(run: Run, folder: Path) -> None:
    told = "Error\nx.hdr: Radiance holds no numbers below 0, try .exr\n"
    assert run("ball.rt", "--buffers", "normals", "-o", "x.hdr") == (1, b"", told)


def test_the_ids_of_many_shapes_have_different_colours() -> None:
    seen = minirt.buffers(minirt.example("demo"), 160, 90)
    colours = seen.picture("ids").array[seen.shape >= 0]
    assert len(np.unique(colours, axis=0)) == len(np.unique(seen.shape[seen.shape >= 0])) > 15
    with pytest.raises(minirt.RenderError, match="a picture of buffers shows normals, depth, ids, uv, point, got 'x'"):
        seen.picture("x")
