"""Scenes of older programs: what every reader takes with a notice, and what only a lenient one reads."""

from __future__ import annotations

from pathlib import Path

import pytest

from minirt.errors import SceneError
from minirt.scene import Ambient, Camera, FurtherCamera, FurtherLight, Light, dump, load, parse
from minirt.scene.dialect_tables import DARK, SECOND
from minirt.scene.lines import MAX_NOTICES
from tests.scene.examples import AMBIENT, CAMERA, LIGHT, PLANE, SPHERE, problems, read, scene_with


@pytest.mark.parametrize("lenient", [False, True])
def test_a_camera_without_a_direction_looks_along_z(lenient: bool) -> None:
    for direction, column in (("0,0,0", 9), ("0,0,0,0", 15)):
        scene, (notice,) = parse(f"{AMBIENT}\nC 0,0,0 {direction} 70\n", "test.rt", lenient)
        assert scene.camera.direction == (0, 0, 1)
        assert (notice.line, notice.column) == (2, column)
        assert notice.message.endswith("takes 0,0,1)")
        assert "--lenient" not in notice.message


@pytest.mark.parametrize("lenient", [False, True])
@pytest.mark.parametrize("last", ["0", "-0", "0.0", "0e9"])
def test_a_direction_in_homogeneous_coordinates_is_read(last: str, lenient: bool) -> None:
    line = f"pl 0,-1,0 0,1,0,{last} 200,200,200"
    scene, (notice,) = parse(scene_with(line), "test.rt", lenient)
    assert scene.elements == read(PLANE).elements
    assert (notice.line, notice.column) == (3, 17)
    assert notice.message.endswith(f"got '0,1,0,{last}' (miniRT drops the fourth component)")
    assert dump(scene) == scene_with(line)


def test_later_lights_become_further_lights() -> None:
    lines = (LIGHT, "L 0,0,0 0.5", "l 1,1,1 0.1 1,2,3", "  L 0,0,1 0.5 1,2,3")
    first, second = problems(scene_with(*lines))
    assert (first.line, first.column, second.line, second.column) == (4, 1, 6, 3)
    assert first.message == "a second light: the first is in line 3, and there may be one"
    scene, notices = parse(scene_with(*lines), "test.rt", lenient=True)
    assert [each.message for each in notices] == [f"{SECOND}: L to l (2 places)"]
    assert [type(light) for light in scene.lights] == [Light, FurtherLight, FurtherLight, FurtherLight]
    strict = scene_with(LIGHT, *(line.strip().replace("L", "l") for line in lines[1:]))
    assert dump(scene) == strict
    moved = scene.replace(scene.lights[1], brightness=0.25)
    assert dump(moved) == strict.replace("l 0,0,0 0.5", "l 0,0,0 0.25")


def test_later_cameras_become_further_cameras() -> None:
    lines = (CAMERA, SPHERE, "C 0,0,9 0,0,-1 50 roll:9  # behind")
    with pytest.raises(SceneError, match="a second camera: the first is in line 2, and there may be one"):
        parse("\n".join((AMBIENT, *lines)))
    scene, notices = parse("\n".join((AMBIENT, *lines)), lenient=True)
    assert [each.message for each in notices] == [f"{SECOND}: C to c"]
    assert [(type(each), each.roll) for each in scene.cameras] == [(Camera, 0.0), (FurtherCamera, 9.0)]
    assert dump(scene) == "\n".join((AMBIENT, CAMERA, SPHERE, "c 0,0,9 0,0,-1 50 roll:9 # behind"))


def test_a_scene_without_ambient_light_has_a_black_one() -> None:
    text = f"{CAMERA}\n{SPHERE}\n"
    (error,) = problems(text)
    assert (error.line, error.message[:20]) == (2, "no ambient light: a ")
    scene, (notice,) = parse(text, "test.rt", lenient=True)
    assert notice.message == f"{DARK}: A"
    assert scene.ambient == Ambient(0, (255, 255, 255))
    assert dump(scene) == f"A 0 255,255,255\n{text}"


@pytest.mark.parametrize(
    ("line", "column", "message"),
    [
        ("sp ,0 ,20 5 255,0,0", 6, "no blanks may stand around a comma"),
        ("sp 0,0,20,1,1 5 255,0,0", 11, "sphere centre must be x,y,z"),
        ("sp 0,0,20,a 5 255,0,0", 11, "sphere centre must be x,y,z"),
        ("sp 0,0,20 5//2 255,0,0", 11, "sphere diameter must be a number, got '5//2'"),
    ],
)
def test_other_mistakes_are_errors_also_when_lenient(line: str, column: int, message: str) -> None:
    (error,) = problems(scene_with(line), lenient=True)
    assert (error.line, error.column) == (3, column)
    assert message in error.message


def test_only_one_ambient_light_also_when_lenient() -> None:
    assert [each.line for each in problems(scene_with(AMBIENT), lenient=True)] == [3]
    assert "no camera" in problems(f"{AMBIENT}\n{SPHERE}\n", lenient=True)[0].message


@pytest.mark.parametrize("count", [1, MAX_NOTICES, MAX_NOTICES + 1, 3 * MAX_NOTICES])
def test_the_last_of_too_many_notices_says_that_there_are_more(count: int) -> None:
    scene, notices = parse(scene_with(*["pl 0,-1,0 0,1,0,0 200,200,200"] * count))
    assert len(scene.planes) == count
    assert [notice.line for notice in notices] == list(range(3, 3 + min(count, MAX_NOTICES + 1)))
    are_complete = count <= MAX_NOTICES
    assert ("too many notices: those from here on are left out" in notices[-1].message) != are_complete


# Scenes in the dialects of other miniRT programs, and in `wild/meaning` the same in the words of this program.

WILD = Path(__file__).parent / "wild"
NAMES = sorted(path.stem for path in WILD.glob("*.rt"))

# Lines that only a lenient reader accepts: two lights; comments, vectors of four numbers; blanks around commas.
LENIENT = {"cornell-box": [8], "party-hats": [1, 7], "pyramid": [3]}


@pytest.mark.parametrize("name", NAMES)
def test_lines_outside_the_format_are_errors(name: str) -> None:
    try:
        load(WILD / f"{name}.rt")
        odd = []
    except SceneError as error:
        odd = sorted({problem.line for problem in error.problems})
    assert odd == LENIENT.get(name, [])


@pytest.mark.parametrize("name", NAMES)
def test_a_scene_means_what_it_meant_there(name: str) -> None:
    scene = load(WILD / f"{name}.rt", lenient=True).scene
    meant = parse((WILD / "meaning" / f"{name}.rt").read_text(), WILD / f"{name}.rt").scene
    assert scene.elements == meant.elements
    assert len(NAMES) >= 6
