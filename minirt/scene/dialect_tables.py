"""Tables of the meaning of words of other programs, for `minirt.scene.dialects`, the most frequent first.

Other first words are those of elements if they have another case, or if the title of one begins so.
"""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, degrees, pi, radians, tan
from pathlib import Path
from typing import Any

from minirt.fields import Triple, clamp, cos_and_sin, neat, upright
from minirt.scene.elements import linear_combination, multiple

# Sorts of changes, as notices tell them.
LEFT_OUT = "words that cannot be read here are left out"
SETTINGS = "settings of other programs are left out"
MISSING = "shapes are missing"
INCOMPLETE = "shapes without all of their fields, or with sizes out of range, are missing"
LIGHTS = "lights that cannot be read are left out"
UNREAD = (SETTINGS, MISSING, INCOMPLETE, LIGHTS)
NEAREST = "numbers become the nearest ones that can be there"
PERCENT = "shares from 10 to 100 are percent"
DECIMALS = "decimal commas become points"
NOWHERE = "directions of 0,0,0 become those of this format"
FOURTH = "fourth components are dropped"
JOINED = "blanks and semicolons within values are put right"
NAMED = "names of colours and materials become their R,G,B"
WHITE = "what has no colour is white"
SLASHES = "comments behind // or -- become comments behind #"
DARK = "there is no ambient light, and what no light reaches is black"
ORDER = "fields in another order become those of this format, without turns and second axes"
APEX = "cones begin at their apex and have a diameter; --cone base or --cone angle reads them in another way"
CONVENTION = "{} are read as {} says"
RENAMED = "elements of other names become those of this format"
SECOND = "lights and cameras after the first become further ones"
SHARES = "colours of 0 to 1 become those of 0 to 255"
EXPONENT = "a number behind the colour is taken for a Phong exponent, with a share of 0.5"
REFLECTIVITY = "a number of at most 1 behind the colour is taken for a share of mirrored light"
CHECKERS = "checkers become checker:"
TWO_COLOURS = "checkers of two colours become checker:, with the colour of the shape in place of the first"
PICTURES = "pictures behind the colour become texture:, bump: or normal:"
ABSENT = "pictures that cannot be read are left out"
GLASS = "shares of transparency with an index become glass:"
HIGHLIGHTS = "highlights and mirrors become specular: and mirror:"

# Sorts that tell another way to write. What the others mend is a mistake, such as a number out of range.
DIALECT = (
    *(LEFT_OUT, SETTINGS, MISSING, LIGHTS, DECIMALS, FOURTH, JOINED, NAMED, SLASHES, ORDER, RENAMED),
    *(EXPONENT, REFLECTIVITY, CHECKERS, TWO_COLOURS, PICTURES, ABSENT, GLASS, HIGHLIGHTS),
)

NUMBER = r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?"

# Other names of elements, by their identifiers.
OTHER_NAMES = {
    "bo": "cu cb bx cube cub",
    "ob": "obj tm",
    "di": "ci dk ds disk circle",
    "pa": "pb par",
    "l": "lpt ptl pt lp",
    "c": "cam camera",
    "bg": "sky background",
    "hy": "hb",
    "to": "tor",
}
CODES = {name: code for code, names in OTHER_NAMES.items() for name in names.split()}

# First words of lines that are no shapes; and of a face of a mesh whose points are in the scene.
FACE = "f"
LIGHT = r"sun|spot\w*|\w*(?:light|lamp)\w*|a?rl|sl\w?"
SETTING = (
    r"@?(?:ma?t|mtl|tex|txt?|xpm|bmp|img|sky|set|render|res|max|aa|alias|win|title|name|depth|sampl|thread|pat)\w*[:=]?"
    r"|[A-Z]|[a-z]_\w*|[-|{}/=*+]+.*|@.*"
)


# Other orders of the first fields of an element: its code, a pattern of the letters of the words (v for three numbers,
# n for one, w for others), and the words of the format from all words.
UP = "0,1,0"
LAYOUTS: tuple[tuple[str, str, Callable[..., list[str]]], ...] = (
    ("bo", "vn(?!n)", lambda centre, edge, *rest: [centre, UP, f"{edge},{edge},{edge}", *rest]),
    ("bo", "vvn(?!n)", lambda centre, axis, edge, *rest: [centre, axis, f"{edge},{edge},{edge}", *rest]),
    ("bo", "vnnn|vvv(?![vn])", lambda centre, sizes, *rest: [centre, UP, sizes, *rest]),
    ("bo", "vvv(v|nnn)v", lambda centre, _across, axis, *rest: [centre, axis, *rest]),
    ("el", "vvv(?!v)", lambda centre, sizes, *rest: [centre, UP, sizes, *rest]),
    ("ob", "w$", lambda file: [file, "0,0,0", "1"]),
    ("ob", "wvvv", lambda file, place, _turns, sizes, *rest: [file, place, sizes.split(",")[0], *rest]),
    ("ob", "vvvvw", lambda place, _turns, sizes, colour, file: [file, place, sizes.split(",")[0], colour]),
)


def picture(file: str) -> str:
    """Return the attribute of a picture, which its name tells."""
    name = Path(file).stem.lower()
    key = "normal" if "norm" in name else "bump" if "bump" in name or "height" in name else "texture"
    return f"{key}:{file}"


def highlight(share: float, exponent: float) -> str:
    """Return the attribute of a highlight; none where it cannot be one."""
    return f"specular:{clamp(share, 0, 1):g},{exponent:g}" if exponent >= 1 else ""


def reflected(share: str) -> str:
    """Return the attribute of a mirror; none for no share."""
    value = float(share)
    return f"mirror:{value / 100 if value > 1 else value:g}" if 0 < value <= 100 else ""  # in percent above 1


def two_numbers(first: str, second: str) -> str:
    """Return attributes for two numbers: a share and an exponent, or an exponent and a share of mirrored light."""
    a, b = float(first), float(second)
    if a <= 1 < b:
        return highlight(a, b)
    return f"{highlight(0.5, a)} {reflected(second)}".strip() if b <= 1 < a else ""


def one_number(text: str) -> str:
    """Return the attribute for one number: an exponent above 1, a share of mirrored light up to it."""
    value = float(text)
    return "" if value == 1 else highlight(0.5, value) if value > 1 else reflected(text)  # 1 may be any switch


N, C = r"([-+]?[0-9]*\.?[0-9]+)", r"([0-9.]+,[0-9.]+,[0-9.]+)"
FILE = r"[\"']?([^\"':=; ]+\.(?:xpm|png|jpe?g|ppm|bmp|tga))[\"']?"
USUAL = "#"  # stands for the size of a square that `checker` alone has; no value holds it
CHECKER = r"-?-?(?:ch|chk|cb|cd|checker\w*|chess\w*|pattern|pat|damier)"

# Meanings of one or two words behind the fields: a pattern of the words, with one blank between two, attributes from
# the groups of the pattern ('' for none), and the sort of change.
ROWS: tuple[tuple[str, Callable[..., str], str], ...] = (
    (rf"{N} {N}", two_numbers, EXPONENT),
    (r"([-+]?0*[1-9][0-9]*(?:\.[0-9]*)?)", one_number, EXPONENT),
    (N, one_number, REFLECTIVITY),
    (rf"{CHECKER}[:= ]{C}[:;]{C}(?:[:;]{N})?", lambda _one, two, size: f"checker:{size or USUAL},{two}", TWO_COLOURS),
    (rf"{CHECKER}[:= ]{C}", lambda colour: f"checker:{USUAL},{colour}", CHECKERS),
    (rf"{CHECKER}[:= ]{N}", lambda size: f"checker:{size}", CHECKERS),
    (CHECKER, lambda: "checker", CHECKERS),
    (rf"-?-?(?:b|bu|bum|bump\w*|bm|rb|height\w*)[:= ]{FILE}", lambda file: f"bump:{file}", PICTURES),
    (rf"-?-?(?:n|nm|nor\w*)[:= ]{FILE}", lambda file: f"normal:{file}", PICTURES),
    (rf"(?:-?-?\w+[:= ])?{FILE}", picture, PICTURES),
    (rf"-?-?(?:sh|shin\w*|ns|exp\w*|phong)[:= ]{N}", lambda text: highlight(0.5, float(text)), HIGHLIGHTS),
    (rf"-?-?(?:sp|spc|spec\w*)[:= ]{N}", lambda text: highlight(float(text), 32), HIGHLIGHTS),
    (rf"trans\w*[:= ]{N} (?:ior|refr\w*)[:= ]{N}", lambda share, index: f"glass:{index},{share}", GLASS),
    (rf"-?-?(?:re|rf|refl\w*|mir\w*)[:= ]{N}", reflected, HIGHLIGHTS),
)
GUESSES = EXPONENT, REFLECTIVITY


def turned(angles: Triple) -> Triple:
    """Turn (0, 0, 1) about x, y and z, in this order and right-handed: by shares of half a turn where no number is
    beyond 1, by radians where none is beyond 2 pi, and by degrees otherwise."""
    largest = max(map(abs, angles))
    unit = 1.0
    if largest <= 2 * pi:
        unit = 180.0 if largest <= 1 else 180 / pi
    (a, b), (c, d), (e, f) = (cos_and_sin(unit * angle) for angle in angles)
    x, y, z = a * d, -b, a * c
    return neat((x * e - y * f, x * f + y * e, z))


# Fields of cones whose point is the centre of the base, or whose diameter is half the angle; of cameras whose direction
# is angles or points backwards, or whose picture shows z upright. The second argument is the direction as written.
Meanings = dict[str, Callable[[Any, Triple], dict[str, Any]]]
CONES: Meanings = {
    "base": lambda cone, _: {
        "apex": linear_combination(1.0, cone.apex, cone.height, cone.axis),
        "axis": multiple(-1.0, cone.axis),
    },
    "angle": lambda cone, _: {"diameter": 2 * cone.height * tan(radians(cone.diameter))},
}
CAMERAS: Meanings = {
    "angles": lambda _, written: {"direction": turned(written)},
    "reversed": lambda camera, _: {"direction": multiple(-1.0, camera.direction)},
    "z-up": lambda camera, _: {"roll": round(degrees(atan2(*(z + 0.0 for _, _, z in upright(*camera.direction)))), 9)},
}
OPTIONS = {"base": "--cone base", "angle": "--cone angle", "angles": "--camera-as angles"}
OPTIONS |= {"reversed": "--camera-as reversed", "z-up": "--up z"}
