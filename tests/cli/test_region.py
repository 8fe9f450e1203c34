"""The program renders a rectangle of a picture: `--region`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from tests.cli.program import Result

Run = Callable[..., Result]
REGION = ("--region", "21,8,30,17")
INSIDE = slice(8, 25), slice(21, 51)


def pixels(folder: Path, name: str) -> np.ndarray:
    """The pixels of a picture in a folder."""
    with pillow.open(folder / name) as image:
        return np.asarray(image.convert("RGB"))


@pytest.mark.parametrize(
    "options",
    [(), ("--samples", "3", "--tone", "filmic"), ("--dither",), ("--bits", "16")],
    ids=" ".join,
)
def test_a_region_has_the_pixels_of_the_whole_picture(run: Run, folder: Path, options: tuple[str, ...]) -> None:
    for name, more in (("whole.png", ()), ("part.png", REGION)):
        assert run("ball.rt", "--size", "64x48", "-o", name, *options, *more) == (0, b"", "")
    assert np.array_equal(pixels(folder, "part.png"), pixels(folder, "whole.png")[INSIDE])
    assert not np.array_equal(pixels(folder, "part.png"), pixels(folder, "whole.png")[:17, :30])


def test_a_film_has_a_region_of_each_frame(run: Run, folder: Path) -> None:
    for name, more in (("whole.png", ()), ("part.png", REGION)):
        assert run("ball.rt", "--size", "64x48", "--turntable", "2", "-o", name, *more).status == 0
    for number in ("0001", "0002"):
        assert np.array_equal(pixels(folder, f"part-{number}.png"), pixels(folder, f"whole-{number}.png")[INSIDE])


def test_a_picture_of_a_region_carries_it(run: Run, folder: Path) -> None:
    assert run("ball.rt", "--size", "64x48", "-o", "part.png", *REGION).status == 0
    assert run("part.png", "-o", "again.png").status == 0
    assert (folder / "again.png").read_bytes() == (folder / "part.png").read_bytes()
    assert run("part.png", "--size", "32x24", "-o", "small.png").status == 0  # in which the region does not lie
    assert pixels(folder, "small.png").shape == (24, 32, 3)
    assert run("part.png", "--region", "0,0,5,6", "-o", "other.png").status == 0
    assert pixels(folder, "other.png").shape == (6, 5, 3)


def test_a_region_is_what_a_format_must_hold(run: Run, folder: Path) -> None:
    huge = "--size", "16384x16384"
    assert run("ball.rt", *huge, "--region", "16000,16000,40,30", "-o", "part.webp").status == 0
    assert pixels(folder, "part.webp").shape == (30, 40, 3)
    assert "16,383 pixels a side" in run("ball.rt", *huge, "--region", "0,0,16384,1", "-o", "part.webp").err


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (("--region", "60,0,5,1", "-o", "x.png"), 1, "region 60,0,5,1 does not lie in the picture of 64x48 pixels"),
        (("--region", "1,2,3", "-o", "x.png"), 2, "argument --region: must be X,Y,WIDTH,HEIGHT, like 320,0,640,480"),
        (("--region", "0,0,0,5", "-o", "x.png"), 2, "argument --region: must be a whole number from 1 to 16384"),
        (("--region", "0,0,5,5"), 2, "--region needs -o"),
        (("--region", "0,0,5,5", "--replay", "x", "-o", "x.gif"), 2, "--region needs -o, and no --replay"),
    ],
)
def test_wrong_regions_are_refused(
    run: Run, folder: Path, arguments: tuple[str, ...], status: int, message: str
) -> None:
    ended = run("ball.rt", "--size", "64x48", *arguments)
    assert (ended.status, ended.out) == (status, b"")
    assert message in ended.err
    assert not (folder / "x.png").exists()
