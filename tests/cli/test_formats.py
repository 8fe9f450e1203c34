"""The program writes light, 16 bits, films and regions, and refuses what a format cannot hold before the work."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.rendering.renderer import Renderer
from tests.cli.program import SCENE, Run
from tests.cli.test_output import pixels

SIZE = ("--size", "40x30")


@pytest.fixture
def no_work(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing can be rendered."""

    def refuse(*arguments: object, **more: object) -> None:
        raise AssertionError("rendered in vain")

    monkeypatch.setattr(Renderer, "render", refuse)
    monkeypatch.setattr(Renderer, "reach", refuse)


@pytest.mark.parametrize("tone", ["plain", "filmic"])
def test_float_files_hold_exposed_light_without_tone(run: Run, folder: Path, tone: str) -> None:
    cv2 = pytest.importorskip("cv2")
    assert run("ball.rt", "-o", "x.pfm", *SIZE, "--tone", tone, "--exposure", "3").status == 0
    scene = minirt.load("ball.rt")
    light = minirt.render(scene.replace(scene.camera, exposure=3.0, tone=tone), 40, 30).linear
    found = cv2.imread("x.pfm", cv2.IMREAD_UNCHANGED)[..., ::-1]
    assert np.array_equal(found, light.astype(np.float32))
    assert found.max() > 1


def test_light_of_auto_sampling_goes_below_the_rounding_of_8_bits(run: Run, folder: Path) -> None:
    goal = ("--samples", "auto", "--error", "2e-4", "--strict")
    assert run("ball.rt", "-o", "x.exr", "--size", "160x90", *goal).status == 0
    assert run("ball.rt", "-o", "x.png", "--size", "160x90", *goal).status == 1


CANNOT = "cannot write"
NO_QUALITY = "PNG has no quality: it keeps all pixels as they are; .jpg and .webp have one"
REFUSED = {
    "-o x.webp --size 16384x4": "x.webp: WEBP holds at most 16,383 pixels a side, got 16384x4",
    "-o x.webp --size 17000x5 --cluster local": "x.webp: WEBP holds at most 16,383 pixels a side, got 17000x5",
    "-o nowhere/x.png": f"nowhere/x.png: {CANNOT}: there is no such folder",
    "-o ball.rt/x.png": f"ball.rt/x.png: {CANNOT}: Not a directory",
    "-o folder.png": "folder.png is a folder: name a picture in it, such as folder.png/picture.png",
    "-o nowhere/x.gif --turntable 3": f"nowhere/x.gif: {CANNOT}: there is no such folder",
    "-o nowhere/x.png --turntable 3": f"nowhere/x.png: {CANNOT}: there is no such folder",
    "-o nowhere/x.tif --cluster local": f"nowhere/x.tif: {CANNOT}: there is no such folder",
    "-o x.pgm": f"x.pgm: {CANNOT} pictures with the extension '.pgm': it cannot hold colours, try .png",
    "--fallback x.nope": f"x.nope: {CANNOT} pictures with the extension '.nope', try .png",
    "-o x.jpg --bits 16": "JPEG has 8 bits a channel, got 16: try PNG or TIFF",
    "-o x.png --quality 50": NO_QUALITY,
    "-o - --quality 50": NO_QUALITY,
    "-o x.exr --replay keys.txt": "x.exr: the frames of a replay have 8 bits a channel, try .png without --bits",
    "-o x.webm": "x.webm: a film needs --turntable or --replay, a picture is .png or .jpg",
    "-o x.png --size 64x48 --region 60,0,5,1": "region 60,0,5,1 does not lie in the picture of 64x48 pixels",
}


@pytest.mark.usefixtures("no_work")
@pytest.mark.parametrize("arguments", REFUSED)
def test_what_cannot_be_written_is_refused_before_the_work(run: Run, folder: Path, arguments: str) -> None:
    if "webm" in arguments:
        pytest.importorskip("av")
    (folder / "folder.png").mkdir()
    (folder / "keys.txt").write_text("wait 1\n")
    assert run("ball.rt", *arguments.split(" ")) == (1, b"", f"Error\n{REFUSED[arguments]}\n")
    assert {path.name for path in folder.iterdir()} == {"ball.rt", "folder.png", "keys.txt"}


def test_a_planted_render_is_found(run: Run, no_work: None) -> None:
    with pytest.raises(AssertionError, match="in vain"):
        run("ball.rt", "-o", "x.png")


@pytest.mark.parametrize("name", ["x.GIF", "x.mp4"])
def test_a_turntable_is_a_film(run: Run, folder: Path, name: str) -> None:
    av = pytest.importorskip("av")
    assert run("ball.rt", "--turntable", "3", "-o", name, *SIZE) == (0, b"", "")
    with av.open(name) as film:
        assert [(frame.width, frame.height) for frame in film.decode(video=0)] == [(40, 30)] * 3


def test_a_replay_can_be_a_film_of_any_format(run: Run, folder: Path) -> None:
    (folder / "keys.txt").write_text("press I\npress I\nhold d 1\nwait 0.2\n")
    assert run("ball.rt", "--replay", "keys.txt", "-o", "movie.webp", "--size", "32x18").status == 0
    with pillow.open("movie.webp") as movie:
        assert movie.n_frames > 8


def test_some_frames_of_a_turntable(run: Run, folder: Path) -> None:
    assert run("ball.rt", "--turntable", "5", "-o", "all.png", *SIZE).status == 0
    assert run("ball.rt", "--turntable", "5", "-o", "some.png", "--frames", "2-3", *SIZE).status == 0
    assert sorted(path.name for path in folder.glob("some*")) == ["some-0002.png", "some-0003.png"]
    for number in ("0002", "0003"):
        assert (folder / f"some-{number}.png").read_bytes() == (folder / f"all-{number}.png").read_bytes()
    assert run("ball.rt", "--turntable", "5", "-o", "one.gif", "--frames", "5", *SIZE).status == 0


def test_several_scenes_are_rendered_by_one_process(run: Run, folder: Path) -> None:
    (folder / "sub").mkdir()
    (folder / "sub" / "far.rt").write_text(SCENE.replace("0,0,-5", "0,0,-9"))
    (folder / "bad.rt").write_text("nonsense\n")
    (folder / "out").mkdir()
    ended = run("ball.rt", "bad.rt", "sub/far.rt", "-o", "out/{name}.png", *SIZE)
    assert (ended.status, ended.out) == (1, b"")
    assert ended.err.startswith("Error\nbad.rt:1:1: ")
    assert {path.name for path in (folder / "out").iterdir()} == {"ball.png", "far.png"}
    for scene, name in (("ball.rt", "ball"), ("sub/far.rt", "far")):
        assert np.array_equal(
            np.asarray(pillow.open(f"out/{name}.png")), minirt.render(minirt.load(scene), 40, 30).array
        )
    ended = run("ball.rt", "sub/far.rt", "--check")
    assert ended == (0, b"ball.rt: no errors, 2 shapes, 1 light\nsub/far.rt: no errors, 2 shapes, 1 light\n", "")
    ended = run("bad.rt", "ball.rt", "--check")
    assert (ended.status, ended.out) == (1, b"ball.rt: no errors, 2 shapes, 1 light\n")
    ended = run("ball.rt", "sub/../ball.rt", "-o", "out/{name}.png")
    assert (ended.status, ended.err) == (2, "Error\ntwo scenes would be written to out/ball.png\n")


REGION = ("--region", "21,8,30,17")
INSIDE = slice(8, 25), slice(21, 51)


@pytest.mark.parametrize(
    "options",
    [(), ("--samples", "3", "--tone", "filmic"), ("--dither",), ("--bits", "16"), ("--turntable", "2")],
    ids=" ".join,
)
def test_a_region_has_the_pixels_of_the_whole_picture(run: Run, folder: Path, options: tuple[str, ...]) -> None:
    for name, more in (("whole.png", ()), ("part.png", REGION)):
        assert run("ball.rt", "--size", "64x48", "-o", name, *options, *more) == (0, b"", "")
    for number in ("-0001", "-0002") if "--turntable" in options else ("",):
        part, whole = (pixels(folder / f"{name}{number}.png") for name in ("part", "whole"))
        assert np.array_equal(part, whole[INSIDE])
        assert not np.array_equal(part, whole[:17, :30])


def test_a_picture_of_a_region_carries_it(run: Run, folder: Path) -> None:
    assert run("ball.rt", "--size", "64x48", "-o", "part.png", *REGION).status == 0
    assert run("part.png", "-o", "again.png").status == 0
    assert (folder / "again.png").read_bytes() == (folder / "part.png").read_bytes()
    assert run("part.png", "--size", "32x24", "-o", "small.png").status == 0  # in which the region does not lie
    assert pixels(folder / "small.png").shape == (24, 32, 3)
    assert run("part.png", "--region", "0,0,5,6", "-o", "other.png").status == 0
    assert pixels(folder / "other.png").shape == (6, 5, 3)


def test_a_region_is_what_a_format_must_hold(run: Run, folder: Path) -> None:
    huge = "--size", "16384x16384"
    assert run("ball.rt", *huge, "--region", "16000,16000,40,30", "-o", "part.webp").status == 0
    assert pixels(folder / "part.webp").shape == (30, 40, 3)
    assert "16,383 pixels a side" in run("ball.rt", *huge, "--region", "0,0,16384,1", "-o", "part.webp").err
