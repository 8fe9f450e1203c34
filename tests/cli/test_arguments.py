"""Arguments of the program give the right exit statuses and messages."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.cli import arguments
from minirt.kernel.shading import whitted
from minirt.rendering.packing import features
from tests.cli.program import SCENE, Result, Run
from tests.paths import ROOT
from tests.simulated_clock import PACKET_SECONDS, packets, simulate_clock

NO_VALUE = "must be followed by a value; miniRT --help tells which"
VALUES = (  # an option, what is said of a wrong value, and such values
    ("--size", "must be WIDTHxHEIGHT, like 640x480, got '%s'", "640 x 640x x480 4x4x4 4.5x4 \uff14x4 1_0x4"),
    ("--size", "must be a whole number from 1 to 999999999, got '0'", "0x4 4x0"),
    ("--size", "must be a whole number from 1 to 16384, got '16385'; see --cluster", "16385x4 4x16385"),
    ("--size", "must be a whole number from 1 to 999999999, got '99999999999'", "99999999999x4"),
    ("--size", NO_VALUE, "-4x4"),
    ("--samples", "must be a whole number from 1 to 65536, or auto, got '%s'", "0 -1 x 1.5 65537 \u00b2"),
    ("--error", "must be a number > 0, got '%s'", "0 -1 x nan inf 1_0"),
    ("--time", "must be a number > 0, got '%s'", "0"),
    ("--exposure", "must be a number from -20 to 20, got '%s'", "x nan inf 20.1 -21 1_0"),
    ("--depth", "must be a whole number from 0 to 32, got '%s'", "33 x"),
    ("--threads", "must be a whole number from 1 to 1024, got '%s'", "0"),
    ("--quality", "must be a whole number from 1 to 100, got '%s'", "0 101"),
    ("--turntable", "must be a whole number from 1 to 3600, got '%s'", "0"),
    ("--frames", "must be FIRST-LAST, like 10-20, got '%s'", "3-2 x"),
    ("--region", "must be X,Y,WIDTH,HEIGHT, like 320,0,640,480, got '%s'", "1,2,3"),
    ("--region", "must be a whole number from 1 to 16384, got '0'", "0,0,0,5"),
    ("--explain", "must be X,Y, like 320,240, got '%s'", "1 1,2,3 1,-2"),
    ("--buffers", "must be normals, depth, ids, uv or point, got '%s'", "colours"),
    ("--cluster", "must be local, or the address of a scheduler like tcp://host:8786, got '%s'", "here"),
    (
        "--memory",
        "must be an amount of memory from 1M to 1024T, like 512M or 4G, got '%s'",
        "1.5k G 1,5G 1K \u0663G 99999999999999999G 4X nan 1e9 B",
    ),
    ("--tone", "must be plain, srgb or filmic, got '%s', did you mean 'srgb'?", "sgrb"),
    ("--tone", "must be plain, srgb or filmic, got '%s'", "gamma"),
    ("--keys", "must be auto, qwerty, azerty or qwertz, got '%s'", "dvorak"),
    ("--precision", "must be double or single, got '%s'", "half"),
    ("--bits", "must be 8 or 16, got '%s'", "12"),
)
RESUME = "--resume needs the name of a file: -o spin.gif, and no --replay or --samples auto"
ONE_PICTURE = "--samples auto makes one picture: it needs -o, and no --replay or --turntable"
TOGETHER = {  # arguments that do not go together, behind the name of a scene
    "--sampels 4": "unknown option --sampels, did you mean '--samples'?",
    "--wdth=4": "unknown option --wdth, did you mean '--watch'?",
    **{
        f"{word} 4": f"unknown option {word}, did you mean '{meant}'?"
        for meant, words in {
            "--size": "--width --height -w --resolution",
            "-o": "--save --output-file --outfile",
            "--samples": "--spp --samp --sa",  # the last two are abbreviations
            "--turntable": "--tu --film",
            "--left-handed": "--left",
            "--example list": "--list-examples",
            "SCENE.rt": "--input",
        }.items()
        for word in words.split()
    },
    "--zzz": "unknown option --zzz; miniRT --help lists all",
    "-o": f"argument -o/--output: {NO_VALUE}",
    **{f"{each} ": f"argument {each}: must be the name of a file, got ''" for each in ("--fallback", "--replay")},
    "-o ": "argument -o/--output: must be the name of a file, got ''",
    "--report ": "argument --report: must be the name of a file, got ''",
    "": "argument SCENE.rt: must be the name of a file, got ''",
    "--exposure ": "argument --exposure: must be a number from -20 to 20, got ''",
    "-o x.png --error 0.01": "--error and --time need --samples auto",
    "-o x.png --samples 4 --time 1": "--error and --time need --samples auto",
    "-o x.png --samples auto --strict": "--strict needs --error",
    "--samples auto": ONE_PICTURE,
    "-o x.png --samples auto --replay keys.txt": ONE_PICTURE,
    "-o x.gif --samples auto --turntable 3": ONE_PICTURE,
    "--turntable 3": "--turntable needs the name of a file: -o spin.gif",
    "--turntable 3 -o -": "--turntable needs the name of a file: -o spin.gif",
    "-o x.gif --turntable 5 --frames 4-6": "--frames: --turntable makes 5 pictures, got 6",
    "-o x.gif --turntable 1 --frames 2": "--frames: --turntable makes 1 picture, got 2",
    "-o x.png --frames 1-2": "--frames needs --turntable",
    "--region 0,0,5,5": "--region has no effect without -o",
    "-o x.gif --region 0,0,5,5 --replay keys.txt": "--region has no effect without -o",
    "--resume": RESUME,
    "-o - --resume": RESUME,
    "-o x.png --resume --samples auto": RESUME,
    "-o x.gif --resume --replay keys.txt": RESUME,
    "--cluster local": "--cluster has no effect without -o",
    "-o x.png --cluster local --samples auto --time 1": "--cluster has no effect with --time",
    "-o x.png --json": "--json has no effect without --check or --bench or --explain or --compare",
    **{f"-o x.png {each}": f"{each} has no effect without --report" for each in ("--quick", "--ablation")},
    "-o x.png --against x.json": "--against has no effect without --report",
    **{f"-o x.png --{each}": f"-o does not go with --{each}" for each in ("check", "bench")},
    "-o x.png --report x": "-o does not go with --report",
    "--buffers depth": "--buffers needs the name of a file: -o normals.png",
    "--buffers depth -o x.png --samples 4": "--samples has no effect with --buffers",
    "--buffers ids -o x.png --turntable 4": "--turntable has no effect without -o",
    "--explain 1,2 -o x.png": "-o does not go with --explain",
    "--explain 1,2 --buffers ids -o x.png": "-o does not go with --explain",
    "--check --bench": "--bench does not go with --check",
    "--report x --keys azerty": "--keys has no effect with --report",
    "--no-watch --check": "--no-watch has no effect with --check",
    "--example": "--example shows a scene of its own, got ball.rt, too",
    "ball.rt": "expected one scene file, got 2: ball.rt ball.rt",
    "x.png": "expected one scene file, got 2: ball.rt x.png; did you mean -o x.png?",
    "ball.rt -o x.png": "expected one scene file, got 2: ball.rt ball.rt; several need -o with {name}, such as -o "
    "out/{name}.png",
    **dict.fromkeys(("-", "- - --check"), "- is a stream, which is read once: it needs -o, --explain or --check"),
}
WRONG = {
    f"{name} {each}": f"argument {name}: {told % each if '%' in told else told}"
    for name, told, values in VALUES
    for each in values.split()
} | TOGETHER
BAD_SCENES = {
    "no-camera.rt": SCENE.replace("C 0,0,-5 0,0,1 70\n", ""),
    "no-ambient.rt": SCENE.replace("A 0.2 255,255,255\n", ""),
    "two-cameras.rt": SCENE + "C 0,0,-5 0,0,1 70\n",
    "unknown.rt": SCENE + "spp 0,0,20 12.6 10,0,255\n",
    "colour.rt": SCENE + "sp 0,0,20 3 10,0,256\n",
    "empty.rt": "",
    "blank.rt": " \n\n",
    "binary.rt": "\0\1\2",
    "name.txt": SCENE,
    ".rt": SCENE,
}


def assert_refused(ended: Result, folder: Path, status: int = 1) -> None:
    """Check the status, that standard error begins with `Error`, and that nothing else is printed or written."""
    assert ended.status == status
    assert ended.out == b""
    lines = ended.err.split("\n")
    assert lines[0] == "Error"
    assert lines[1].strip()
    assert not [path for path in folder.iterdir() if path.suffix in (".png", ".tmp")]


@pytest.mark.parametrize("arguments", WRONG)
def test_wrong_arguments_are_refused_in_one_sentence(run: Run, folder: Path, arguments: str) -> None:
    ended = run("ball.rt", *arguments.split(" "))
    assert ended == (2, b"", f"Error\n{WRONG[arguments]}\n")
    assert [each.name for each in folder.iterdir()] == ["ball.rt"]


@pytest.mark.parametrize("arguments", [("-o", "x.png"), ("--check",)])
def test_without_a_scene_nothing_is_done(run: Run, folder: Path, arguments: tuple[str, ...]) -> None:
    assert run(*arguments) == (2, b"", "Error\nexpected a scene file, such as scene.rt, or --example\n")


MODES = ["-o", "x.png"], ["--check"], []
# A window opens an empty file as a new scene, and a dialect as a lenient reader reads it.
REFUSED = [(name, mode) for name, text in BAD_SCENES.items() for mode in MODES if mode or text.strip()]


@pytest.mark.parametrize(("name", "mode"), REFUSED)
def test_a_wrong_scene_is_an_error_in_every_mode(run: Run, folder: Path, name: str, mode: list[str]) -> None:
    (folder / name).write_text(BAD_SCENES[name])
    ended = run(name, *mode)
    if mode or name != "unknown.rt":
        assert_refused(ended, folder)
    assert name not in ("no-ambient.rt", "two-cameras.rt", "colour.rt") or "--lenient reads this file, and" in ended.err
    assert ended.err.split("\n")[1].startswith(f"{name}:")


@pytest.mark.parametrize("name", ["missing.rt", "folder.rt", "missing.png", "folder.png"])
def test_a_scene_that_is_no_file_is_an_error(run: Run, folder: Path, name: str) -> None:
    if name.startswith("folder"):
        (folder / name).mkdir()
    ended = run(name, "--check")
    assert (ended.status, ended.out) == (1, b"")
    assert ended.err.startswith(f"Error\n{name}: ")


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("new.rt", ["--check"]),
        ("new.rt", ["-o", "x.png"]),
        ("new.rt", ["--replay", "ball.rt"]),
        ("new.rt", ["--fallback", "x.png"]),
        ("none/new.rt", []),
        ("ball.rt/new.rt", []),
        ("new.txt", []),
        ("n" * 300 + ".rt", []),
    ],
)
def test_a_scene_that_is_not_there_is_new_only_in_a_window_and_where_it_can_be_written(
    run: Run, folder: Path, name: str, options: list[str]
) -> None:
    ended = run(name, *options)
    assert_refused(ended, folder)
    assert ended.err.split("\n")[1].startswith(f"{name}: ")


def test_an_error_names_file_line_and_column_and_shows_the_line(run: Run, folder: Path) -> None:
    (folder / "bad.rt").write_text(SCENE + "sp 0,0,20 -3 10,0,255\nspp 0,0,0 1 1,2,3\n")
    lines = run("bad.rt", "-o", "x.png").err.split("\n")
    assert lines == [
        "Error",
        "bad.rt:6:11: sphere diameter must be > 0, got -3",
        "    sp 0,0,20 -3 10,0,255",
        "              ^~",
        "bad.rt:7:1: unknown element 'spp', did you mean 'sp'?",
        "    spp 0,0,0 1 1,2,3",
        "    ^~~",
        "line 7: did you mean 'sp 0,0,0 1 1,2,3'?",
        "--lenient reads this file without 2 of its shapes, and tells what it makes of it",
        "",
    ]


def test_the_configuration_file_may_have_options_without_effect(run: Run, folder: Path) -> None:
    (folder / "miniRT.toml").write_text('size = "8x6"\nwatch = false\nquality = 50\n')
    told = (0, b"ball.rt: no errors, 2 shapes, 1 light\n", "")
    assert run("ball.rt", "--check", "--config", "miniRT.toml") == told
    assert run("ball.rt", "--check", "--config", "miniRT.toml", "--quality", "51").status == 2


def test_the_example_of_the_subject_is_read_and_a_camera_that_shows_it_is_named(run: Run, folder: Path) -> None:
    path = str(ROOT / "scenes" / "subject-as-printed.rt")
    ended = run(path, "--check")
    assert ended.status == 0
    found, told = ended.out.splitlines()
    assert found.endswith(b"no errors, 3 shapes, 1 light")
    assert told.startswith(b"notice: nothing is in view; this line would show the scene: C ")
    assert ended.err.startswith("notice: ")
    ended = run(path, "-o", "printed.png", "--size", "32x18")
    assert ended.status == 0
    *_, notice = ended.err.splitlines()
    assert notice.startswith("notice: the eye is in plane 1; this line would show the scene: C ")
    camera = notice[notice.index("C ") :]
    lines = [line for line in Path(path).read_text().splitlines() if not line.startswith("C ")]
    (folder / "shown.rt").write_text("\n".join([*lines, camera]))
    assert run("shown.rt", "-o", "shown.png", "--size", "64x36") == (0, b"", "")
    shown = np.asarray(pillow.open(folder / "shown.png")).reshape(-1, 3)
    for channels in ([1, 0, 0], [0, 0, 1], [1, 0, 1]):  # the sphere, the cylinder, the plane
        assert ((shown > 0) >= channels).all(axis=1).any()


def test_bench_prints_its_measurements(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a simulated clock a packet of rays takes a millisecond."""
    clock = simulate_clock(monkeypatch)
    clock.slowness = 1e-3 / PACKET_SECONDS
    ended = run("ball.rt", "--bench", "--json", "--size", "16x9", "--threads", "2")
    assert (ended.status, ended.err) == (0, "")
    frame = packets(16, 9)
    assert json.loads(ended.out) == {
        "scene": "ball.rt",
        "size": "16x9",
        "threads": 2,
        "precision": "double",
        "frames": -(-1000 // frame),  # frames that fill a second
        "ms_min": frame,
        "ms_median": frame,
        "ms_min_moving": frame,
        "ms_median_moving": frame,
        "compile_s": 0.001,  # a picture of one pixel
        "load_s": 0.0,
    }
    text = run("ball.rt", "--bench", "--size", "16x9", "--threads", "2").out.decode()
    assert text.startswith("scene ball.rt, size 16x9, threads 2, precision double, frames ")


def test_version_is_printed(run: Run) -> None:
    assert run("--version") == (0, f"miniRT {minirt.__version__}\n".encode(), "")


@pytest.mark.parametrize(("option", "lines"), [("--help", 80), ("--list-keys", 10)])
def test_texts_need_no_scene(run: Run, option: str, lines: int) -> None:
    ended = run(option)
    assert (ended.status, ended.err) == (0, "")
    assert len(ended.out.splitlines()) > lines


def test_the_keys_are_listed_in_the_language_of_the_user(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANGUAGE", "fr")
    text = run("--list-keys").out.decode()
    assert "sélectionner l'élément suivant" in text
    assert "select the next element" not in text


def test_depth_limits_the_reflections(run: Run, folder: Path) -> None:
    assert arguments.MAX_DEPTH == whitted.MAX_DEPTH
    for default in (f"pixel ({arguments.SAMPLES})", f"moves ({arguments.WINDOW_SAMPLES})", f"ray ({features.DEPTH})"):
        assert default in arguments.OPTIONS
    mirror = "A 1 255,255,255\nC 0,0,-5 0,0,1 60\nbg 0,0,255\npl 0,0,0 0,0,-1 255,0,0 mirror:1\n"
    (folder / "mirror.rt").write_text(mirror)
    for depth, colour in (("0", [255, 0, 0]), ("1", [0, 0, 255])):
        assert run("mirror.rt", "-o", "x.png", "--size", "4x4", "--depth", depth).status == 0
        assert np.asarray(pillow.open(folder / "x.png"))[0, 0].tolist() == colour
