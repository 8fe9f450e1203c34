"""The program writes pictures in the right format and size, as a whole or not at all."""

from __future__ import annotations

import io
import os
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.cli import main
from tests.cli.program import SCENE, Run


def pixels(data: bytes | Path) -> np.ndarray:
    """Return the RGB pixels of a picture file or of its bytes."""
    with Image.open(io.BytesIO(data) if isinstance(data, bytes) else data) as image:
        return np.asarray(image.convert("RGB"))


def rendered(width: int, height: int, samples: int = 1) -> np.ndarray:
    """Return the pixels of ball.rt, rendered by the library."""
    return minirt.render(minirt.load("ball.rt"), width, height, samples=samples).array


def test_standard_output_gets_a_png_of_the_size_and_samples_of_the_options(run: Run) -> None:
    for samples in (1, 9):
        ended = run("ball.rt", "-o", "-", "--size", "20x10", "--samples", str(samples))
        assert (ended.status, ended.err) == (0, "")
        assert ended.out.startswith(b"\x89PNG\r\n")
        assert np.array_equal(pixels(ended.out), rendered(20, 10, samples))
    assert not np.array_equal(pixels(ended.out), rendered(20, 10))


@pytest.mark.parametrize("goal", [("--error", "0.01"), ("--time", "0.1"), ("--error", "0.01", "--time", "5"), ()])
def test_auto_samples_reach_the_error_or_fill_the_time(run: Run, goal: tuple[str, ...]) -> None:
    ended = run("ball.rt", "-o", "-", "--size", "80x60", "--samples", "auto", *goal)
    assert ended.status == 0
    match = re.fullmatch(
        r"([0-9.]+) samples a pixel on average, ([0-9]+) at most; "
        r"estimated error ([0-9.e-]+), ([0-9.e-]+) when rounded to 8 bits; ([0-9.]+) s\n"
        r"(notice: no more samples: .*\n)?",
        ended.err,
    )
    assert match
    mean, most, error, of_bytes, _ = map(float, match.groups()[:5])
    assert 1 <= mean <= most
    assert of_bytes >= error
    assert error <= (0.01 if "--error" in goal else 0.0021 if not goal else 1)
    if "--time" not in goal:
        goals = {"error": float(goal[1])} if goal else {}
        image = minirt.render(minirt.load("ball.rt"), 80, 60, samples="auto", **goals)
        assert np.array_equal(pixels(ended.out), image.array)


@pytest.mark.parametrize(("strict", "status"), [((), 0), (("--strict",), 1)])
def test_an_error_that_rounding_hides_is_not_reached_and_that_is_said(
    run: Run, strict: tuple[str, ...], status: int
) -> None:
    ended = run("ball.rt", "-o", "x.png", "--size", "80x60", "--samples", "auto", "--error", "1e-5", *strict)
    assert ended.status == status
    assert ended.err.splitlines()[1] == "notice: no more samples: rounding to 8 bits decides below an error of 0.00057"


def test_a_time_that_ends_before_the_error_is_said(run: Run) -> None:
    goals = ("--error", "0.0007", "--time", "1e-6")
    ended = run("ball.rt", "-o", "x.png", "--size", "80x60", "--samples", "auto", *goals, "--strict")
    assert (ended.status, ended.err.splitlines()[1]) == (1, "notice: error 0.0007 not reached: the time was over")


def test_the_scene_may_set_the_size(run: Run, folder: Path) -> None:
    (folder / "sized.rt").write_text("R 33 21\n" + SCENE)
    assert pixels(run("sized.rt", "-o", "-").out).shape == (21, 33, 3)
    assert pixels(run("sized.rt", "-o", "-", "--size", "7x5").out).shape == (5, 7, 3)
    assert pixels(run("ball.rt", "-o", "-").out).shape == (720, 1280, 3)


def test_verbose_prints_durations_and_features(run: Run) -> None:
    minirt.renderer(1).specialise(minirt.load("ball.rt"))  # else a generic kernel may draw
    ended = run("ball.rt", "-o", "x.png", "--size", "8x6", "--samples", "2", "--threads", "1", "-v")
    assert (ended.status, ended.out) == (0, b"")
    ready, duration, finite, *rest = ended.err.splitlines()
    assert re.fullmatch(r"kernel ready after [0-9.]+ s", ready)
    assert re.fullmatch(r"8x6, 2 samples a pixel, 1 thread, double precision: [0-9.]+ ms", duration)
    assert finite == "rays whose light is not finite: 0"
    assert rest[0] == "kernel for spheres, planes"
    assert rest[1].startswith("kernel without cylinders")


def test_verbose_prints_the_samples_of_auto_only_once(run: Run) -> None:
    ended = run("ball.rt", "-o", "x.png", "--size", "40x30", "--samples", "auto", "--error", "0.1", "-v")
    _, duration, finite, *_, reached = ended.err.splitlines()
    assert reached.startswith("1.0 samples a pixel on average, 1 at most; ")
    assert re.fullmatch(r"40x30, [0-9]+ threads, double precision: [0-9.]+ ms", duration)
    assert finite == "rays whose light is not finite: 0"


def test_tone_exposure_and_dithering_are_options(run: Run, folder: Path) -> None:
    plain = pixels(run("ball.rt", "-o", "-", "--size", "80x60").out)
    assert np.array_equal(
        pixels(run("ball.rt", "-o", "-", "--size", "80x60", "--tone", "plain", "--exposure", "0").out), plain
    )
    (folder / "toned.rt").write_text(SCENE.replace("0,0,1 70", "0,0,1 70 tone:filmic exposure:-1.5"))
    asked = pixels(run("ball.rt", "-o", "-", "--size", "80x60", "--tone", "filmic", "--exposure", "-1.5").out)
    assert np.array_equal(asked, pixels(run("toned.rt", "-o", "-", "--size", "80x60").out))
    assert not np.array_equal(asked, plain)
    back = pixels(run("toned.rt", "-o", "-", "--size", "80x60", "--tone", "plain", "--exposure", "0").out)
    assert np.array_equal(back, plain)
    dithered = pixels(run("ball.rt", "-o", "-", "--size", "80x60", "--dither").out).astype(int)
    assert 0 < np.abs(dithered - plain).max() <= 1
    assert abs((dithered - plain).mean()) < 0.02
    assert run("ball.rt", "-o", "still.png", "--size", "80x60", "--dither").status == 0
    assert run("ball.rt", "-o", "turn.png", "--turntable", "2", "--size", "80x60", "--dither").status == 0
    assert (folder / "turn-0001.png").read_bytes() == (folder / "still.png").read_bytes()


@pytest.mark.parametrize(("exposure", "tone"), [("0", "plain"), ("2", "plain"), ("2", "filmic")])
def test_verbose_counts_clipped_pixels(run: Run, exposure: str, tone: str) -> None:
    ended = run("ball.rt", "-o", "x.png", "--size", "40x30", "-v", "--exposure", exposure, "--tone", tone)
    *_, line = ended.err.splitlines()
    scene = minirt.load("ball.rt")
    light = minirt.render(scene.replace(scene.camera, exposure=float(exposure), tone=tone), 40, 30).linear
    count = (light.max(axis=-1) > (7.2417 if tone == "filmic" else 1)).sum()
    assert (count > 0) == ((exposure, tone) == ("2", "plain"))
    assert line.startswith(f"clipped pixels, brighter than the picture can show: {count} of 1200 (")


def test_a_notice_names_shapes_that_single_precision_cannot_show(run: Run, folder: Path) -> None:
    (folder / "huge.rt").write_text("A 0.2 255,255,255\nC 0,1.7,0 0,0,1 60\nsp 0,-5e8,0 1e9 9,9,9\nsp 0,2,9 1 9,9,9\n")
    for precision, count in (("double", 0), ("single", 1)):
        ended = run("huge.rt", "-o", "x.png", "--size", "8x6", "--precision", precision)
        notices = [line for line in ended.err.splitlines() if line.startswith("notice: single precision cannot show ")]
        assert len(notices) == count
        assert all("show sphere 1: the eye is close to it for its size (size 1e+09, " in line for line in notices)


def test_without_a_display_the_fallback_file_is_rendered(
    run: Run, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from minirt.errors import MlxError
    from minirt.viewer.app import desktop

    def no_window(*arguments: object, **more: object) -> int:
        raise MlxError("no display")

    monkeypatch.setattr(desktop, "run", no_window)
    assert run("ball.rt") == (1, b"", "Error\nno display\n-o FILE renders a picture without one\n")
    ended = run("ball.rt", "--fallback", "x.png", "--size", "8x6")
    assert (ended.status, ended.err) == (0, "")
    assert np.array_equal(pixels(folder / "x.png"), rendered(8, 6, samples=16))
    assert os.fspath(folder / "x.png").encode() in ended.out


@pytest.mark.parametrize("samples", [(), ("--samples", "1"), ("--samples", "6")])
def test_the_last_frame_of_a_replay_is_the_rendered_picture(run: Run, folder: Path, samples: tuple[str, ...]) -> None:
    (folder / "keys.txt").write_text("press I\npress I\nhold d 0.2\npress Home\n")
    ended = run("ball.rt", "--replay", "keys.txt", "--size", "40x30", *samples, "-o", "-")
    assert (ended.status, ended.err) == (0, "")
    assert np.array_equal(pixels(ended.out), rendered(40, 30, int(samples[1]) if samples else 1))


def test_a_precision_that_was_asked_for_holds_in_the_window_while_something_moves(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    from minirt.viewer.app import desktop

    passed: list[bool] = []
    monkeypatch.setattr(desktop, "run", lambda *_, renderer, **more: passed.append(renderer.moves_in_single) or 0)
    for options in ([], ["--precision", "double"], ["--precision=single"], []):
        run("ball.rt", *options)
    assert passed == [True, False, False, True]


def test_the_default_samples_of_the_window_are_more_than_of_a_file(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    from minirt.viewer.app import desktop

    passed: list[object] = []
    monkeypatch.setattr(desktop, "run", lambda *_, samples, **more: passed.append(samples) or 0)
    run("ball.rt")
    run("ball.rt", "--samples", "1")
    run("ball.rt", "--samples", "64")
    assert passed == [16, 1, 64]


def test_a_replay_uses_the_keyboard_layout_of_the_options(tmp_path: Path) -> None:
    scene, keys = tmp_path / "scene.rt", tmp_path / "keys.txt"
    scene.write_text("A 0.5 255,255,255\nC 0,0,0 0,0,1 70\nsp 1,0,9 4 200,30,30\n")
    pictures = []
    for layout, pressed in (("qwerty", "a"), ("azerty", "q"), ("azerty", "a")):
        keys.write_text(f"hold {pressed} 0.5\n")
        out = tmp_path / f"{layout}-{pressed}.png"
        assert main([str(scene), "--replay", str(keys), "--keys", layout, "--size", "48x32", "-o", str(out)]) == 0
        pictures.append(pixels(out))
    left_qwerty, left_azerty, down_azerty = pictures
    assert (left_qwerty == left_azerty).all()
    assert (left_qwerty != down_azerty).any()


def test_recorded_keys_are_read_from_regular_files_alone(run: Run, folder: Path) -> None:
    os.mkfifo(folder / "fifo")
    for name in ("fifo", "."):
        ended = run("ball.rt", "--replay", name, "--size", "40x30")
        assert (ended.status, ended.err.split("\n")[0]) == (1, "Error")
        assert f"{name}: is" in ended.err
