"""Lines of other programs' dialects, which a lenient reader translates, and says so once for each sort of change."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from PIL import Image

from minirt.errors import SceneError
from minirt.fields.directions import SCALED
from minirt.rendering.packing.camera import camera_frame
from minirt.scene import dialect_tables as dialects
from minirt.scene import dump, load, loads, parse
from tests.paths import ROOT
from tests.scene.examples import AMBIENT, CAMERA, PLANE, SPHERE, scene_with

BALL = "sp 0,0,20 12.6 10,0,255"
FLOOR = "pl 0,-1,0 0,1,0 200,200,200"

# A line, the line of the format that it means, and the sorts of changes.
CASES = [
    (f"{BALL} 0", BALL, [dialects.LEFT_OUT]),
    (f"{BALL} 1 1", BALL, [dialects.LEFT_OUT]),
    (f"{BALL} 100", f"{BALL} specular:0.5,100", [dialects.EXPONENT]),
    (f"{BALL} 100 0.25", f"{BALL} specular:0.5,100 mirror:0.25", [dialects.EXPONENT]),
    (f"{BALL} 0.25 100", f"{BALL} specular:0.25,100", [dialects.EXPONENT]),
    (f"{BALL} 0.25", f"{BALL} mirror:0.25", [dialects.REFLECTIVITY]),
    (f"{BALL} 1 2 3 4", BALL, [dialects.LEFT_OUT]),
    (f"{BALL} sh 400 re 0.3", f"{BALL} specular:0.5,400 mirror:0.3", [dialects.HIGHLIGHTS]),
    (f"{BALL} trans:0.75 ior:1.5", f"{BALL} glass:1.5,0.75", [dialects.GLASS]),
    (f"{BALL} glass=1.5,0.75", f"{BALL} glass:1.5,0.75", []),
    ("sp 0,0,20 12.6 5", "sp 0,0,20 12.6 255,255,255", [dialects.WHITE, dialects.LEFT_OUT]),
    ("| SPHERE | x", "", [dialects.SETTINGS]),
    ("f 1/1 2/2 3/3", "", [dialects.MISSING]),
    ("pl# 0,0,0 0,1,0 9,8,7", "", [dialects.INCOMPLETE]),
    (f"{BALL} specular=0.3", f"{BALL} specular:0.3,32", [dialects.HIGHLIGHTS]),
    (f"{BALL} checkerboard", f"{BALL} checker", [dialects.CHECKERS]),
    (f"{FLOOR} ch 9,8,7", f"{FLOOR} checker:1,9,8,7", [dialects.CHECKERS]),
    (f"{FLOOR} cd:1,2,3:4,5,6:0.5", f"{FLOOR} checker:0.5,4,5,6", [dialects.TWO_COLOURS]),
    (f"{BALL} there.xpm there_bump.png", f"{BALL} texture:there.xpm bump:there_bump.png", [dialects.PICTURES]),
    (
        f"{BALL} ch 9,8,7 usual.png",
        f"{BALL} checker:0.125,9,8,7 texture:usual.png",
        [dialects.CHECKERS, dialects.PICTURES],
    ),
    (f'{BALL} -t "there.xpm"', f"{BALL} texture:there.xpm", [dialects.PICTURES]),
    (f"{BALL} tx:absent.xpm", BALL, [dialects.ABSENT]),
    (f"{BALL} mat:metal:0.2 BNS:0;1", BALL, [dialects.LEFT_OUT]),
    (f"{BALL} mirror:0.2 twist:9", f"{BALL} mirror:0.2", [dialects.LEFT_OUT]),
    ("sp 0,0,20 12.6 red", "sp 0,0,20 12.6 255,0,0", [dialects.NAMED]),
    ("sp 0,0,20 12.6 #0A00ff # not #fff", f"{BALL} # not #fff", [dialects.NAMED]),
    ("sp 0,0,20 12.6 shiny", "sp 0,0,20 12.6 9,8,7", [dialects.NAMED]),
    ("sp 0,0,20 12.6", "sp 0,0,20 12.6 255,255,255", [dialects.WHITE]),
    ("sp 0,0,20 12.6 rb matte 10,0,255", BALL, [dialects.LEFT_OUT]),
    ("sp 0,0,20 12,6 10,0,255", BALL, [dialects.DECIMALS]),
    ("sp 0,0,20 12.6 10.4,-0.6,300", BALL, [dialects.NEAREST]),
    ("sp 0,0,20 12.6 10.4,0,254.5e0", BALL, [dialects.NEAREST]),
    ("sp 0,0,20 12.6 10,0,255,0", BALL, [dialects.FOURTH]),
    ("sp 0,0,20,1 12.6 10,0,255", BALL, [dialects.FOURTH]),
    ("pl 0,-1,0 0,1,0,1 200,200,200", FLOOR, [dialects.FOURTH]),
    ("pl 0,-1,0 0,0,0 200,200,200", FLOOR, [dialects.NOWHERE]),
    ("pl 0,-1,0 0,0,0,0 200,200,200", FLOOR, [dialects.NOWHERE]),
    ("dl 0,0,0 1", "dl 0,-1,0 1", [dialects.NOWHERE]),
    ("sp 0, 0, 20 12.6 10,0,255", BALL, [dialects.JOINED]),
    ("sp 0 ,0\t,\t20 12.6 10 , 0 , 255", BALL, [dialects.JOINED]),
    ("sp 0,0,20 12.6 10,0,255 // red", f"{BALL} # red", [dialects.SLASHES]),
    ("sp 0,0,20 12.6 10,0,255 //# red", f"{BALL} ## red", [dialects.SLASHES]),
    ("// red", "", [dialects.SLASHES]),
    (
        "pl 0, -1, 0 0, 1, 0 199.6, 200 , 200 // floor",
        f"{FLOOR} # floor",
        [dialects.JOINED, dialects.NEAREST, dialects.SLASHES],
    ),
    ("sp 0 0 20 12.6 10 0 255", BALL, [dialects.JOINED]),
    ("sp 0;0;20 12.6 10;0;255", BALL, [dialects.JOINED]),
    (f"{BALL} mirror: 0.2 # red: ball", f"{BALL} mirror:0.2 # red: ball", [dialects.JOINED]),
    ("sp 12.6 0,0,20 10,0,255", BALL, [dialects.ORDER]),
    (
        "cy 0,0,20 0,1,0 10,0,255 1 2 0.25",
        "cy 0,0,20 0,1,0 1 2 10,0,255 mirror:0.25",
        [dialects.ORDER, dialects.REFLECTIVITY],
    ),
    ("sp (0,0,20), 12.6 10,0,300", BALL, [dialects.NEAREST]),
    ("pl 0,-1,0 0,20,0 200,200,200", FLOOR, [SCALED]),
    ("l 0,9,0 70 255,255,255", "l 0,9,0 0.7 255,255,255", [dialects.PERCENT]),
    ("l 0,9,0 101 255,255,255", "l 0,9,0 1 255,255,255", [dialects.NEAREST]),
    ("l 0,9,0 3.5 255,255,255 7", "l 0,9,0 1 255,255,255", [dialects.NEAREST, dialects.LEFT_OUT]),
    ("cu 0,1,0 2 9,8,7", "bo 0,1,0 0,1,0 2,2,2 9,8,7", [dialects.ORDER, dialects.RENAMED]),
    ("cu 0,1,0 1,0,0 2,3,4 9,8,7", "bo 0,1,0 1,0,0 2,3,4 9,8,7", [dialects.RENAMED]),
    ("ci 0,1,0 0,1,0 2 9,8,7", "di 0,1,0 0,1,0 2 9,8,7", [dialects.RENAMED]),
    ("bx 0,1,0 2 3 4 9,8,7", "bo 0,1,0 0,1,0 2,3,4 9,8,7", [dialects.ORDER, dialects.RENAMED, dialects.JOINED]),
    ("bx 0,1,0 2,3,4 9,8,7", "bo 0,1,0 0,1,0 2,3,4 9,8,7", [dialects.ORDER, dialects.RENAMED]),
    ("bo 0,1,0 1,0,0 0,0,1 2 3 4 9,8,7", "bo 0,1,0 0,0,1 2,3,4 9,8,7", [dialects.ORDER, dialects.JOINED]),
    ("box 0,1,0 1,0,0 0,0,1 2,3,4 9,8,7", "bo 0,1,0 0,0,1 2,3,4 9,8,7", [dialects.ORDER, dialects.RENAMED]),
    ("el 0,1,0 2,3,4 9,8,7", "el 0,1,0 0,1,0 2,3,4 9,8,7", [dialects.ORDER]),
    ("tor 0,1,0 0,1,0 2 0.5 9,8,7 marble", "to 0,1,0 0,1,0 2 0.5 9,8,7", [dialects.RENAMED, dialects.LEFT_OUT]),
    ("sphere | (0.0, 0.0, 20.0) 12.6 | (10, 0, 255)", BALL, [dialects.RENAMED, dialects.JOINED]),
    ("ptl 0,9,0 0.5 255,255,255", "l 0,9,0 0.5 255,255,255", [dialects.RENAMED]),
    ("mesh 1,2,3 0,90,0 2,2,2 9,8,7 'ball.obj'", "", [dialects.MISSING]),
    ("obj ball.obj", "", [dialects.MISSING]),
    ("co 1,2,3 0,1,0 4 cb:0,0,0:255,255,255", "", [dialects.INCOMPLETE]),
    ("SUN 1,-1,1 1.0 255,244,214", "", [dialects.LIGHTS]),
    ("bl 115,205,255", "", [dialects.SETTINGS]),
    ("SP 0,0,20 12.6 10,0,255", BALL, [dialects.RENAMED]),
    ("cam 0,0,0 0,0,1 70 9", "c 0,0,0 0,0,1 70", [dialects.LEFT_OUT, dialects.RENAMED]),
    ("camera 0,1,0 10", "", [dialects.SETTINGS]),
    ("max_depth 8", "", [dialects.SETTINGS]),
    ("R 4 0", "", [dialects.SETTINGS]),
    ("sl 0,9,0 1.0 0,1,0 80 9,8,7", "", [dialects.LIGHTS]),
    ("qd 0,0,0 1,0,0 0,1,0 9,8,7", "", [dialects.MISSING]),
    ("co 0,1,0 0,1,0 2 9,8,7", "", [dialects.INCOMPLETE]),
]


@pytest.fixture(autouse=True)
def pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("there.png", "there_bump.png", "usual.png"):
        Image.new("RGB", (2, 2)).save(name)
    Path("there.xpm").write_text('/* XPM */\nstatic char *a[] = {"1 1 1 1", "a c #000000", "a"};')


@pytest.mark.parametrize(("line", "meant", "sorts"), CASES)
def test_a_line_is_read_as_the_one_that_it_means(line: str, meant: str, sorts: list[str]) -> None:
    text = f"mat shiny 9,8,7 0.5\n{scene_with(PLANE, line, line)}"
    with pytest.raises(SceneError):
        parse(text, "test.rt")
    scene, notices = parse(text, "test.rt", lenient=True)
    expected = loads(scene_with(PLANE, *[meant] * 2))
    assert [str(each) for each in scene.elements] == [str(each) for each in expected.elements]
    told = {each.message.split(":")[0] for each in notices} - {dialects.SETTINGS}
    assert told == {each.split(":")[0] for each in sorts} - {dialects.SETTINGS}
    assert len(notices) == len(told) + 1, "a notice for each sort"
    # What is saved is strict, and every line that is not read stays as a comment.
    assert loads(dump(scene)).elements == scene.elements
    assert bool(meant) or f"# {line}" in dump(scene) or f"# missing: {line}" in dump(scene)
    assert scene.missing == ((line,) * 2 if {dialects.MISSING, dialects.INCOMPLETE}.intersection(sorts) else ())


@pytest.mark.parametrize("path", sorted((ROOT / "scenes").glob("*.rt")), ids=lambda path: path.stem)
def test_what_strict_reads_lenient_reads_to_the_same_scene(path: Path) -> None:
    strict, lenient = load(path), load(path, lenient=True)
    assert strict.scene == lenient.scene
    assert {each.message for each in strict.notices} == {
        re.sub(r" \(\d+ places\)$", "", each.message) for each in lenient.notices
    }


@pytest.mark.parametrize("lines", ["qd 0,0,0 1,0,0 9,8,7", "sp 0,0,0\nco 1,2,3"])
def test_a_scene_of_which_no_shape_can_be_read_is_refused(lines: str) -> None:
    with pytest.raises(SceneError, match="none of the shapes can be read"):
        loads(f"{AMBIENT}\n{CAMERA}\n{lines}\n", lenient=True)


@pytest.mark.parametrize(
    "lines", [f"{CAMERA}\n{SPHERE}\nA much", "A 0.2 1,2,3\nC 0,0,0 70\nsp 0,0,0 1 1,2,3", f"{CAMERA}\n{SPHERE} \x1b[2J"]
)
def test_errors_in_ambient_light_and_camera_and_hidden_characters_stay_errors(lines: str) -> None:
    with pytest.raises(SceneError):
        loads(lines, lenient=True)


def test_the_camera_of_the_older_subject_is_the_first_one() -> None:
    text = f"{AMBIENT}\nc 0,0,-9 0,0,1 60\nc 0,0,9 0,0,-1 60\nl 0,9,0 0.5 255,255,255\n{SPHERE}\n"
    scene, notices = parse(text, lenient=True)
    assert [each.position for each in scene.cameras] == [(0, 0, -9), (0, 0, 9)]
    assert [each.message for each in notices] == [f"{dialects.RENAMED}: c"]
    assert dump(scene) == text.replace("c", "C", 1)
    with pytest.raises(SceneError, match=r"scene:2:1: no camera 'C': all are further ones, 'c'") as caught:
        parse(text)
    assert [each.hint for each in caught.value.problems] == ["C 0,0,-9 0,0,1 60"]
    late = text.replace("c 0,0,9", "C 0,0,9")
    assert [each.position for each in parse(late, lenient=True).scene.cameras] == [(0, 0, 9), (0, 0, -9)]


def test_cones_are_read_as_the_program_means_them_that_the_file_is_from() -> None:
    text = scene_with("co 0,1.5,10 0,-1,0 15 3 9,8,7", f"{BALL} matte", "co 0,0,0 0,1,0 2 4 9,8,7")
    scene, notices = parse(text, lenient=True)
    assert [each.message for each in notices][-1] == f"{dialects.APEX}: co (2 places)"
    assert (notices[-1].line, scene.cones[0].diameter) == (3, 15)
    assert not parse(scene_with("co 0,1.5,10 0,-1,0 15 3 9,8,7"), lenient=True).notices
    by_angle, by_base = loads(text, lenient="angle").cones, loads(text, lenient="base").cones
    assert by_angle[0].diameter == pytest.approx(2 * 3 * 0.26794919243112270647)  # tan 15 degrees = 2 - sqrt 3
    assert (by_angle[1].apex, by_angle[1].height) == ((0, 0, 0), 4)
    assert [(each.apex, each.axis) for each in by_base] == [((0, -1.5, 10), (0, 1, 0)), ((0, 4, 0), (0, -1, 0))]
    assert loads(dump(loads(text, lenient="base"))).cones == by_base
    with pytest.raises(SceneError, match="diameter must be > 0"):
        loads(scene_with("co 0,0,0 0,1,0 100 4 9,8,7"), lenient="angle")


HALF = 0.5**0.5
DIRECTIONS = {  # as written, the words of `lenient`, and what they mean
    ("0,0,1", "reversed"): (0, 0, -1),
    ("0.5,0,0", "angles"): (0, -1, 0),  # shares of 180 degrees
    ("0,0.25,0", "angles"): (HALF, 0, HALF),
    ("0,1,0", "angles"): (0, 0, -1),
    ("-90,0,90", "angles"): (-1, 0, 0),  # degrees: up about x, and then about z
    ("0, 1.5707963267948966, 0", "angles"): (1, 0, 0),  # radians, with blanks
    ("0 45 0", "angles reversed"): (-HALF, 0, -HALF),
    ("0,0,0", "angles"): (0, 0, 1),
}


@pytest.mark.parametrize(("written", "words"), DIRECTIONS)
def test_directions_of_cameras_are_read_as_the_program_means_them(written: str, words: str) -> None:
    text = f"A 1 255,255,255\nC 0,1,0 {written} 70\nc 0,1,0 {written} 70\n{BALL}\n"
    scene, notices = parse(text, lenient=words)
    assert scene.camera.direction == pytest.approx(DIRECTIONS[written, words], abs=1e-9)
    assert [each.direction for each in scene.cameras] == [scene.camera.direction] * 2
    assert f"cameras are read as --camera-as {words.rsplit(maxsplit=1)[-1]} says: C" in [
        each.message for each in notices
    ]
    assert loads(dump(scene)).cameras == scene.cameras


ROLLS = {"1,0,0": 90, "-1,0,0": -90, "0,1,0": 0, "0,-1,0": 180, "0,0,1": 0, "0,0,-1": 0}  # along z there is no up


@pytest.mark.parametrize(("direction", "roll"), ROLLS.items())
def test_z_is_up_in_the_picture_that_asks_for_it(direction: str, roll: float) -> None:
    (camera,) = loads(f"A 1 255,255,255\nC 0,1,0 {direction} 70\n{BALL}\n", lenient="z-up").cameras
    assert camera.roll == roll
    _, up, forward = camera_frame(camera)
    assert up[2] == pytest.approx((1 - forward[2] ** 2) ** 0.5)


def test_a_word_of_the_lenient_reader_that_is_unknown_is_named() -> None:
    with pytest.raises(
        ValueError, match="lenient must be a bool, or some of base angle angles reversed z-up, got 'up'"
    ):
        loads(f"A 1 255,255,255\nC 0,1,0 0,0,1 70\n{BALL}\n", lenient="angles up")


def test_pictures_are_found_beside_the_file(tmp_path: Path) -> None:
    folder = tmp_path / "scenes"
    folder.mkdir()
    Image.new("RGB", (2, 2)).save(folder / "skin.png")
    (folder / "test.rt").write_text(scene_with(f"{BALL} skin.png"))
    assert load(folder / "test.rt", lenient=True).scene.spheres[0].texture == "skin.png"
