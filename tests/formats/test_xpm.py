"""XPM pictures: the pixels that Pillow finds, colours in all spellings, and what is wrong with a broken file."""

from __future__ import annotations

import io
import random
import string
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt.errors import FileError
from minirt.formats.xpm import XpmError, names, read_header, read_pixels, strings_of
from minirt.materials.pictures import heights, picture
from minirt.mlx import Mlx
from minirt.mlx.memory import Memory

CHARACTERS = sorted(set(string.printable) - set(string.whitespace) - set('"\\'))


def source(values: str, colours: list[str], rows: list[str]) -> bytes:
    """Return the file of an XPM picture."""
    strings = ",\n".join(f'"{each}"' for each in (values, *colours, *rows))
    return f"/* XPM */\nstatic char *picture[] = {{\n{strings}\n}};\n".encode()


def pixels_of(data: bytes) -> np.ndarray:
    """Return the pixels of a file, 0xAARRGGBB."""
    strings = strings_of(data)
    return read_pixels(strings, read_header(strings)).view("<u4")[..., 0]


@pytest.mark.parametrize("length", range(1, 9))
def test_the_pixels_are_those_that_pillow_finds(tmp_path: Path, length: int) -> None:
    for seed in range(4):
        chance = random.Random(f"{length} {seed}")
        count, width, height = chance.randint(1, 50 if length == 1 else 400), chance.randint(1, 9), chance.randint(1, 9)
        keys = list({"".join(chance.choices(CHARACTERS, k=length)): None for _ in range(count)})
        colours = [f"{key} s name c #{chance.randrange(2**24):06X}" for key in keys]
        colours[0] = f"{keys[0]} c None"
        rows = ["".join(chance.choices(keys, k=width)) for _ in range(height)]
        data = source(f"{width} {height} {len(keys)} {length}", colours, rows)
        path = tmp_path / f"{seed}.xpm"
        path.write_bytes(data)
        assert np.array_equal(picture(path), Image.open(io.BytesIO(data)).convert("RGB"))


@pytest.mark.parametrize(
    ("definition", "expected"),
    [
        ("c #102030", 0xFF102030),
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
        ("s red", 0xFFFF0000),
        ("s roof c #010203", 0xFF010203),
        ("s red m white c blue", 0xFF0000FF),
        ("m black g4 #888888 c #00ff00", 0xFF00FF00),
        ("m black g #777777 g4 #888888", 0xFF777777),
        ("g4 #888888 m black", 0xFF888888),
    ],
)
def test_colours(definition: str, expected: int) -> None:
    assert pixels_of(source("1 1 1 1", [f". {definition}"], ["."])) == expected


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("gray50", 0x7F7F7F),
        ("antiquewhite4", 0x8B8378),
        ("skyblue2", 0x7EC0EE),
        ("hotpink3", 0xCD6090),
        ("steelblue4", 0x36648B),
        ("tomato2", 0xEE5C42),
    ],
)
def test_names_of_x11(name: str, expected: int) -> None:
    assert len(names()) == 565
    assert names()[name] == expected


def test_characters_of_any_number_and_quotes_are_colours() -> None:
    data = source("2 2 3 3 0 1 XPMEXT", ['a\\"b c red', '  \\" c blue', "... c None"], ['a\\"b...', '...  \\"'])
    assert pixels_of(data).tolist() == [[0xFFFF0000, 0], [0, 0xFF0000FF]]


def test_comments_and_escapes_are_those_of_c() -> None:
    text = rb"""/* "no" */ static char *a[] = { // "not this"
"1 1 1 1", /* values */ "\" c #000000", "//", "\\" }; /* "nor this """
    assert list(strings_of(text)) == [b"1 1 1 1", b'" c #000000', b"//", b"\\"]


BROKEN = {
    b"/* XPM */": "the first string must be a header such as '16 16 2 1'",
    source("2 x 1 1", [], []): "the first string must be a header such as '16 16 2 1'",
    source("0 1 1 1", [], []): "it has 0x1 pixels",
    source("1 1 0 1", [], []): "it may have 1 to 262144 colours",
    source("1 1 262145 1", [], []): "it may have 1 to 262144 colours",
    source("1 1 1 9", [], []): "a pixel may have 1 to 8 characters",
    source("1 1 2 1", ["a c #123456"], []): "it has 1 of 2 colours",
    source("1 1 1 1", ["a c no"], ["a"]): "colour 1 must be one such as 'c #FF8000', 'c red' or 'c None'",
    source("1 1 1 1", ["a" + " " * 2**20 + "c None"], ["a"]): "'c None'",
    source("1 1 2 1", ["a c red", "b c #12"], ["a"]): "colour 2 must be one such as 'c #FF8000', 'c red' or 'c None'",
    source("1 1 1 1", ["a s roof"], ["a"]): "'c None'",
    source("2 2 1 1", ["a c None"], ["aa"]): "it has 1 of 2 rows",
    source("2 2 1 1", ["a c None"], ["aa", "a"]): "row 2, column 2: expected one of the colours of the picture",
    source("2 2 1 2", ["ab c None"], ["abab", "abba"]): "row 2, column 3: expected one of the colours of the picture",
}


@pytest.mark.parametrize("data", BROKEN, ids=range(len(BROKEN)))
def test_a_damaged_file_is_refused(tmp_path: Path, data: bytes) -> None:
    with pytest.raises(XpmError):
        pixels_of(data)
    (tmp_path / "damaged.xpm").write_bytes(data)
    with pytest.raises(FileError) as caught:
        picture(tmp_path / "damaged.xpm")
    assert caught.value.reason.startswith("is a damaged XPM picture: ")
    assert caught.value.reason.endswith(BROKEN[data])


def test_a_picture_that_would_fill_the_memory_is_refused(tmp_path: Path) -> None:
    (tmp_path / "large.xpm").write_bytes(source("999999999 1 1 1", ["a c None"], []))
    with pytest.raises(FileError, match="has 999999999x1 pixels, more than 8192x8192"):
        picture(tmp_path / "large.xpm")


def test_an_xpm_picture_is_a_texture_and_a_height_map(tmp_path: Path) -> None:
    path = tmp_path / "two.xpm"
    path.write_bytes(source("2 1 2 1", ["a c #FFFFFF", "b c #102030"], ["ab"]))
    assert picture(path).tolist() == [[[255, 255, 255], [16, 32, 48]]]
    assert heights(path)[0] == pytest.approx([1, (0.2126 * 16 + 0.7152 * 32 + 0.0722 * 48) / 255])


def test_strings_and_files_become_images_of_minilibx(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    m = Mlx(Memory())
    mlx = m.mlx_init()
    lines = ["2 1 2 1", "a c #010203", "b c None", "ab"]
    file = tmp_path / "a.xpm"
    file.write_bytes(source(lines[0], lines[1:3], lines[3:]))
    for image, width, height in (m.mlx_xpm_to_image(mlx, lines), m.mlx_xpm_file_to_image(mlx, str(file))):
        assert (width, height) == (2, 1)
        assert bytes(m.mlx_get_data_addr(image)[0]) == bytes((3, 2, 1, 255, 0, 0, 0, 0))
    assert capsys.readouterr().err == ""
    assert m.mlx_xpm_to_image(mlx, lines[:-1]) == (None, 0, 0)
    assert m.mlx_xpm_file_to_image(mlx, "none.xpm") == (None, 0, 0)
    assert "none.xpm" in capsys.readouterr().err
