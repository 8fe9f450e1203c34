"""POV-Ray draws our scenes, and its pictures converge to ours."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from minirt.errors import RenderError
from minirt.materials import Checker, Specular
from minirt.report.crops import Crops
from minirt.report.metrics import rmse
from minirt.report.pictures import reference
from minirt.scene import Background, FurtherLight, ParallelLight, Scene, dump
from tests.bench.measure import MissingError, Setting
from tests.bench.peers import povray
from tests.bench.peers.povray import GRID, OPTIONS, Antialiased, translated
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, MORE, SHAPES

SIZE = 96, 64
WHITE = (255, 255, 255)
CONE, DISC, TRIANGLE = MORE[0], MORE[5], MORE[3]
BALL = SHAPES[1]
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
    with pytest.raises(MissingError, match="povray is not installed"):
        Antialiased(ALL, 16, 9, 1, tmp_path)


@installed
def test_its_pictures_converge_to_ours(tmp_path: Path) -> None:
    right, other = reference(SCENE, Crops(64, 96), 256, seed=3), Antialiased(SCENE, *SIZE, 1, tmp_path)
    other.check(right)
    one, nine, recursive = (
        rmse(other.drawn(options)[1], right.picture)
        for options in ("-A", GRID.format(3), OPTIONS["POV-Ray adaptive A0.03"])
    )
    assert one > 2.5 * nine
    assert recursive < 0.5 * one


@installed
def test_a_picture_of_something_else_is_refused(tmp_path: Path) -> None:
    """A reference with the ball moved by a tenth of its size."""
    x, y, z = BALL.centre
    right = reference(SCENE.replace(SCENE.shapes[1], centre=(x + 0.24, y, z)), Crops(64, 96), 64, seed=3)
    with pytest.raises(RenderError, match="POV-Ray shows something else: RMSE 0"):
        Antialiased(SCENE, *SIZE, 1, tmp_path).check(right)


def test_a_program_that_fails_is_told(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match="POV-Ray failed"):
        Antialiased(ALL, 16, 9, 1, tmp_path, "false").drawn("-A")


@installed
def test_the_table_has_a_row_for_each_way(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(povray, "OPTIONS", {"POV-Ray 1": "-A"})
    (tmp_path / "scene.rt").write_text(dump(SCENE))
    head, *rows = povray.errors(tmp_path / "scene.rt", Setting(*SIZE, 1, tmp_path), 64).splitlines()
    assert head.split() == ["scene,", "ms", "and", "RMSE"]
    assert [row.rsplit(maxsplit=2)[0] for row in rows] == [
        *(f"miniRT {each.name}" for each in povray.OURS),
        "POV-Ray 1",
    ]
    ours, theirs = float(rows[0].split()[-1]), float(rows[-1].split()[-1])
    assert theirs == pytest.approx(ours, rel=0.05)  # both have one sample, in the centre of each pixel
