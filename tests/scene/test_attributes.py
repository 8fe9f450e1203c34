"""Materials, lights and backgrounds in a scene file are read, refused and written."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from minirt.errors import SceneError
from minirt.materials import Bump, Checker, Clouds, Glass, Marble, Mirror, Specular, Tint, Wood
from minirt.scene import Background, describe, dump, load, parse
from minirt.shapes import KINDS, Kind, Plane, Sphere
from tests.scene.examples import CYLINDER, PLANE, SPHERE, notices, problems, read, scene_with
from tests.shapes.examples import example

ABSENT = dict.fromkeys(
    (
        *("specular", "mirror", "glass", "tint", "fresnel", "glow", "checker", "texture", "bump", "normal_map"),
        *("marble", "wood", "clouds"),
    )
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a picture, and another picture in a subfolder."""
    (tmp_path / "below").mkdir()
    for name in ("a.png", "below/b.png"):
        Image.new("RGB", (2, 2)).save(tmp_path / name)
    return tmp_path


def attributes(shape: Any) -> dict[str, Any]:
    """Return the attributes of a shape that are present."""
    return {name: value for name in ABSENT if (value := getattr(shape, name)) is not None}


@pytest.mark.parametrize(
    ("words", "values"),
    [
        ("", {}),
        ("specular:0.5,30", {"specular": Specular(0.5, 30.0)}),
        ("specular:.5,3e1,blinn", {"specular": Specular(0.5, 30.0, blinn=True)}),
        ("mirror:0.3", {"mirror": Mirror(0.3)}),
        ("mirror:0.25,9", {"mirror": Mirror(0.25, 9.0)}),
        ("glass:1.5,0.5,20", {"glass": Glass(1.5, 0.5, 20.0)}),
        ("tint:0,1,2,.5", {"tint": Tint((0, 1, 2), 0.5)}),
        ("fresnel", {"fresnel": 1.0}),
        ("fresnel:0.5", {"fresnel": 0.5}),
        ("glow:0.25", {"glow": 0.25}),
        ("glass:1.5", {"glass": Glass(1.5, 1.0)}),
        ("checker:2.5,1,2,3", {"checker": Checker(2.5, (1, 2, 3))}),
        ("pattern:marble,2", {"marble": Marble(2.0)}),
        ("pattern:wood,0.5,1,2,3", {"wood": Wood(0.5, (1, 2, 3))}),
        (
            "pattern:clouds,3,1,2,3,7 pattern:marble,1,9,8,7,6,-0.5",
            {"clouds": Clouds(3.0, (1, 2, 3), 7), "marble": Marble(1.0, (9, 8, 7), 6, -0.5)},
        ),
        ("mirror:0.3 specular:0.5,30  checker:1\tglass:2", None),
        ("checker:1 specular:0.5,30 glass:2 mirror:0.3 # all", None),
    ],
)
@pytest.mark.parametrize("line", [SPHERE, PLANE, CYLINDER])
def test_every_shape_takes_attributes_in_any_order(line: str, words: str, values: dict[str, Any] | None) -> None:
    together = {"specular": Specular(0.5, 30.0), "mirror": Mirror(0.3), "glass": Glass(2.0), "checker": Checker(1.0)}
    (plain, shape) = read(line, f"{line} {words}").shapes
    assert attributes(plain) == {}
    assert attributes(shape) == (together if values is None else values)
    assert shape == plain.replace(**attributes(shape))
    assert hash(shape) == hash(plain.replace(**attributes(shape)))
    assert not [each for each in notices(f"{line} {words}") if "has no effect without" not in each[2]]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
def test_checker_without_a_size_has_8_by_8_squares_or_unit_squares_on_a_plane(kind: Kind) -> None:
    line = describe(example(kind, np.random.default_rng(1)))
    for word in ("checker", "pat"):
        (*_, shape) = read(f"{line} {word}").shapes
        assert shape.checker == Checker(1.0 if kind.element is Plane else 0.125, (0, 0, 0))


def test_all_wrong_attributes_of_a_line_are_reported_in_one_run() -> None:
    errors = problems(scene_with(f"{SPHERE} mirror:2 zzz:1 glass:0 texture:no.png"))
    assert [problem.column - len(SPHERE) for problem in errors] == [9, 11, 23, 33]


def test_a_plane_has_a_normal_and_a_normal_map(folder: Path) -> None:
    (plane,) = parse(scene_with(f"{PLANE} normal:a.png"), folder / "s.rt").scene.planes
    assert (plane.normal, plane.normal_map) == ((0.0, 1.0, 0.0), "a.png")
    assert describe(plane) == f"{PLANE} normal:a.png"


def test_picture_paths_are_relative_to_the_folder_of_the_scene(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = folder / "s.rt"
    words = ["texture:a.png", "bump:below/b.png,0.5", "normal:below/../a.png", "bg below/b.png", f"txm:{folder}/a.png"]
    text = scene_with(*(f"{SPHERE} {each}" for each in words if " " not in each), words[3])
    path.write_text(text)
    monkeypatch.chdir("/")
    scene = load(path).scene
    a, b, c, d = scene.spheres
    assert (a.texture, b.bump, c.normal_map) == ("a.png", Bump("below/b.png", 0.5), "below/../a.png")
    assert d.texture == f"{folder}/a.png"
    assert scene.background == Background("below/b.png")
    assert scene.beside("a.png") == folder / "a.png"
    assert scene.beside(d.texture) == folder / "a.png"
    assert dump(scene) == text
    (folder / "below" / "b.png").write_text("no picture")
    with pytest.raises(SceneError) as caught:
        load(path)
    assert [problem.message for problem in caught.value.problems] == [
        "sphere bump must be a picture file, got 'below/b.png': is not a picture",
        "background paint must be a picture file, got 'below/b.png': is not a picture",
    ]
    assert dump(scene.replace(a, diameter=2.0)) == text.replace("12.6", "2", 1)  # saving needs no pictures


def test_there_is_at_most_one_background() -> None:
    assert read().background is None
    assert read("bg 1,2,3").background == Background((1, 2, 3))
    (problem,) = problems(scene_with("bg 1,2,3", "bg 1,2,3"))
    assert (problem.line, problem.message[:19]) == (4, "a second background")
    assert read("bg 1.6,2,3", lenient=True).background == Background((2, 2, 3))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Specular(2, 30), "specular share must be in [0, 1], got 2"),
        (lambda: Bump("a\tb"), "bump file must be the name of a picture file, without tabs, commas, quotes and #, got"),
        (
            lambda: Sphere((0, 0, 0), 1, (0, 0, 0), specular=(0.5, 30)),  # type: ignore[arg-type]
            "sphere specular must be a Specular, got (0.5, 30)",
        ),
        (
            lambda: Plane((0, 0, 0), (0, 1, 0), (0, 0, 0), normal_map="a#"),
            "plane normal map must be the name of a picture file, without tabs, quotes and #, got 'a#'",
        ),
        (
            lambda: Background("a,b"),
            "background paint must be the name of a picture file, without tabs, commas, quotes and #",
        ),
        (lambda: Background((1, 2)), "background paint must be R,G,B, three numbers, got (1, 2)"),  # type: ignore[arg-type]
    ],
)
def test_wrong_values_are_refused_in_python_too(make: Any, message: str) -> None:
    with pytest.raises(ValueError, match=r".") as caught:
        make()
    assert str(caught.value).startswith(message)


USELESS = {
    f"{SPHERE} tint:1,2,3": "sphere tint has no effect without 'glass:'",
    f"{SPHERE} fresnel": "sphere fresnel has no effect without 'glass:' or 'mirror:'",
    f"{PLANE} uv:1,2": "plane uv has no effect without 'checker:' or 'texture:' or 'bump:' or 'normal:'",
}


@pytest.mark.parametrize(("line", "message"), USELESS.items())
def test_an_attribute_that_has_no_effect_is_told(line: str, message: str) -> None:
    assert [each[2] for each in notices(line)] == [message]
    assert not notices(f"{line} glass:1.5 mirror:0.5 checker:2")


OLD = {
    "spc:0.5,30 mir:0.25 ref:1.5": "specular:0.5,30 mirror:0.25 glass:1.5",
    "pat": "checker",
    "pat:2,1,2,3 marble:1,2,3,4": "checker:2,1,2,3 pattern:marble,1,2,3,4",
    "wood:0.5 clouds:2,9,9,9,3,0.1": "pattern:wood,0.5 pattern:clouds,2,9,9,9,3,0.1",
}


@pytest.mark.parametrize(("old", "new"), OLD.items())
def test_old_names_are_read_with_a_notice_each(old: str, new: str) -> None:
    assert read(f"{SPHERE} {old}").spheres == read(f"{SPHERE} {new}").spheres
    assert not set(old.split()) & set(describe(read(f"{SPHERE} {old}").spheres[0]).split())
    told = notices(f"{SPHERE} {old}")
    assert [message.split("'")[1] for _, _, message in told] == [re.split("[:]", word)[0] for word in old.split()]
    assert all("is the old name of" in message for _, _, message in told)
    assert not notices(f"{SPHERE} {new}")
    assert [message for _, _, message in notices("l 0,0,0 1 fade:5")] == [
        "'fade' is the old name of 'reach:distance': later versions will not read it"
    ]
