"""Strict grammar of scene files, written from the format's description: the referee of the parser, with which it shares
nothing else. A table of elements, and each kind of field with its predicate and its maker of random words."""

from __future__ import annotations

import math
import random
import re
import tempfile
import unicodedata
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from PIL import Image

PICTURES, MESHES = ("a.png", "maps/b+1.png"), ("ball.obj",)
FOLDER = tempfile.TemporaryDirectory(prefix="minirt-fuzz-")


@cache
def folder() -> Path:
    """Return the folder, with its files."""
    made = Path(FOLDER.name)
    for name in PICTURES:
        (made / name).parent.mkdir(exist_ok=True)
        Image.new("RGB", (4, 2), (200, 120, 40)).save(made / name)
    for name in MESHES:
        (made / name).write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n")
    return made


def exists(name: str, suffix: str) -> bool:
    """Whether a scene in the folder can name a file so, with this suffix."""
    try:
        path = folder() / name
        return bool(name) and path.is_file() and path.suffix == suffix
    except (OSError, ValueError):
        return False


NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
WHOLE = re.compile(r"[+-]?\d+", re.ASCII)
LONGEST, LEAST, FARTHEST = 300, 1e-50, 1e15
EDGES = (
    "0", "1", "-1", "0.5", "180", "255", "1e15", "-1e15", "5e-324", "1e-50", "1e-400", "1e400", "360", "+1", "1.", ".5",
)  # fmt: skip

Chance = random.Random
Test = Callable[[str], bool]


class Kind(NamedTuple):
    """A kind of word: whether a text is one, a maker of such texts, and how many parts with commas it has."""

    fits: Test
    make: Callable[[Chance], str]
    width: int = 1


def value_of(text: str) -> float:
    """Return the value of a number; NaN for what is none."""
    value = float(text) if len(text) <= LONGEST and NUMBER.fullmatch(text) else math.nan
    return value if math.isfinite(value) else math.nan


def number(chance: Chance) -> str:
    """Return a number."""
    if chance.random() < 0.3:
        return chance.choice(EDGES)
    return chance.choice(("{:.3f}", "{!r}", "{:e}", "{:g}")).format(chance.choice((1, 10, 100)) * chance.uniform(-1, 1))


def between(low: float, high: float) -> Kind:
    """Return the kind of a number in an interval, both ends included."""
    return Kind(
        lambda text: low <= value_of(text) <= high,
        lambda chance: repr(chance.choice((low, high, chance.uniform(low, high), chance.uniform(low, high)))),
    )


def whole(low: int, high: int) -> Kind:
    """Return the kind of a whole number in an interval."""
    return Kind(
        lambda text: len(text) <= LONGEST and bool(WHOLE.fullmatch(text)) and low <= int(text) <= high,
        lambda chance: str(chance.randint(low, high)),
    )


def one_of(words: Sequence[str], fits: Test | None = None) -> Kind:
    """Return the kind of a word among some, or of what `fits`."""
    return Kind(fits or words.__contains__, lambda chance: chance.choice(words))


def three(part: Kind) -> Kind:
    """Return the kind of three parts with commas between them."""
    return Kind(
        lambda text: text.count(",") == 2 and all(map(part.fits, text.split(","))),
        lambda chance: ",".join(part.make(chance) for _ in range(3)),
        3,
    )


def parts(*kinds: Kind, least: int) -> Kind:
    """Return the kind of values with commas between them, of which the last ones may be left out."""

    def fits(text: str) -> bool:
        words, count = text.split(","), 0
        for kind in kinds:
            if not words and count >= least:
                return True
            if len(words) < kind.width or not kind.fits(",".join(words[: kind.width])):
                return False
            words, count = words[kind.width :], count + 1
        return not words

    return Kind(fits, lambda chance: ",".join(each.make(chance) for each in kinds[: chance.randint(least, len(kinds))]))


def without_homogeneous_zero(text: str) -> str:
    """Return a direction without its fourth component, if that is 0."""
    head, _, last = text.rpartition(",")
    return head if text.count(",") == 3 and value_of(last) == 0 else text


def is_direction(text: str) -> bool:
    """Whether a text is a direction."""
    return may_be_zero.fits(text) and any(map(value_of, without_homogeneous_zero(text).split(",")))


ratio, colour, component = between(0, 1), three(whole(0, 255)), three(between(-1, 1))
length = Kind(
    lambda text: LEAST <= value_of(text) <= FARTHEST,
    lambda chance: repr(chance.choice((LEAST, 1e-9, 1e15, *[abs(chance.gauss(0, 3)) + 0.01] * 9))),
)
point, lengths = three(between(-FARTHEST, FARTHEST)._replace(make=number)), three(length)
may_be_zero = component._replace(fits=lambda text: component.fits(without_homogeneous_zero(text)))  # of a camera
direction = component._replace(fits=is_direction)
angle = between(0, 180)._replace(make=whole(0, 180).make)
picture, mesh = one_of(PICTURES, lambda text: exists(text, ".png")), one_of(MESHES, lambda text: exists(text, ".obj"))
paint = Kind(
    lambda text: (colour if "," in text else picture).fits(text),
    lambda chance: chance.choice((colour, picture)).make(chance),
)

KEY = re.compile(r"(pattern:[a-z]+(?=,|\Z)|[A-Za-z_]+(?=:))[:,]?(.*)", re.DOTALL)
HEX_COLOUR = re.compile(r"#([0-9A-Fa-f]{3}){1,2}([ \t]|$)")
SURE, FLAT = 1e-13, 1e-17  # shares of the size of a triangle: higher is a triangle, lower is a line
LARGE = 1e14  # scale and place of a mesh, all of which must be within FARTHEST
SMALLEST = 1e-140  # size of a triangle whose area a float64 can hold

TURN, HEIGHT, FADE = between(-360, 360), between(-10, 10), between(0, FARTHEST)
PATTERN = parts(length, colour, whole(1, 12), HEIGHT, least=1)
SURFACE: dict[str, Kind] = {
    "specular spc": parts(ratio, between(1, 1e6), one_of(("blinn",)), least=2),
    "mirror mir": parts(ratio, FADE, least=1),
    "glass ref": parts(between(1, 10), ratio, FADE, least=1),
    "tint": parts(colour, length, least=1),
    "fresnel": ratio,
    "glow": ratio,
    "checker pat": parts(length, colour, least=1),
    "texture txm tx": picture,
    "bump bum": parts(picture, HEIGHT, least=1),
    "normal nm": picture,
    "uv": parts(length, length, *[between(-1e6, 1e6)] * 2, TURN, least=2),
    **{f"{name} pattern:{name}": PATTERN for name in ("marble", "wood", "clouds")},
}
ROLL = {"roll": TURN}
TURNED = SURFACE | ROLL
AXIS = TURNED | {"axis": direction}
CAMERA = ROLL | {
    "tone": one_of(("plain", "srgb", "filmic")), "exposure": between(-20, 20), "lens": length, "focus": length
}  # fmt: skip
LAMP: dict[str, Kind] = {"reach fade": length, "size": length}
SOLID = [point, direction, length, length, colour]  # with an axis
BARE = {"fresnel", "checker"}  # keys that may stand alone

Element = tuple[list[Kind], int, dict[str, Kind]]  # fields, how many of them must be given, attributes
ELEMENTS: dict[str, Element] = {
    "R": ([whole(1, 16384)] * 2, 2, {}),
    "A": ([ratio, colour], 2, {}),
    "bg": ([paint], 1, {}),
    "C": ([point, may_be_zero, angle], 3, CAMERA),
    "L": ([point, ratio, colour], 2, LAMP),
    "l": ([point, ratio, colour], 2, LAMP),
    "dl": ([direction, ratio, colour], 2, {"size": between(0, 90)}),
    "sl": ([point, direction, angle, ratio, colour], 4, LAMP | {"rim": ratio}),
    "sp": ([point, length, colour], 3, AXIS),
    "pl": ([point, direction, colour], 3, TURNED),
    "cy": (SOLID, 5, TURNED),
    "co cn cone": (SOLID, 5, TURNED),
    "pa": (SOLID, 5, TURNED),
    "hy": ([*SOLID[:4], length, colour], 6, TURNED),
    "tr tri": ([point, point, point, colour], 4, SURFACE),
    "sq": ([point, direction, length, colour], 4, TURNED),
    "di": ([point, direction, length, colour], 4, TURNED),
    "bo": ([point, direction, lengths, colour], 4, TURNED),
    "to": (SOLID, 5, TURNED),
    "el": ([point, direction, lengths, colour], 4, TURNED),
    "ob obj": ([mesh, point, length, colour], 4, AXIS),
}
CODES = {spelling: names.split()[0] for names in ELEMENTS for spelling in names.split()}
FORMS = {names.split()[0]: element for names, element in ELEMENTS.items()}
ONCE = {"R", "A", "bg", "C", "L"}


def is_scene(data: bytes) -> bool | None:
    """Whether a strict reader accepts a file; None where the description leaves it open."""
    try:
        text = data.decode()
    except UnicodeDecodeError:
        return False
    if "\0" in text:
        return False
    lines = text.removeprefix("\ufeff").split("\n")
    codes = [code_of(line.removesuffix("\r")) for line in lines]
    if "wrong" in codes or any(codes.count(code) > 1 for code in ONCE) or not {"A", "C"} <= set(codes):
        return False
    return None if "open" in codes else True


def code_of(line: str) -> str:
    """Return the identifier of a line, "" for a line without an element, or "wrong", or "open"."""
    body, comment, rest = line.partition("#")
    if "\r" in line or any(is_foreign(character) for character in body):
        return "wrong"
    words = [word for word in re.split("[ \t]+", body) if word]
    if not words:
        return ""
    if any(word.startswith("//") for word in words) or CODES.get(words[0]) is None:
        return "wrong"
    values = words[1:]
    if any(a.endswith(",") or b.startswith(",") for a, b in pairwise(values)):
        return "wrong"
    return verdict(CODES[words[0]], values, comment + rest)


def is_foreign(character: str) -> bool:
    """Whether a character may stand in no word and between none."""
    return character not in " \t" and unicodedata.category(character)[0] in "CZ"


def verdict(code: str, words: list[str], comment: str) -> str:
    """Return the identifier of an element with these words, or "wrong", or "open"."""
    fields, least, attributes = FORMS[code]
    keys = {key: names for names in attributes for key in names.split()}
    first = next((at for at, word in enumerate(words) if KEY.match(word) or is_bare(word, keys)), len(words))
    values, keyed = words[:first], words[first:]
    if not least <= len(values) <= len(fields):
        return "wrong"
    if len(values) < len(fields) and HEX_COLOUR.match(comment):  # '#' begins a comment, and no colour
        return "wrong"
    if not all(kind.fits(value) for kind, value in zip(fields, values, strict=False)):
        return "wrong"
    seen = set()
    for word in keyed:
        match = KEY.match(word)
        names = keys.get(match[1] if match else word)
        if names is None or names in seen or not (match or is_bare(word, keys)):
            return "wrong"
        if match and not attributes[names].fits(match[2]):
            return "wrong"
        seen.add(names)
    return fitting(code, values)


def is_bare(word: str, keys: dict[str, str]) -> bool:
    """Whether a word is an attribute without a value."""
    return word in keys and keys[word].split()[0] in BARE


def fitting(code: str, values: list[str]) -> str:
    """Return the identifier of an element, or "wrong" or "open", by what its values must be to each other."""
    if code == "hy":
        return code if value_of(values[2]) <= value_of(values[3]) else "wrong"
    if code == "to":
        return code if value_of(values[3]) <= value_of(values[2]) else "wrong"
    if code == "ob":
        return (
            code
            if value_of(values[2]) < LARGE and all(abs(value_of(x)) < LARGE for x in values[1].split(","))
            else "open"
        )
    if code == "tr":
        corners = [[Fraction(value_of(part)) for part in corner.split(",")] for corner in values[:3]]
        height = flatness(*corners)
        if max(abs(p - q) for p, q in zip(corners[0] * 2, corners[1] + corners[2], strict=True)) < SMALLEST:
            return "open"
        return code if height > SURE else "wrong" if height <= FLAT else "open"
    return code


def flatness(a: list[Fraction], b: list[Fraction], c: list[Fraction]) -> float:
    """Return the doubled area of a triangle, in units of its longest edge times its farthest coordinate."""
    edges = [[q - p for p, q in zip(*ends, strict=True)] for ends in ((a, b), (b, c), (c, a))]
    (ux, uy, uz), (vx, vy, vz) = edges[0], edges[1]
    area = (uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2
    longest, largest = max(sum(part**2 for part in edge) for edge in edges), max(map(abs, (*a, *b, *c)))
    return math.sqrt(area / (longest * largest**2)) if area else 0.0
