"""XPM pictures have the pixels that Pillow finds in them, and no line of Python looks at each pixel."""

from __future__ import annotations

import io
import random
import string
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest
from PIL import Image

from minirt.errors import FileError
from minirt.materials import picture_cache, xpm
from tests.scene.test_files import lines_run

CHARACTERS = sorted(set(string.printable) - set(string.whitespace) - set('"\\'))


def source(values: str, colours: list[str], rows: list[str]) -> bytes:
    """Return the file of an XPM picture."""
    strings = ",\n".join(f'"{each}"' for each in (values, *colours, *rows))
    return f"/* XPM */\nstatic char *picture[] = {{\n{strings}\n}};\n".encode()


def random_picture(seed: int) -> bytes:
    """Return the file of a random picture: up to 400 colours, 1 to 8 characters a pixel."""
    chance = random.Random(seed)
    length = 1 + seed % 8
    count, width, height = chance.randint(1, 50 if length == 1 else 400), chance.randint(1, 9), chance.randint(1, 9)
    keys = list({"".join(chance.choices(CHARACTERS, k=length)): None for _ in range(count)})
    colours = [f"{key} s name c #{chance.randrange(2**24):06X}" for key in keys]
    colours[0] = f"{keys[0]} c None"
    rows = ["".join(chance.choices(keys, k=width)) for _ in range(height)]
    return source(f"{width} {height} {len(keys)} {length}", colours, rows)


def pixels_of(data: bytes) -> np.ndarray:
    """Return the pixels of a file."""
    strings = xpm.strings_of(data)
    return xpm.read_pixels(strings, xpm.read_header(strings))


def compare_with_pillow() -> None:
    """Compare random pictures with Pillow's reading; AssertionError for a difference."""
    for seed in range(64):
        data = random_picture(seed)
        with patch.object(xpm, "BAND", 20):
            assert np.array_equal(pixels_of(data), Image.open(io.BytesIO(data)).convert("RGB"))


def test_the_pixels_are_those_that_pillow_finds() -> None:
    compare_with_pillow()


def without_the_last_character(text: bytes, length: int) -> np.ndarray:
    """Stand in for `codes_of`: tell pixels apart by all characters but the last."""
    codes = right_codes(text, length)
    return codes & codes.dtype.type(2 ** (8 * max(1, length - 1)) - 1)


right_codes, right_colour, right_places = xpm.codes_of, xpm.colour, xpm.places_of
WRONG = {
    "codes_of": without_the_last_character,
    "colour": lambda text: right_colour(text)[::-1],
    "places_of": lambda keys: np.roll(right_places(keys), 1),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_reader_is_found(name: str) -> None:
    with patch.object(xpm, name, WRONG[name]), pytest.raises((AssertionError, xpm.XpmError)):
        compare_with_pillow()


@pytest.mark.parametrize(
    ("definition", "expected"),
    [
        ("c #102030", (16, 32, 48)),
        ("c #abc", (170, 187, 204)),
        ("m #000000 c #FFFF80800000", (255, 128, 0)),
        ("s c c #123456789", (18, 69, 120)),
        ("c none", (0, 0, 0)),
    ],
)
def test_colours(definition: str, expected: tuple[int, int, int]) -> None:
    assert tuple(pixels_of(source("1 1 1 1", [f". {definition}"], ["."]))[0, 0]) == expected


@pytest.mark.parametrize("length", [1, 2, 3])
def test_no_line_of_python_looks_at_each_pixel(length: int) -> None:
    lines = []
    for width in (10, 10_000):
        data = source(
            f"{width} 20 2 {length}",
            ["a" * length + " c #123456", "b" * length + " c None"],
            ["a" * width * length] * 20,
        )
        with lines_run() as count:
            pixels_of(data)
        lines.append(count())
    assert lines[0] == lines[1] > 20


BROKEN = {
    b"/* XPM */": "expected a header such as '16 16 2 1', got ''",
    source("2 x 1 1", [], []): "expected a header such as '16 16 2 1', got '2 x 1 1'",
    source("1 1 0 1", [], []): "it has 0 colours, and may have 1 to 262144",
    source("1 1 262145 1", [], []): "it has 262145 colours, and may have 1 to 262144",
    source("1 1 1 9", [], []): "a pixel has 9 characters, and may have 1 to 8",
    source("1 1 2 1", ["a c #123456"], []): "it has 1 colours of 2",
    source("1 1 1 1", ["a c red"], ["a"]): "expected a colour such as 'c #FF8000' or 'c None', got 'c red'",
    source("1 1 1 1", ["a" + " " * 2**20 + "c None"], ["a"]): "got 'c None'",
    source("1 1 1 1", ["a c #12"], ["a"]): "got 'c #12'",
    source("2 2 1 1", ["a c None"], ["aa"]): "it has 1 rows of 2",
    source("2 2 1 1", ["a c None"], ["aa", "a"]): "row 2 has 1 characters, and should have 2",
    source("2 2 1 1", ["a c None"], ["aa", "aaa"]): "row 2 has 3 characters, and should have 2",
    source("2 2 1 1", ["a c None"], ["aa", "ab"]): "row 2: 'b' is no colour",
    source("2 2 1 2", ["ab c None"], ["abab", "abba"]): "row 2: 'ba' is no colour",
    source("2 1 2 3", ["abc c None", "abd c None"], ["abcabe"]): "row 1: 'abe' is no colour",
}


@pytest.mark.parametrize("data", BROKEN, ids=range(len(BROKEN)))
def test_a_damaged_file_is_refused(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "damaged.xpm").write_bytes(data)
    with pytest.raises(FileError) as caught:
        picture_cache.picture(tmp_path / "damaged.xpm")
    assert caught.value.reason.startswith("is a damaged XPM picture: ")
    assert caught.value.reason.endswith(BROKEN[data])


def test_a_picture_that_would_fill_the_memory_is_refused(tmp_path: Path) -> None:
    (tmp_path / "large.xpm").write_bytes(source("999999999 1 1 1", ["a c None"], []))
    with pytest.raises(FileError, match="has 999999999x1 pixels, more than 8192x8192"):
        picture_cache.picture(tmp_path / "large.xpm")


def test_an_xpm_picture_is_a_texture_and_a_height_map(tmp_path: Path) -> None:
    path = tmp_path / "two.xpm"
    path.write_bytes(source("2 1 2 1", ["a c #FFFFFF", "b c #102030"], ["ab"]))
    assert picture_cache.picture(path).tolist() == [[[255, 255, 255], [16, 32, 48]]]
    assert picture_cache.heights(path)[0] == pytest.approx([1, (0.2126 * 16 + 0.7152 * 32 + 0.0722 * 48) / 255])
