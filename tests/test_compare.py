"""`minirt.compare`: causes that are planted in pictures are named, and nothing else is."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from math import atan, degrees, radians, tan
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.compare import lighting, pictures
from minirt.compare.geometry import frame
from minirt.compare.judge import Judge
from minirt.compare.search import Case
from minirt.compare.table import OURS, TABLE
from minirt.scene import Scene
from tests.paths import PACKAGE, ROOT
from tests.planting import SIZE, Bytes, are_visible, compared, draw, judged, merged, student_scene
from tests.skipping import skip_incomplete

ROWS = {f"{row.name} {row.value}": row for row in TABLE}


def rendered(scene: Scene, samples: int = 1) -> Bytes:
    return minirt.render(scene, *SIZE, samples=samples).array


@pytest.mark.parametrize("seed", range(4))
def test_the_formulas_are_those_of_the_kernel(seed: int) -> None:
    scene = student_scene(seed)
    ours, theirs = draw(scene, OURS), rendered(scene)
    assert (pictures.distance(ours, theirs) > 1).mean() < 1e-4


# Changes of a scene, by the cause and its value.
def wider(scene: Scene) -> Scene:
    vertical = degrees(2 * atan(tan(radians(scene.camera.fov) / 2) * SIZE[0] / SIZE[1]))
    return scene.replace(scene.camera, fov=vertical)


def on_their_base(scene: Scene) -> Scene:
    for each in scene.cylinders:
        centre = tuple(p + each.height / 2 * d for p, d in zip(each.centre, each.axis, strict=True))
        scene = scene.replace(each, centre=centre)
    return scene


def doubled_balls(scene: Scene) -> Scene:
    for each in scene.spheres:
        scene = scene.replace(each, diameter=2 * each.diameter)
    return scene


EDITED: dict[tuple[str, object], Callable[[Scene], Scene]] = {
    ("mirrored", True): Scene.mirrored,
    ("fov", "vertical"): wider,
    ("cylinder", "base"): on_their_base,
    ("radius", "spheres"): doubled_balls,
    ("ambient", 0.5): lambda scene: scene.replace(scene.ambient, brightness=scene.ambient.brightness / 2),
}
SWAPPED = "colours", "swapped"


@pytest.mark.parametrize(
    "causes",
    [
        [("fov", "vertical"), SWAPPED],
        [("mirrored", True), ("ambient", 0.5)],
        [("cylinder", "base"), ("radius", "spheres")],
    ],
)
def test_what_an_edited_scene_shows_is_named(causes: list[tuple[str, object]], tmp_path: Path) -> None:
    scene = edited = student_scene(7)
    for cause in causes:
        edited = EDITED[cause](edited) if cause in EDITED else edited
    levels = rendered(edited)[..., :: -1 if SWAPPED in causes else 1]
    found = compared(scene, levels, tmp_path)
    assert {(each.name, each.value) for each in found.causes} == {*causes}
    assert (found.explained > 0.99, found.sure, "likely" in str(found)) == (True, True, False)


@pytest.mark.parametrize(
    ("seed", "names"),
    [
        (1, ["direction angles"]),
        (2, ["fov equal angles"]),
        (3, ["direction position added"]),
        (0, ["axis in the formula", "gamma 2.2"]),
        (0, ["cone both halves", "diffuse brightness squared"]),
        (1, ["up z", "cone whole angle"]),
        (2, ["pixel corner", "ambient not in shadow"]),
        (4, ["axis not normalised", "fading 1"]),
        (4, ["mirrored True", "fading 1/(1 + 0.1 distance)"]),
        (6, ["cylinder doubled", "shadows none"]),
        (8, ["cylinder turned", "reflections True"]),
        (11, ["background gradient", "fading linear"]),
        (2042, ["inside False", "flipped True"]),
    ],
)
def test_planted_causes_are_named_alone_and_in_pairs(seed: int, names: list[str], tmp_path: Path) -> None:
    scene, rows = student_scene(seed), [ROWS[name] for name in names]
    assert are_visible(scene, rows)
    found = compared(scene, draw(scene, merged(rows)), tmp_path)
    assert (*judged(rows, found), found.sure) == (True, False, True)


# What no row of the table says, so that a wrong cause explains nearly all of it.
def from_behind(scene: Scene, step: float) -> Bytes:
    """Draw a scene from an eye that lies behind the camera's position."""
    camera = scene.camera
    eye = tuple(p - step * d for p, d in zip(camera.position, camera.direction, strict=True))
    return rendered(scene.replace(camera, position=eye))


def bent(scene: Scene, power: float) -> Bytes:
    return np.rint(255 * (rendered(scene) / 255) ** power).astype(np.uint8)


WRONG = [
    (7, from_behind, 0.3),
    (0, from_behind, 0.3),
    (1, from_behind, 1.0),
    (7, bent, 1.1),
    (0, bent, 0.93),
    (2, bent, 0.93),
]


@pytest.mark.parametrize(("seed", "drawn", "number"), WRONG)
def test_a_wrong_cause_is_no_fact(
    seed: int, drawn: Callable[[Scene, float], Bytes], number: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = student_scene(seed)
    theirs = drawn(scene, number)
    found = compared(scene, theirs, tmp_path)
    assert found.causes
    assert found.explained > 0.96
    assert (found.sure, found.json()["sure"]) == (False, False)
    assert "; most likely th" in str(found)
    x, y = found.rest[0].pixel
    under = pictures.explained(scene, theirs, found.guess)
    assert pictures.distance(under, theirs)[y, x] > pictures.EXACT
    exact, close = (lighting.LEVEL * (levels + 0.5) for levels in pictures.tolerances(is_lossy=False))
    judge = Judge(Case(scene, theirs / 255), found.guess, close)
    assert not judge.is_right(exact)
    for border in ("MOST_INEXACT", "MOST_AT_EDGES"):  # by the share that is explained alone, it would be one
        monkeypatch.setattr(f"minirt.compare.judge.{border}", 1.0)
    assert judge.is_right(exact)


def test_a_camera_that_looks_elsewhere_is_told(tmp_path: Path) -> None:
    scene = student_scene(7)
    found = compared(scene, draw(scene, OURS | {"pitch": 9.0}), tmp_path)
    (cause,) = found.causes
    assert (cause.name, found.explained > 0.96) == ("direction", True)
    assert np.dot(cause.value, frame(scene.camera, OURS | {"pitch": 9.0})[2]) == pytest.approx(1, abs=1e-3)


def test_equal_pictures_are_told(tmp_path: Path) -> None:
    scene = student_scene(0)
    assert str(compared(scene, rendered(scene), tmp_path)) == "The pictures are equal."
    smooth = compared(scene, rendered(scene, samples=16), tmp_path)
    assert (smooth.equal, str(smooth)) == (True, "The pictures are equal, but at edges.")
    Image.fromarray(rendered(scene)).save(tmp_path / "theirs.jpg", quality=90)
    assert minirt.compare(scene, tmp_path / "theirs.jpg").equal


def test_what_cannot_be_known_is_not_guessed(tmp_path: Path) -> None:
    scene = student_scene(0)
    noise = np.random.default_rng(0).integers(0, 256, (*SIZE[::-1], 3)).astype(np.uint8)
    for levels in (noise, rendered(student_scene(1)), np.full_like(noise, 30)):
        found = compared(scene, levels, tmp_path)
        assert (found.equal, found.causes) == (False, ())
        assert found.explained < 0.8
        assert "not known why" in str(found)


def test_black_where_a_guess_expects_shadow_is_no_evidence(tmp_path: Path) -> None:
    """A picture of which a few rows were drawn is nearly explained by a camera that looks elsewhere."""
    scene = student_scene(7)
    levels = rendered(scene.replace(scene.ambient, brightness=0))
    levels[4:] = 0
    found = compared(scene, levels, tmp_path)
    assert (found.causes, "not known why" in str(found)) == ((), True)


def test_borders_and_blocks_are_told(tmp_path: Path) -> None:
    scene = student_scene(0)
    levels = rendered(scene)
    framed = np.pad(levels, ((30, 5), (5, 5), (0, 0)), constant_values=90)
    found = compared(scene, framed, tmp_path)
    assert (found.equal, found.picture.shape) == (True, levels.shape)
    assert "5, 30, 5 and 5 pixels at the left, top, right and bottom" in found.notices[0]
    found = compared(scene, levels.repeat(3, axis=0).repeat(3, axis=1), tmp_path)
    assert (found.equal, found.notices) == (
        True,
        ("Blocks of 3x3 pixels have one colour: 480x270 of them are compared.",),
    )


def test_the_rest_is_where_it_differs(tmp_path: Path) -> None:
    scene = student_scene(7)
    shown = minirt.buffers(scene, *SIZE).shape
    ball = max(scene.spheres, key=lambda each: (shown == scene.shapes.index(each)).sum())
    painted = scene.replace(ball, colour=(0, 0, 0))
    found = compared(scene, rendered(painted), tmp_path)
    assert found.causes == ()
    assert found.rest[0].shape == f"sphere {scene.spheres.index(ball) + 1}"
    x, y = found.rest[0].pixel
    assert (rendered(painted)[y, x] != rendered(scene)[y, x]).any()


def test_the_command_line_prints_and_writes_the_answer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from minirt import cli

    monkeypatch.chdir(tmp_path)
    scene = student_scene(7)
    scene.save(tmp_path / "scene.rt")
    Image.fromarray(rendered(scene.mirrored())).save("mine.ppm")
    assert cli.main(["scene.rt", "--compare", "mine.ppm", "-o", "four.png", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert set(told) == {"equal", "explained", "sure", "causes", "rest", "notices"}
    assert (told["equal"], told["causes"][0]["name"], told["causes"][0]["value"]) == (False, "mirrored", True)
    four = np.asarray(Image.open("four.png"))
    width, gap = SIZE[0], pictures.GAP
    theirs, reference, under, difference = (four[:, i * (width + gap) : i * (width + gap) + width] for i in range(4))
    assert (theirs == rendered(scene.mirrored())).all()
    assert (reference == rendered(scene)).all()
    assert (pictures.distance(under, theirs) > 1).mean() < 1e-3
    assert (difference > 8).mean() < 1e-3
    assert cli.main(["scene.rt", "--compare", "none.ppm"]) == 1
    assert "none.ppm" in capsys.readouterr().err


def test_rows_of_the_table_differ_and_change_known_parameters() -> None:
    assert len(ROWS) == len(TABLE)
    for row in TABLE:
        assert set(row.changes) <= set(OURS)
        assert all(OURS[name] != value for name, value in row.changes.items())


PROGRAM = """
void *mlx_init(void);
void *mlx_new_window(void *, int, int, char *);
int mlx_pixel_put(void *, void *, int, int, int);
int mlx_loop(void *);
int mlx_loop_hook(void *, int (*)(), void *);
int mlx_string_put(void *, void *, int, int, int, char *);
void *mlx, *window;
int row;
int draw_row(void *unused)
{
    (void)unused;
    if (row < 20)
        mlx_pixel_put(mlx, window, 1, row++, 0x102030);
    return 0;
}
int main(void)
{
    mlx = mlx_init();
    window = mlx_new_window(mlx, 3, 20, "");
    mlx_string_put(mlx, window, 0, 0, 0xffffff, "text");
    mlx_loop_hook(mlx, draw_row, 0);
    return mlx_loop(mlx);
}
"""


def test_the_stub_of_minilibx_writes_the_window(tmp_path: Path) -> None:
    compiler = shutil.which("cc") or skip_incomplete("needs a C compiler")
    stub = subprocess.run([sys.executable, "-m", "minirt.compare", "stub"], capture_output=True, check=True).stdout
    (tmp_path / "mlx_stub.c").write_bytes(stub)
    (tmp_path / "main.c").write_text(PROGRAM)
    subprocess.run([compiler, "-Wall", "-Werror", "main.c", "mlx_stub.c", "-o", "mini"], cwd=tmp_path, check=True)
    subprocess.run(["./mini"], cwd=tmp_path, env={"MLX_PICTURE": "mine.ppm"}, check=True)
    levels = np.asarray(Image.open(tmp_path / "mine.ppm"))
    assert levels.shape == (20, 3, 3)
    assert (levels[:, 1] == [16, 32, 48]).all()  # each of the rows, of which the program draws one at each turn
    assert levels.sum() == 20 * 96


def test_the_example_of_the_page_is_what_the_program_prints() -> None:
    found = minirt.compare(minirt.load(ROOT / "scenes/figure-v6-shadows.rt"), ROOT / "assets/compare-theirs.png")
    page = (PACKAGE / "compare" / "README.md").read_text(encoding="utf-8")
    assert f"```\n{found}\n```" in page
    assert (pictures.distance(found.panels(), np.asarray(Image.open(ROOT / "assets/compare.png"))) <= 1).all()
