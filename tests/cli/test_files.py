"""Scenes of the command line: examples, pictures that carry their scene, and standard input."""

from __future__ import annotations

import io
import json
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.cli import argument_parser
from minirt.cli.files import OPENING_PICTURE, choose_example
from minirt.formats import png
from minirt.scene import files
from minirt.scene.parser import NEW
from tests.cli.program import SCENE, Result, Run, program
from tests.cli.test_output import pixels
from tests.paths import SCENES


def test_the_program_without_arguments_renders_the_opening_scene_where_no_window_is(folder: Path) -> None:
    ended = program(folder)
    assert (ended.status, ended.err) == (0, "")
    assert str(folder / OPENING_PICTURE) in ended.out.decode()
    with pillow.open(folder / OPENING_PICTURE) as picture:
        shown = np.asarray(picture)
    width, height = shown.shape[1], 45
    strip = minirt.render(minirt.load(SCENES / "opening.rt"), samples=16, region=(0, 340, width, height)).array
    assert shown.shape == (720, 1280, 3)
    assert np.array_equal(shown[340 : 340 + height], strip)
    assert len(np.unique(strip)) > 100


def test_an_example_is_rendered_wherever_the_program_runs(run: Run, folder: Path) -> None:
    assert run("--example", "meshes", "-o", "meshes.png", "--size", "64x36").status == 0
    with pillow.open(folder / "meshes.png") as picture:
        assert np.array_equal(np.asarray(picture), minirt.render(minirt.load(SCENES / "meshes.rt"), 64, 36).array)


def test_an_unknown_example_is_an_error_that_names_what_is_like_it(run: Run) -> None:
    ended = run("--example", "galery-sea", "--check")
    assert (ended.status, ended.out) == (1, b"")
    assert "did you mean gallery-sea" in ended.err
    assert "the examples are camera-lens, demo, " in run("--example", "?", "--check").err


def test_the_window_saves_an_example_to_a_new_file(folder: Path) -> None:
    parser = argument_parser()
    for name in ("opening.rt", "opening-1.rt", "opening-2.rt"):
        options = parser.parse_args(["--example"])
        choose_example(parser, options, ["--example"])
        assert options.scene == [name]
        (folder / name).write_text("kept")


PIXEL = np.zeros((1, 1, 3), np.uint8)


def stranger(folder: Path, **texts: str) -> str:
    """Write a picture with texts of anybody; return its name."""
    named = {"scene": files.SCENE, "settings": files.SETTINGS}
    (folder / "strange.png").write_bytes(png.encode(PIXEL, {named[key]: text for key, text in texts.items()}))
    return "strange.png"


@pytest.mark.parametrize(
    "settings",
    [
        ("--size", "40x30", "--samples", "3"),
        ("--size", "41x30", "--dither", "--tone", "filmic", "--exposure", "0.7", "--left-handed"),
        ("--size", "40x30", "--samples", "auto", "--error", "0.01", "--depth", "2"),
        ("--size", "40x30", "--precision", "single"),
    ],
    ids=" ".join,
)
def test_a_picture_is_rendered_again_from_itself(run: Run, folder: Path, settings: tuple[str, ...]) -> None:
    assert run("ball.rt", "-o", "first.png", *settings).status == 0
    (folder / "ball.rt").unlink()
    assert run("first.png", "-o", "again.png").status == 0
    assert (folder / "again.png").read_bytes() == (folder / "first.png").read_bytes()
    assert run("first.png", "--check").out == b"first.png: no errors, 2 shapes, 1 light\n"
    assert len(minirt.load("first.png").shapes) == 2


def test_a_picture_shows_one_of_several_cameras_and_carries_its_number(run: Run, folder: Path) -> None:
    (folder / "two.rt").write_text(f"{SCENE}c 5,0,0 -1,0,0 50\n")
    assert run("two.rt", "-o", "first.png", "--size", "40x30", "--camera", "2").status == 0
    expected = minirt.render(minirt.load("two.rt").seen_by(2), 40, 30).array
    assert not np.array_equal(expected, minirt.render(minirt.load("two.rt"), 40, 30).array)
    assert run("first.png", "-o", "again.png").status == 0
    for name in ("first.png", "again.png"):
        assert np.array_equal(np.asarray(pillow.open(name)), expected)
    ended = run("two.rt", "--check", "--camera", "3")
    assert (ended.status, "two.rt has 2 cameras: there is no --camera 3" in ended.err) == (1, True)


def test_options_win_over_the_settings_of_a_picture(run: Run, folder: Path) -> None:
    assert run("ball.rt", "-o", "first.png", "--size", "40x30", "--samples", "3").status == 0
    assert run("first.png", "-o", "other.png", "--size", "20x10").status == 0
    assert np.array_equal(
        np.asarray(pillow.open("other.png")), minirt.render(minirt.load("ball.rt"), 20, 10, samples=3).array
    )


def test_pillow_reads_the_texts_which_can_be_left_out(run: Run) -> None:
    assert run("ball.rt", "-o", "x.png", "--size", "40x30").status == 0
    with pillow.open("x.png") as image:
        assert image.text == {"miniRT scene": SCENE, "miniRT settings": "--size 40x30"}
    assert run("ball.rt", "-o", "x.png", "--size", "40x30", "--no-metadata").status == 0
    with pillow.open("x.png") as image:
        assert image.text == {}
    ended = run("x.png", "--check")
    assert ended.status == 1
    assert ended.err.startswith("Error\nx.png: this picture carries no scene; ")


def test_a_scene_that_is_too_long_is_not_carried() -> None:
    assert not files.picture_texts("#" * (files.LONGEST_WRITTEN + 1), "")


def test_frames_of_a_turntable_carry_their_own_view(run: Run) -> None:
    assert run("ball.rt", "--turntable", "3", "-o", "x.png", "--size", "40x30").status == 0
    assert run("x-0002.png", "-o", "again.png").status == 0
    again, frame = (np.asarray(pillow.open(name)).astype(int) for name in ("again.png", "x-0002.png"))
    assert np.abs(again - frame).max() <= 1  # numbers of a saved camera have nine digits


@pytest.mark.parametrize(
    "settings",
    [
        "--size 99999x99999 --samples 0 --depth 77 --precision half",
        "--size --samples --output evil.png -o evil.png --report evil --replay evil --threads 9 --config evil",
        "--samples \u0663 --error nan --time -1 \x00 \u202e " + "--size 1x " * 1000,
    ],
)
def test_settings_of_strangers_are_left_out_where_they_are_wrong(run: Run, folder: Path, settings: str) -> None:
    name = stranger(folder, scene="R 8 6\n" + SCENE, settings=settings)
    assert run(name, "-o", "x.png").status == 0
    with pillow.open("x.png") as image:
        assert image.size == (8, 6)
    assert {path.name for path in folder.iterdir()} == {"ball.rt", name, "x.png"}


def test_a_scene_of_strangers_is_parsed_as_any_other(run: Run, folder: Path) -> None:
    ended = run(stranger(folder, scene=SCENE + "sp 0,0,0 -1 1,2,3\n"), "--check")
    assert (ended.status, ended.out) == (1, b"")
    assert ended.err.startswith("Error\nstrange.png:6:10: sphere diameter must be > 0, got -1\n")
    ended = run(stranger(folder, scene=SCENE + "#" * 70_000_000), "--check")
    assert ended == (1, b"", "Error\nstrange.png: the text in the PNG picture is larger than 65,536 KiB\n")


@pytest.mark.parametrize("at", [*range(0, 60, 7), 90])
def test_damaged_pictures_are_errors(run: Run, folder: Path, at: int) -> None:
    whole = bytearray((folder / stranger(folder, scene=SCENE)).read_bytes())
    (folder / "cut.png").write_bytes(whole[:at])
    whole[at] ^= 0x55
    (folder / "changed.png").write_bytes(whole)
    for name in ("cut.png", "changed.png"):
        ended = run(name, "--check")
        assert (ended.status, ended.out) == (1, b"")
        assert ended.err.startswith(f"Error\n{name}: ")


def test_keys_do_not_write_a_scene_over_its_picture(run: Run, folder: Path) -> None:
    assert run("ball.rt", "-o", "x.png", "--size", "40x30").status == 0
    before = (folder / "x.png").read_bytes()
    (folder / "keys.txt").write_text("press Tab\nhold d 0.3\npress Ctrl+S\n")
    ended = run("x.png", "--replay", "keys.txt")
    assert (ended.status, "not written over its picture" in ended.err) == (1, True)
    (folder / "keys.txt").write_text("press Tab\nhold d 0.3\npress Ctrl+Shift+S\n")
    assert run("x.png", "--replay", "keys.txt").status == 0
    assert (folder / "x.png").read_bytes() == before
    assert len(minirt.load("x-1.rt").shapes) == 2


@pytest.mark.parametrize("moved", [False, True])
def test_textures_are_found_from_the_picture(
    run: Run, folder: Path, monkeypatch: pytest.MonkeyPatch, moved: bool
) -> None:
    for name in ("scenes/textures", "out"):
        (folder / name).mkdir(parents=True)
    pillow.new("RGB", (2, 2), (200, 30, 30)).save(folder / "scenes" / "textures" / "red.png")
    (folder / "scenes" / "ball.rt").write_text(SCENE.replace("10,0,255", "10,0,255 texture:textures/red.png"))
    assert run("scenes/ball.rt", "-o", "out/x.png", "--size", "40x30").status == 0
    with pillow.open("out/x.png") as image:
        assert image.text["miniRT folder"] == "../scenes"
    monkeypatch.chdir(folder / "out")
    assert run("x.png", "-o", "../scenes/again.png").status == 0
    first, again = (np.asarray(pillow.open(name)) for name in ("x.png", "../scenes/again.png"))
    assert np.array_equal(first, again)
    if moved:  # to where the named folder is not: the textures may be beside the picture
        (folder / "out" / "x.png").rename(folder / "scenes" / "x.png")
        (folder / "out").rmdir()
        (folder / "scenes").rename(folder / "elsewhere")
        monkeypatch.chdir(folder)
        assert run("elsewhere/x.png", "--check").status == 0
        (folder / "elsewhere" / "textures" / "red.png").unlink()
        ended = run("elsewhere/x.png", "--check")
        assert (ended.status, "red.png" in ended.err) == (1, True)


@pytest.mark.parametrize("way", ["/etc", "nowhere", "../nowhere", "x\0y", "y" * 5000])
def test_a_strange_folder_is_left_out(folder: Path, way: str) -> None:
    texts = {files.SCENE: SCENE, files.FOLDER: way}
    (folder / "strange.png").write_bytes(png.encode(PIXEL, texts))
    assert minirt.load("strange.png").file == Path("strange.png")


@pytest.fixture
def give(monkeypatch: pytest.MonkeyPatch) -> Callable[[bytes], None]:
    """A function that sets standard input."""
    return lambda data: monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))


def test_a_scene_on_standard_input_is_rendered(run: Run, folder: Path, give: Callable[[bytes], None]) -> None:
    give(SCENE.encode())
    ended = run("-", "-o", "-", "--size", "40x30")
    assert (ended.status, ended.err) == (0, "")
    assert (pixels(ended.out) == minirt.render(minirt.load("ball.rt"), 40, 30).array).all()
    give(SCENE.encode())
    assert run("-", "-o", "{name}.png", "--size", "40x30").status == 0
    assert (folder / "stdin.png").exists()


@pytest.fixture
def piped() -> Iterator[Callable[[bytes], str]]:
    """A function that returns the name by which a shell gives data to a program: `miniRT <(...)`."""
    opened = []

    def pipe(data: bytes) -> str:
        reader, writer = os.pipe()
        os.write(writer, data)
        os.close(writer)
        opened.append(reader)
        return f"/dev/fd/{reader}"

    yield pipe
    for each in opened:
        os.close(each)


def test_streams_that_a_shell_has_opened_are_read_and_written(
    run: Run, folder: Path, piped: Callable[[bytes], str]
) -> None:
    options = "--config", piped(b'size = "40x30"')
    assert run(piped(SCENE.encode()), "-o", "a.png", *options).status == 0
    expected = minirt.render(minirt.load("ball.rt"), 40, 30).array
    assert (pixels((folder / "a.png").read_bytes()) == expected).all()
    reader, writer = os.pipe()
    assert run("ball.rt", "-o", f"/dev/fd/{writer}", "--size", "40x30").status == 0
    os.close(writer)
    with os.fdopen(reader, "rb") as written:
        assert (pixels(written.read()) == expected).all()
    assert run("ball.rt", "--replay", piped(b"press n\n"), "-o", "b.png", "--size", "40x30").status == 0
    name = piped(SCENE.encode() + b"spp\n")
    assert run(name, "--check").err.startswith(f"Error\n{name}:6:1: unknown element 'spp'")
    assert run("ball.rt", "-o", "/dev/null", "--size", "40x30", "--config", "/dev/null") == Result(0, b"", "")
    assert run("/dev/null", "--check").err == "Error\n/dev/null: is empty\n"
    assert sorted(each.name for each in folder.iterdir()) == ["a.png", "b.png", "ball.rt"]


def test_a_scene_reads_no_stream_of_the_program(run: Run, folder: Path, piped: Callable[[bytes], str]) -> None:
    name = piped(b"P3 1 1 255 1 2 3\n")
    (folder / "thief.rt").write_text(f"{SCENE}sp 0,0,9 1 9,9,9 texture:{name}\n")
    ended = run("thief.rt", "--check")
    assert (ended.status, "is not a regular file" in ended.err) == (1, True)


def test_problems_are_printed_for_editors(run: Run, folder: Path) -> None:
    (folder / "bad.rt").write_text(f"{SCENE}sp 0,0,9 -1 9,9,9\nsp 0, 0, 9 1 9,9,9\n")
    (folder / "warm.rt").write_text(f"{SCENE}sp 0,0,9 1 9,9,9 tint:1,2,3\n")
    ended = run("ball.rt", "bad.rt", "warm.rt", "none.rt", "--check", "--json")
    assert (ended.status, ended.err) == (1, "")
    ball, bad, warm, none = map(json.loads, ended.out.splitlines())
    assert ball == []
    wrong, spaced = bad
    assert wrong == {
        "file": "bad.rt",
        "line": 6,
        "column": 10,
        "length": 2,
        "severity": "error",
        "message": "sphere diameter must be > 0, got -1",
        "hint": "",
    }
    assert (spaced["line"], spaced["column"], spaced["hint"]) == (7, 5, "sp 0,0,9 1 9,9,9")
    assert [(each["line"], each["severity"]) for each in warm] == [(6, "notice")]
    assert [(each["line"], each["message"]) for each in none] == [(0, "cannot be read: no such file or directory")]


def test_names_of_files_are_cleaned_on_both_streams(run: Run, folder: Path) -> None:
    name = "a\x1b[31m\x07\r.rt"
    told = [run(name, "--check"), run(name, "--check", "--json")]
    (folder / name).write_text(SCENE)
    told += [run(name, "--check"), run(name, "-o", "a.png", "--verbose", "--size", "8x8")]
    assert [each.status for each in told] == [1, 1, 0, 0]
    for each in told:
        assert not set((each.out.decode() + each.err).replace("\n", "")) & set(map(chr, range(32)))


def test_errors_name_standard_input(run: Run, give: Callable[[bytes], None]) -> None:
    give(SCENE.encode() + b"spp 0,0,0 1 1,2,3\n")
    ended = run("-", "--check")
    assert (ended.status, ended.out) == (1, b"")
    assert ended.err.startswith("Error\nstandard input:6:1: unknown element 'spp', did you mean 'sp'?\n")
    give(b"")
    assert run("-", "--check").err == "Error\nstandard input: is empty\n"


@pytest.mark.parametrize("text", ["", "\n  \n"])
def test_an_empty_file_is_a_new_scene_for_the_window_and_an_error_for_a_picture(
    run: Run, text: str, tmp_path: Path
) -> None:
    path, keys = tmp_path / "new.rt", tmp_path / "keys.txt"
    path.write_text(text)
    assert run(str(path), "-o", str(tmp_path / "new.png")).status == 1
    keys.write_text("press N\npress Return\npress Ctrl+S\n")
    assert run(str(path), "--replay", str(keys)).status == 0
    *begun, added = minirt.load(path).elements
    assert begun == [*minirt.loads(NEW).elements]
    assert isinstance(added, minirt.Sphere)


def test_standard_input_that_is_closed_is_an_error(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    closed = io.TextIOWrapper(io.BytesIO())
    closed.close()
    monkeypatch.setattr(sys, "stdin", closed)
    with pytest.raises(ValueError, match="closed"):
        sys.stdin.buffer.read()
    ended = run("-", "--check")
    assert (ended.status, ended.err) == (1, "Error\nstandard input: cannot be read: it is closed\n")


def test_a_scene_that_shows_nothing_names_options_that_show_it(run: Run, folder: Path) -> None:
    (folder / "away.rt").write_text("A 0.2 255,255,255\nC 0,0,9 0,0.5,0 60\nsp 0,9,9 2 255,0,0\nsp 3,9,9 1 9,9,9\n")
    assert b"in view" not in run("away.rt", "--check").out
    told = run("away.rt", "--check", "--camera-as", "reversed").out.decode()
    assert "notice: nothing is in view: all is behind the eye; this line would show the scene: C " in told
    (folder / "away.rt").write_text("A 0.2 255,255,255\nC 0,0,9 0,0.5,0 60\nsp 9,0,9 2 255,0,0\nsp 9,0,8 1 9,9,9\n")
    assert "; --camera-as angles shows 2 of 2; " in run("away.rt", "--check").out.decode()
    ended = run("away.rt", "-o", "a.png", "--size", "64x36", "--camera-as", "angles", "--up", "z")
    assert "cameras are read as --camera-as angles says: C" in ended.err
    assert "in view" not in ended.err
    assert "C 0,0,9 1,0,0 60 roll:90" in pillow.open(folder / "a.png").text["miniRT scene"]


def test_the_error_of_a_file_in_a_dialect_says_what_its_lines_may_mean(run: Run, folder: Path) -> None:
    (folder / "other.rt").write_text(
        "A 0.2 255,255,255\nC 0,0,-9 0,0,1 60\nL 0,9,-9 1\nsp 0,0,0 2,5 red\nqd 1,2,3 4 5,6,7\n"
    )
    status, _, errors = run("other.rt", "-o", "a.png")
    assert status == 1
    assert errors.startswith("Error\nother.rt:4:10: sphere")
    assert errors.endswith(
        "line 4: did you mean 'sp 0,0,0 2.5 255,0,0'?\n"
        "--lenient reads this file without 1 of its shapes, and tells what it makes of it\n"
    )
    assert not (folder / "a.png").exists()
    status, _, errors = run("other.rt", "--lenient", "-o", "a.png")
    assert (status, errors.count("notice:")) == (0, 3)
    assert "shapes are missing: qd" in errors
    assert "# missing: qd 1,2,3 4 5,6,7" in pillow.open(folder / "a.png").text["miniRT scene"]
