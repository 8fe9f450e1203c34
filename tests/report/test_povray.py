"""POV-Ray's scene is that of miniRT, or the reason why not is told."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from minirt.errors import RenderError
from minirt.materials import Checker, Specular
from minirt.report import povray
from minirt.report.pictures import Budget, reference
from minirt.report.povray import SETTINGS, PovRay, translated
from minirt.scene import Background, FurtherLight, ParallelLight, Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, MORE, SHAPES

WHITE = (255, 255, 255)
CONE, DISC, TRIANGLE = MORE[0], MORE[5], MORE[3]
BALL = SHAPES[1]
BUDGET = Budget(0.0, 9.0, tries=1)
SCENE = Scene((AMBIENT, EYE, LAMP, Background((20, 40, 80)), *SHAPES, CONE, DISC, TRIANGLE)).replace(
    BALL, specular=Specular(0.4, 30.0)
)
installed = pytest.mark.skipif(not shutil.which("povray"), reason="needs POV-Ray")


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        (Scene((*ALL.elements, ParallelLight((0, -1, 0), 0.5, WHITE))), "parallel"),
        (Scene((*ALL.elements, FurtherLight((0, 9, 0), 0.5, WHITE, fade=9.0))), "fading"),
        (Scene((*ALL.elements, MORE[2])), "hyperboloids"),
        (ALL.replace(ALL.shapes[1], checker=Checker(0.1, WHITE)), "material checker "),
        (Scene((*ALL.elements, Background("sky.png"))), "picture as background"),
    ],
)
def test_what_is_not_the_same_there_is_refused(scene: Scene, reason: str) -> None:
    with pytest.raises(match=reason):
        list(translated(scene, 16, 9))


def test_numbers_keep_all_their_digits() -> None:
    text = "\n".join(translated(ALL.replace(BALL, diameter=2 / 3), 16, 9))
    assert f"{1 / 3!r} pigment" in text
    assert "-0.0," not in text


def test_where_it_is_not_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(RenderError, match="POV-Ray is not installed"):
        PovRay(ALL, 16, 9, 1, tmp_path)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fewer settings."""
    monkeypatch.setattr(povray, "SETTINGS", (SETTINGS[0], SETTINGS[2], SETTINGS[6]))


@installed
@pytest.mark.usefixtures("few")
def test_its_pictures_converge_to_ours(tmp_path: Path) -> None:
    right = reference(SCENE, 96, 64, 256, seed=3)
    rows = {row.name: row for row, _ in PovRay(SCENE, 96, 64, 1, tmp_path).rows(right, BUDGET, lambda name: None)}
    one, nine, recursive = rows.values()
    assert (one.program, one.label, recursive.label) == ("POV-Ray", "1", "A0.03")
    assert one.rmse > 2.5 * nine.rmse
    assert recursive.rmse < 0.5 * one.rmse
    assert all(row.wall_ms > 0 for row in rows.values())


@installed
@pytest.mark.usefixtures("few")
def test_a_picture_of_something_else_is_refused(tmp_path: Path) -> None:
    """A reference with the ball moved by a tenth of its size."""
    x, y, z = BALL.centre
    right = reference(SCENE.replace(SCENE.shapes[1], centre=(x + 0.24, y, z)), 96, 64, 64, seed=3)
    with pytest.raises(RenderError, match="POV-Ray shows something else: RMSE 0"):
        list(PovRay(SCENE, 96, 64, 1, tmp_path).rows(right, BUDGET, lambda name: None))


def test_a_program_that_fails_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: "povray")
    monkeypatch.setattr(povray, "COMMAND", ("false",))
    with pytest.raises(RenderError, match="POV-Ray failed"):
        list(PovRay(ALL, 16, 9, 1, tmp_path).rows(reference(ALL, 16, 9, 2, seed=3), BUDGET, lambda name: None))
