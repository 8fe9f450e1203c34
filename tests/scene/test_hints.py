"""Hints about lines with errors: they differ, keep what the line says, and the file is read once all are followed."""

from __future__ import annotations

from pathlib import Path
from unittest.mock import patch

import pytest

from minirt.errors import SceneError
from minirt.scene import hints
from minirt.scene.parser import load, parse
from tests.paths import ROOT
from tests.scene.examples import AMBIENT, CAMERA, SPHERE, WHOLE, scene_with

BALL = "sp 0,0,0 2 255,0,0"
HINTS = {  # '' where what is meant is uncertain
    "L 1,2,3 0.3 255,0,0": "l 1,2,3 0.3 255,0,0",
    "C 0,0,9 0,0,-1 50": "c 0,0,9 0,0,-1 50",
    "spp 0,0,0 2 255,0,0": BALL,
    "sp 0, 0, 0 2 255,0,0": BALL,
    "sp 0,0,0 2 0.9,0.2,0.2": "sp 0,0,0 2 230,51,51",
    "sp 0,0,0 2 300,0,0": BALL,
    "sp 0,0,0 2 red": BALL,
    f"{BALL} specular:2,30": f"{BALL} specular:1,30",
    f"{BALL} mirror=0.3": f"{BALL} mirror:0.3",
    f"{BALL} mirror: 0.3": f"{BALL} mirror:0.3",
    f"{BALL} texture: map.ppm": f"{BALL} texture:map.ppm",
    f"{BALL} mirror:": "",
    "sp 0,0,0 2 255;0;0": BALL,
    "sp 0,0,0 255,0,0 2": BALL,
    "sl 0,9,0 1.0 0,1,0 80 9,8,7": "",
    "c 0,0,9 0,0,-1 50 tone:sRGB": "c 0,0,9 0,0,-1 50 tone:srgb",
    "c 0,0,9 0,0,-1 50 tone:hdr": "",
    f"{BALL} bump:map.ppm,50": f"{BALL} bump:map.ppm,10",
    f"{BALL} texture:mpa.ppm": f"{BALL} texture:map.ppm",
    f"{BALL} texture:my map.ppm": f'{BALL} texture:"my map.ppm"',
    "sky map.ppm": "bg map.ppm",
    "sky 9,9,200": "bg 9,9,200",
    f"{BALL} glass:0.5": "",
    f"{BALL} mirror:50": "",
    "l 0,9,0 70 255,255,255": "",
    f"{BALL} glass": "",
    f"{BALL} glow": "",
    f"{BALL} checker:1,30,30": "",
    f"{BALL} 0.3": "",
    f"{BALL} 5 6 7 8": "",
    f"{BALL} cd:1,2,3:4,5,6:0.5": "",
    "sp 0,0,0 2": "",
    "sp 0,0,0 -2 255,0,0": "",
    "pl 0,-1,0 255,255,255 0,1,0": "",
    "cy 0,1,0 2.5,0.5,2 1.6 3 60,110,220": "",
    "cy 0,0,0 0,5,0 1 2 60,110,220": "cy 0,0,0 0,1,0 1 2 60,110,220",
    "c 0,5,-12 -1.5,0.5,0 50": "",
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("map.ppm", "my map.ppm"):
        (tmp_path / name).write_bytes(b"P6 1 1 255\n\xff\0\0")
    return tmp_path


def hints_of(text: str, folder: Path) -> dict[int, str]:
    """Return the hints about a strict reader's errors, by line."""
    with pytest.raises(SceneError) as caught:
        parse(text, folder / "scene.rt")
    return {each.line: each.hint for each in caught.value.problems}


@pytest.mark.parametrize("line", HINTS)
def test_a_hint_keeps_what_its_line_says(line: str, folder: Path) -> None:
    text = scene_with("L 0,9,0 0.5", line)
    number = text.split("\n").index(line) + 1
    assert hints_of(text, folder) == {number: HINTS[line]}
    if HINTS[line]:
        assert parse(text.replace(line, HINTS[line]), folder / "scene.rt").scene.elements


def test_a_hint_that_leaves_an_error_is_not_given(folder: Path) -> None:
    wrong = {BALL + " texture:none.xyz mirror:2": "", "sp 0,0,0 2 300,0,0": BALL}
    text = scene_with(*wrong)
    numbers = [text.split("\n").index(line) + 1 for line in wrong]
    assert hints_of(text, folder) == dict(zip(numbers, wrong.values(), strict=True))
    with patch.object(hints, "read_again", lambda *_: set()):  # planted: hints are not tried
        assert hints_of(text, folder) != dict(zip(numbers, wrong.values(), strict=True))


def test_a_missing_line_is_proposed_and_the_camera_shows_the_shapes(folder: Path) -> None:
    with pytest.raises(SceneError, match=r"such as '(C 0,0,-\d.* 0,0,1 60)'") as caught:
        parse(f"{AMBIENT}\n{SPHERE}\n")
    line = str(caught.value).split("such as '")[1].split("'")[0]
    eye = parse(f"{AMBIENT}\n{line}\n{SPHERE}\n").scene.camera.position
    assert 20 - eye[2] > 12.6  # outside of the sphere and far enough from it
    with pytest.raises(SceneError, match=r"no ambient light: .*, such as 'A 0.2 255,255,255'"):
        parse(f"{CAMERA}\n{SPHERE}\n")


def test_the_program_s_own_wild_scenes_are_read_once_all_hints_are_followed() -> None:
    followed = 0
    for path in sorted((ROOT / "tests/scene/wild").glob("*.rt")):
        sources = path.read_text().split("\n")
        try:
            load(path)
        except SceneError as error:
            found = {each.line: each.hint for each in error.problems}
            for line, hint in found.items():
                assert hint.split() != sources[line - 1].split()
                sources[line - 1] = hint or sources[line - 1]
            if all(found.values()):
                followed += 1
                parse("\n".join(sources), path)
    assert followed


def test_all_mistakes_of_a_line_are_told() -> None:
    with pytest.raises(SceneError) as caught:
        parse(f"{WHOLE}cy 0,0,0 0,1,0 2 300,400,-1 specular=0.5,20 glow\n")
    assert [each.message.split(",")[0] for each in caught.value.problems] == [
        "cylinder height is missing: expected 'cy x",
        "cylinder colour R must be in [0",
        "cylinder colour G must be in [0",
        "cylinder colour B must be in [0",
        "an attribute is written with a colon: 'specular:0.5",
        "cylinder glow needs a value: 'glow:share'",
    ]
