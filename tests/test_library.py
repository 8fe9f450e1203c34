"""The library: load, render and edit scenes in Python."""

from __future__ import annotations

import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import minirt
from minirt.scene import Resolution
from tests.paths import SCENES
from tests.reference import render, to_bytes

SUBJECT = SCENES / "subject.rt"


@pytest.fixture
def scene() -> minirt.Scene:
    return minirt.load(SUBJECT)


@pytest.mark.parametrize("path", [SUBJECT, str(SUBJECT)])
def test_render_gives_bytes_and_linear_radiance_of_the_reference(path: Path | str) -> None:
    image = minirt.render(minirt.load(path), 64, 48)
    assert (image.array.shape, image.array.dtype) == ((48, 64, 3), np.uint8)
    assert (image.linear.shape, image.linear.dtype) == ((48, 64, 3), np.float64)
    assert np.array_equal(image.array, to_bytes(image.linear))
    assert (np.abs(image.linear - render(minirt.load(path), 64, 48)).max(axis=-1) > 1e-9).mean() < 1e-3
    assert image.pil.size == (64, 48)
    assert image._repr_png_().startswith(b"\x89PNG")


def test_light_is_made_when_it_is_asked_for(scene: minirt.Scene) -> None:
    kept, image, sent = (
        minirt.render(scene, 64, 48, region=(9, 7, 40, 30), linear=linear) for linear in (True, None, None)
    )
    assert np.array_equal(image.array, kept.array)
    assert repr(image) == repr(kept) == "<Image of 40x30 pixels, with linear light>"
    assert "linear" not in vars(image)
    sent = pickle.loads(pickle.dumps(sent))
    assert "linear" in vars(sent)
    assert all(np.array_equal(each.linear, kept.linear) for each in (image, sent))


def test_a_scene_says_what_it_has_and_where_it_is_from(scene: minirt.Scene, tmp_path: Path) -> None:
    path = tmp_path / "some.rt"
    scene.save(path)
    about = f"{len(scene.shapes)} shapes and 1 light"
    assert repr(minirt.Scene(scene.items)) == f"<Scene of {about}>"
    assert repr(minirt.load(path)) == f"<Scene of {about}, from {str(path)!r}>"


def test_the_size_is_the_scenes_own_or_the_default(scene: minirt.Scene) -> None:
    assert minirt.size_of(scene) == minirt.DEFAULT_SIZE
    sized = minirt.Scene((Resolution(40, 20), *scene.items))
    assert minirt.size_of(sized) == (40, 20)
    assert minirt.render(sized).array.shape == (20, 40, 3)
    assert minirt.render(sized, 10, 20).array.shape == (20, 10, 3)


@pytest.mark.parametrize(
    ("own", "asked", "expected"),
    [
        ((40, 20), {"width": 10}, (10, 5)),
        ((40, 20), {"height": 10}, (20, 10)),
        ((300, 400), {"width": 100}, (100, 133)),
        ((1000, 1), {"width": 9}, (9, 1)),  # and never without a pixel
        (None, {"width": 64}, (64, 36)),
        (None, {"height": 18}, (32, 18)),
    ],
)
def test_one_side_keeps_the_proportions_of_the_scenes_size(
    scene: minirt.Scene, own: tuple[int, int] | None, asked: dict[str, int], expected: tuple[int, int]
) -> None:
    sized = minirt.Scene((*([Resolution(*own)] if own else []), *scene.items))
    assert minirt.render(sized, **asked).array.shape == (*expected[::-1], 3)


@pytest.mark.parametrize(
    ("name", "value", "limits"),
    [
        *((name, value, "of at least 1") for name in ("width", "height", "samples") for value in (0, 10.5)),
        *((name, value, "of at least 1") for name in ("samples", "threads") for value in (-1, 2.5, "many", True)),
        *(("depth", value, "from 0 to 32") for value in (-1, 1.5, 33)),
    ],
)
def test_an_argument_that_is_no_whole_number_in_its_limits_is_named(
    scene: minirt.Scene, name: str, value: object, limits: str
) -> None:
    message = f"{name} must be a whole number {limits}, got {value!r}"
    with pytest.raises(minirt.RenderError, match=f"^{re.escape(message)}$"):
        minirt.render(scene, **{"width": 4, "height": 4, name: value})
    assert minirt.render(scene, np.int64(4), np.uint8(4), samples=np.int32(1)).array.shape == (4, 4, 3)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"region": (0, 0, 2.5, 3)}, "region must be 4 whole numbers, got (0, 0, 2.5, 3)"),
        ({"region": 5}, "region must be 4 whole numbers, got 5"),
        ({"rows": (0, 1.5)}, "region must be 4 whole numbers, got (0, 0, 4, 1.5)"),
        ({"samples": 10**12}, "1000000000000 samples a pixel need about 953674.3 GiB of memory, allowed "),
    ],
)
def test_an_argument_that_no_picture_has_is_named(scene: minirt.Scene, wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(minirt.RenderError, match=f"^{re.escape(message)}"):
        minirt.render(scene, 4, 4, **wrong)


@pytest.mark.parametrize("goal", [{"error": 0}, {"error": -1.0}, {"time": 0}, {"error": float("nan")}, {"time": "1"}])
def test_a_goal_that_is_not_positive_or_without_auto_is_an_error(scene: minirt.Scene, goal: dict[str, Any]) -> None:
    with pytest.raises(minirt.RenderError, match=f"{next(iter(goal))} must be a number > 0"):
        minirt.render(scene, 4, 4, samples="auto", **goal)
    with pytest.raises(minirt.RenderError, match="needs samples='auto', got 4"):
        minirt.render(scene, 4, 4, samples=4, **goal)


def test_an_edit_makes_a_new_scene(scene: minirt.Scene) -> None:
    before = minirt.render(scene, 32, 18).array
    larger = scene.replace(scene.spheres[0], diameter=30)
    assert larger.spheres[0].diameter == 30
    assert scene.spheres[0].diameter == 20
    assert larger.planes == scene.planes
    assert not np.array_equal(minirt.render(larger, 32, 18).array, before)
    assert np.array_equal(minirt.render(scene, 32, 18).array, before)
    with pytest.raises(ValueError, match="diameter must be > 0"):
        scene.replace(scene.spheres[0], diameter=-1)
    for name, meant in ("size", "diameter"), ("radius", "diameter"), ("position", "centre"), ("color", "colour"):
        with pytest.raises(TypeError, match=rf"^Sphere has no field '{name}', did you mean '{meant}'\?$"):
            minirt.Sphere((0, 0, 0), **{name: 1})  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"^Box has no field 'size', did you mean 'sizes'\?$"):
        minirt.Box((0, 0, 0), size=(1, 1, 1))  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"^Sphere has no field 'diametre', did you mean 'diameter'\?$"):
        scene.replace(scene.spheres[0], diametre=3)
    with pytest.raises(ValueError, match=r"^the scene has no Sphere\(centre=\(0.0, 0.0, 0.0\), diameter=1.0, "):
        scene.replace(minirt.Sphere((0, 0, 0), 1, (1, 2, 3)), diameter=1)
    with pytest.raises(AttributeError, match=r"^a scene has no 'teapots'$"):
        _ = scene.teapots
    with pytest.raises(AttributeError, match=r"^a scene has no 'sphere', did you mean 'spheres'\?$"):
        _ = scene.sphere
    with pytest.raises(AttributeError):
        scene.items = ()  # type: ignore[misc]


NO_ELEMENTS: list[tuple[Any, str]] = [
    (5, "5"),
    (None, "None"),
    ("sp 0,0,5 2 255,0,0", "'sp 0,0,5 2 255,0,0'"),
    ([minirt.Sphere((0, 0, 5), 2, (255, 0, 0))], r"a list: {function}\(\*elements\) takes them one by one"),
    (minirt.Mirror(0.5), r"Mirror\(share=0.5\)"),
    (minirt.Sphere, "<class 'minirt.shapes.sphere.Sphere'>"),
]


@pytest.mark.parametrize(("wrong", "named"), NO_ELEMENTS, ids=[type(wrong).__name__ for wrong, _ in NO_ELEMENTS])
def test_what_is_no_element_is_refused_at_once(scene: minirt.Scene, wrong: Any, named: str) -> None:
    ball = scene.spheres[0]
    for function, call in {
        "add": lambda: scene.add(ball, wrong),
        "remove": lambda: scene.remove(wrong),
        "replace": lambda: scene.replace(wrong, ball),
        "Scene": lambda: minirt.Scene([*scene.items, wrong]),
    }.items():
        with pytest.raises(
            TypeError, match=f"^{function} takes elements such as minirt.Sphere, got {named.format(function=function)}$"
        ):
            call()
    if wrong is not None:
        with pytest.raises(
            TypeError, match=f"^replace takes elements such as minirt.Sphere, got {named.format(function='replace')}$"
        ):
            scene.replace(ball, wrong)


def test_a_scene_has_comments_and_blank_lines_beside_its_elements(scene: minirt.Scene) -> None:
    lines = "", " \t", "# a comment", "  # another\r", "\ufeff# with a byte order mark"
    assert minirt.Scene((*lines, *scene.elements)).items[:5] == lines
    for text in ("two\n# lines", "# two\nsp 0,0,5 2 255,0,0", "a # comment"):
        with pytest.raises(TypeError, match=r"^Scene takes elements"):
            minirt.Scene((*scene.elements, text))


def test_true_means_what_the_key_alone_means_in_a_file_and_is_no_number() -> None:
    for name in ("checker", "fresnel"):
        (read,) = minirt.loads(f"A 1 9,9,9\nC 0,0,0 0,0,1 60\nsp 0,0,5 2 1,2,3 glass:1.5 {name}\n").spheres
        assert minirt.Sphere((0, 0, 5), 2, (1, 2, 3), glass=1.5, **{name: True}) == read
    assert minirt.Plane((0, 0, 0), (0, 1, 0), (1, 2, 3), checker=True).checker == minirt.Checker(1.0)
    for name, wanted in {
        "glass": "number or a minirt.Glass",
        "mirror": "number or a minirt.Mirror",
        "specular": "minirt.Specular",
        "glow": "number",
        "roll": "number",
        "texture": "value",
    }.items():
        with pytest.raises(minirt.ElementError, match=f"^sphere {name} must be a {wanted}, got True$"):
            minirt.Sphere((0, 0, 5), 2, (1, 2, 3), **{name: True})
    with pytest.raises(minirt.ElementError, match=r"^sphere diameter must be a number, got True$"):
        minirt.Sphere((0, 0, 5), True, (1, 2, 3))
    assert minirt.Specular(0.5, 9, blinn=True).blinn is True


def test_errors_and_results_have_public_names(scene: minirt.Scene) -> None:
    with pytest.raises(minirt.ElementError) as wrong:
        minirt.Sphere((0, 0, 5), -2, (1, 2, 3))
    assert isinstance(wrong.value, minirt.MiniRTError)
    assert isinstance(wrong.value, ValueError)
    minirt.limit_memory(2**20)
    try:
        with pytest.raises(minirt.TooLargeError):
            minirt.render(scene, 4000, 4000)
    finally:
        minirt.limit_memory(None)
    assert isinstance(minirt.render(scene, 16, 9, samples="auto", error=0.5).reached, minirt.Outcome)
    with pytest.raises(minirt.SceneError) as refused:
        minirt.loads("sp 0,0,5 2 1,2,3\n")
    assert all(isinstance(each, minirt.Problem) for each in refused.value.problems)
    place: minirt.Triple = (0, 0, 5)
    assert minirt.Sphere(place, 2, (1, 2, 3)).centre == place


def test_a_scene_is_written_and_read_again(scene: minirt.Scene, tmp_path: Path) -> None:
    text = SUBJECT.read_text(encoding="utf-8")
    assert minirt.dumps(scene) == text
    assert minirt.dumps(minirt.loads(text)) == text
    path = tmp_path / "changed.rt"
    added = scene.add(minirt.Sphere((0, 0, 5), 2, (255, 0, 0)))
    added.save(path)
    assert path.read_text(encoding="utf-8") == text.rstrip("\n") + "\nsp 0,0,5 2 255,0,0\n"
    read = minirt.load(path)
    read.remove(read.spheres[-1]).save()
    assert path.read_text(encoding="utf-8") == text
    with pytest.raises(ValueError, match="needs a path"):
        minirt.loads(text).save()
    with pytest.raises(minirt.SceneError, match=r"ends in '\.rt'"):
        scene.save(tmp_path / "a.txt")


@pytest.mark.parametrize("function", ["render", "buffers", "camera_rays", "explain", "view", "dumps", "trace"])
@pytest.mark.parametrize("path", ["demo.rt", Path("demo.rt")])
def test_the_name_of_a_file_is_refused_with_what_to_do(function: str, path: Path | str) -> None:
    arguments = {
        "buffers": (8, 6),
        "camera_rays": (8, 6),
        "explain": (8, 6, 1, 2),
        "trace": ([[0, 0, 0]], [[0, 0, 1]]),
    }.get(function, ())
    with pytest.raises(TypeError, match=rf"minirt\.{function} takes a scene, .*: use minirt.load\('demo.rt'\)"):
        getattr(minirt, function)(path, *arguments)


def test_a_renderer_is_the_one_of_render(scene: minirt.Scene) -> None:
    shared = minirt.renderer()
    assert minirt.renderer(None) is shared
    assert minirt.renderer(threads=None, precision="double", depth=None, dither=False) is shared
    minirt.render(scene, 9, 7)
    assert shared.packing.last
    assert tuple(shared.packing.shape_arrays.shapes) == scene.shapes
    assert minirt.renderer(1) is not shared


def test_numpy_takes_a_picture(scene: minirt.Scene) -> None:
    image = minirt.render(scene, 9, 7)
    assert np.asarray(image) is image.array
    assert np.array(image) is not image.array
    assert np.asarray(image, float).dtype == np.float64
    assert np.mean(image) == image.array.mean()
