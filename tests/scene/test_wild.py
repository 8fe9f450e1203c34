"""Scenes in the dialects of other miniRT programs are read with the meaning that they have there.

The folder `wild/meaning` has the same scenes in the words of this program, in the order of their lines.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from minirt.errors import SceneError
from minirt.scene import load, parse

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
