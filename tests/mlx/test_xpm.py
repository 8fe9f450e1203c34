"""XPM pictures: colours in all spellings, and what is wrong with a broken file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from minirt.mlx import Mlx, MlxError
from minirt.mlx.memory import Memory
from minirt.mlx.x11_colours import names
from minirt.mlx.xpm import read_xpm, strings_of

if TYPE_CHECKING:
    from pathlib import Path


def colour(definition: str) -> int:
    """Return the colour 0xAARRGGBB of a picture of one pixel."""
    return int(read_xpm(["1 1 1 1", f". {definition}", "."]).view("<u4")[0, 0, 0])


@pytest.mark.parametrize(
    ("definition", "expected"),
    [
        ("c #102030", 0xFF102030),
        ("c #FFFFFF", 0xFFFFFFFF),
        ("c #abc", 0xFFAABBCC),
        ("c #123456789", 0xFF124578),
        ("c #FFFF80800000", 0xFFFF8000),
        ("c red", 0xFFFF0000),
        ("\tc\tLight Goldenrod", 0xFFEEDD82),
        ("c SeaGreen3", 0xFF43CD80),
        ("c gray", 0xFFBEBEBE),
        ("c grey30", 0xFF4D4D4D),
        ("c green", 0xFF00FF00),
        ("c None", 0),
        ("s none c none", 0),
        ("s roof c #010203", 0xFF010203),
        ("s red m white c blue", 0xFF0000FF),
        ("m black g4 #888888 c #00ff00", 0xFF00FF00),
        ("m black g #777777 g4 #888888", 0xFF777777),
        ("g4 #888888 m black", 0xFF888888),
    ],
)
def test_colours(definition: str, expected: int) -> None:
    assert colour(definition) == expected


@pytest.mark.parametrize("definition", ["c nocolour", "c #12", "c #12345678", "s roof", "", "m"])
def test_unknown_colours_raise(definition: str) -> None:
    with pytest.raises(MlxError, match="colour"):
        colour(definition)


def test_names_of_x11() -> None:
    assert len(names()) > 650
    assert names()["gray50"] == names()["grey50"] == 0x7F7F7F
    assert names()["antiquewhite4"] == 0x8B8378


def test_characters_of_any_number_and_quotes_are_colours() -> None:
    lines = ["2 2 3 3 0 1 XPMEXT", 'a"b c red', '  " c blue', "... c None", 'a"b...', '...  "']
    assert read_xpm(lines).view("<u4")[..., 0].tolist() == [[0xFFFF0000, 0], [0, 0xFF0000FF]]


def test_comments_and_escapes_are_those_of_c() -> None:
    source = r"""/* "no" */ static char *a[] = { // "not this"
"1 1 1 1", /* values */ "\" c #000000", "//", "\\" };"""
    assert strings_of(source) == ["1 1 1 1", '" c #000000', "//", "\\"]


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ([], "begins with"),
        (["1 1 x 1"], "begins with"),
        (["0 1 1 1"], "0x1"),
        (["1 1 1 1", "a c red"], "announced"),
        (["1 2 1 1", "a c red", "a", "b"], "row 2"),
        (["2 1 1 1", "a c red", "a"], "row 1"),
    ],
)
def test_broken_pictures_raise(lines: list[str], message: str) -> None:
    with pytest.raises(MlxError, match=message):
        read_xpm(lines)


def test_strings_and_files_become_images(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    m = Mlx(Memory())
    mlx = m.mlx_init()
    lines = ["2 1 2 1", "a c #010203", "b c None", "ab"]
    file = tmp_path / "a.xpm"
    file.write_text("/* XPM */\nstatic char *a[] = {\n" + ",\n".join(f'"{line}"' for line in lines) + "\n};\n")
    for image, width, height in (m.mlx_xpm_to_image(mlx, lines), m.mlx_xpm_file_to_image(mlx, str(file))):
        assert (width, height) == (2, 1)
        assert bytes(m.mlx_get_data_addr(image)[0]) == bytes((3, 2, 1, 255, 0, 0, 0, 0))
    assert capsys.readouterr().err == ""
    assert m.mlx_xpm_to_image(mlx, lines[:-1]) == (None, 0, 0)
    assert m.mlx_xpm_file_to_image(mlx, "none.xpm") == (None, 0, 0)
    assert "none.xpm" in capsys.readouterr().err
