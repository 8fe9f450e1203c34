"""Dialects of other programs: a lenient reader translates a line that it cannot read into one that it can.

Words fill the fields of the element in turn, as far as they can be meant for them; what other words mean stands in a
table, and those without a meaning are left out. What was done is told once for each sort of change, with its places.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from math import radians, tan
from pathlib import Path
from typing import Any, NamedTuple

from minirt.element import Element, fields_by_key, positional_fields
from minirt.errors import FieldError, FileError, Problem, printable, quoted
from minirt.fields import Colour, Direction, Field, Length, PictureFile, Real, Three, clamp, unit
from minirt.fields.scalars import Scalar
from minirt.helpers import file_io
from minirt.scene.element_reader import HEX_COLOUR, split_key
from minirt.scene.elements import LAMPS, Ambient, Camera, FurtherCamera, Resolution, linear_combination
from minirt.scene.lines import Line, Log, first_unprintable, line_from
from minirt.scene.registry import NUMERIC, SHAPES, SPELLINGS
from minirt.shapes import Cone

# Sorts of changes, as notices tell them.
LEFT_OUT = "words without a meaning here are left out"
SETTINGS = "settings of other programs are left out"
MISSING = "shapes are missing"
LIGHTS = "lights that cannot be read are left out"
CLAMPED = "numbers out of range become the nearest that can be"
DECIMALS = "decimal commas become points"
SCALED = "directions are scaled to length 1"
JOINED = "three numbers with blanks between them are read as one field"
NAMED = "names of colours and materials become their R,G,B"
WHITE = "what has no colour is white"
ORDER = "fields in another order become those of this format, without turns and second axes"
APEX = "cones begin at their apex and have a diameter; --cone base or --cone angle reads them in another way"
CONVENTION = "cones are read as --cone says"
RENAMED = "elements of other names become those of this format"
EXPONENT = "a number behind the colour is taken for a Phong exponent, with a share of 0.5"
REFLECTIVITY = "a number of at most 1 behind the colour is taken for a share of mirrored light"
CHECKERS = "checkers become checker:"
PICTURES = "pictures behind the colour become texture:, bump: or normal:"
ABSENT = "pictures that cannot be read are left out"
HIGHLIGHTS = "highlights and mirrors become specular: and mirror:"

# What lines of other programs begin with: elements by another name, and what is no element.
CODES = {
    **dict.fromkeys(("cam", "camera"), "c"),
    **dict.fromkeys(("cu", "cb", "bx", "cube", "cub"), "bo"),
    **dict.fromkeys(("ci", "dk", "ds", "disk", "circle"), "di"),
    **dict.fromkeys(("pb", "par", "para"), "pa"),
    **dict.fromkeys(("lpt", "ptl", "pt", "lp"), "l"),
    **dict.fromkeys(("obj", "mesh"), "ob"),
    "hb": "hy",
}
LIGHT = re.compile(r"sun|spot\w*|\w*(?:light|lamp)\w*|a?rl|sl\w?", re.IGNORECASE)
SETTING = re.compile(
    r"@?(?:ma?t|mtl|tex|txt?|xpm|bmp|img|sky|set|render|res|max|aa|alias|win|title|name|depth|sampl|thread|pat)\w*[:=]?"
    r"|[A-Z]|[a-z]_\w*|[-{}/=*+]+.*|@.*",
    re.IGNORECASE,
)
N, C = r"([-+]?[0-9]*\.?[0-9]+)", r"([0-9.]+,[0-9.]+,[0-9.]+)"
FILE = r"[\"']?([^\"':=; ]+\.(?:xpm|png|jpe?g|ppm|bmp|tga))[\"']?"
CHECKER = r"-?-?(?:ch|chk|cb|cd|checker\w*|chess\w*|pattern|pat|damier)"
NUMBER = r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?"
# Blanks may stand around the commas of three numbers, and within quotes.
WORD = re.compile(rf"{NUMBER}[ \t]*,[ \t]*{NUMBER}[ \t]*,[ \t]*{NUMBER},?(?![^ \t])|\"[^\"]*\"|[^ \t]+")
TRIPLE = re.compile(rf"{NUMBER},{NUMBER},{NUMBER},?")
FRAMING = re.compile(r"\(([^()]*,[^()]*)\),?|(?<![^ \t])\|(?![^ \t])")  # of three numbers, and between fields
UP = "0,1,0"


# Fields of cones as programs mean them whose point is the centre of the base, or whose diameter is half the angle.
CONES: dict[str, Callable[[Cone], dict[str, Any]]] = {
    "base": lambda cone: {
        "apex": linear_combination(1.0, cone.apex, cone.height, cone.axis),
        "axis": linear_combination(-1.0, cone.axis, 0.0, cone.axis),
    },
    "angle": lambda cone: {"diameter": 2 * cone.height * tan(radians(cone.diameter))},
}


class Row(NamedTuple):
    """A meaning of one or two words behind the fields."""

    pattern: str  # of the words, with one blank between two
    means: Callable[..., str]  # attributes, from the groups of the pattern; '' for none
    sort: str


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


ROWS = (
    Row(rf"{CHECKER}[:= ]{C}[:;]{C}(?:[:;]{N})?", lambda _one, two, size: f"checker:{size or 1},{two}", CHECKERS),
    Row(rf"{CHECKER}[:= ]{C}", lambda colour: f"checker:1,{colour}", CHECKERS),
    Row(rf"{CHECKER}[:= ]{N}", lambda size: f"checker:{size}", CHECKERS),
    Row(CHECKER, lambda: "checker", CHECKERS),
    Row(rf"-?-?(?:b|bu|bum|bump\w*|bm|rb|height\w*)[:= ]{FILE}", lambda file: f"bump:{file}", PICTURES),
    Row(rf"-?-?(?:n|nm|nor\w*)[:= ]{FILE}", lambda file: f"normal:{file}", PICTURES),
    Row(rf"(?:-?-?\w+[:= ])?{FILE}", lambda file: f"{picture_key(file)}:{file}", PICTURES),
    Row(rf"-?-?(?:sh|shin\w*|ns|exp\w*|phong)[:= ]{N}", lambda text: highlight(0.5, float(text)), HIGHLIGHTS),
    Row(rf"-?-?(?:sp|spc|spec\w*)[:= ]{N}", lambda text: highlight(float(text), 32), HIGHLIGHTS),
    Row(rf"-?-?(?:re|rf|refl\w*|mir\w*)[:= ]{N}", reflected, HIGHLIGHTS),
    Row(rf"{N} {N}", two_numbers, EXPONENT),
    Row(r"([-+]?0*[1-9][0-9]*(?:\.[0-9]*)?)", one_number, EXPONENT),
    Row(N, one_number, REFLECTIVITY),
)
GUESSES = EXPONENT, REFLECTIVITY


class Layout(NamedTuple):
    """Another order of the first fields of an element."""

    code: str
    pattern: str  # of the letters of the words: v for three numbers, n for one, w for others
    means: Callable[..., list[str]]  # the words of the format, from all words


LAYOUTS = (
    Layout("bo", "vn(?!n)", lambda centre, edge, *rest: [centre, UP, edges(edge), *rest]),
    Layout("bo", "vvn(?!n)", lambda centre, axis, edge, *rest: [centre, axis, edges(edge), *rest]),
    Layout("bo", "vnnn|vvv(?![vn])", lambda centre, sizes, *rest: [centre, UP, sizes, *rest]),
    Layout("bo", "vvv(v|nnn)v", lambda centre, _across, axis, *rest: [centre, axis, *rest]),
    Layout("el", "vvv(?!v)", lambda centre, sizes, *rest: [centre, UP, sizes, *rest]),
    Layout("ob", "w$", lambda file: [file, "0,0,0", "1"]),
    Layout("ob", "wvvv", lambda file, place, _turns, sizes, *rest: [file, place, first_of(sizes), *rest]),
    Layout("ob", "vvvvw", lambda place, _turns, sizes, colour, file: [file, place, first_of(sizes), colour]),
)
MOST_SUGGESTED = 3  # lines
MOST_NUMBERS = 2  # behind the fields of a shape, whose meaning is guessed


def picture_key(file: str) -> str:
    """Return the attribute that a picture is meant for, by its name."""
    name = Path(file).stem.lower()
    return "normal" if "norm" in name else "bump" if "bump" in name or "height" in name else "texture"


class Translation(NamedTuple):
    """A line of the format, "" for none, and the sorts of changes that led to it, with the words that each is about."""

    text: str
    changes: tuple[tuple[str, str], ...]


def colours_of_materials(sources: list[str]) -> dict[str, str]:
    """Return the R,G,B of named materials, from the lines of a file that begin as settings: `mat red 255,0,0 ...`."""
    found = {}
    for source in sources:
        code, name, *values = [*source.split()[:12], "", ""]
        colour = next(filter(TRIPLE.fullmatch, values), "")
        if colour and SETTING.fullmatch(code) and code not in SPELLINGS:
            found[name] = colour.rstrip(",")
    return found


def translated(line: Line, colours: Mapping[str, str], folder: Path | None) -> Translation | None:
    """Translate a line: to '' where it is no element, or one that is not known; None where it stays an error.

    `colours` are those of named materials, and pictures are looked for in `folder`.
    """
    hex_colour = HEX_COLOUR.match(line.text, line.end)
    rest = css_colour(hex_colour[0]) + line.text[hex_colour.end() :] if hex_colour else line.text[line.end :]
    body, _, comment = (line.text[: line.end] + rest).partition("#")
    words = ["".join(word.split()) for word in WORD.findall(FRAMING.sub(r" \1 ", body))]
    if not words or first_unprintable(line) >= 0:
        return None
    code, *values = words
    kind = kind_of(code)
    if kind is None:
        is_setting = SETTING.fullmatch(code) or len(values) < 2 or not any(map(TRIPLE.fullmatch, values))
        return Translation("", ((SETTINGS if is_setting else LIGHTS if LIGHT.fullmatch(code) else MISSING, code),))
    changes = [] if code in SPELLINGS else [(RENAMED, code)]
    if hex_colour:
        changes.append((NAMED, hex_colour[0]))
    ordered = in_order(kind.code, values)
    if ordered != values:
        changes.append((ORDER, code))
    try:
        spelled = fields_of_words(kind, ordered, colours, changes)
    except FieldError:
        return Translation("", ((SETTINGS, code),)) if kind in (Resolution, FurtherCamera) else None
    if spelled is None:
        unread = MISSING if kind in SHAPES else LIGHTS if kind in LAMPS else SETTINGS
        return Translation("", ((unread, code),)) if values and kind not in (Ambient, Camera) else None
    fields, others = spelled
    attributes = meanings(kind, others, folder, changes)
    return Translation(" ".join([kind.code, *fields, *attributes]) + f" #{comment}" * bool(comment), tuple(changes))


def without_shape(line: Line, errors: list[Problem]) -> Translation | None:
    """Leave out the line of a shape that is well spelled but for `errors`, such as a file that is absent."""
    code = line.text.split()[0]
    reason = errors[0].message.rpartition(": ")[2]
    return Translation("", ((MISSING, f"{code} ({reason})"),)) if kind_of(code) in SHAPES else None


def kind_of(code: str) -> type[Element] | None:
    """Return the kind of element that a line begins with; three letters of its name are enough."""
    lower = code.lower()
    known = next(filter(None, map(SPELLINGS.get, (code, CODES.get(lower, ""), lower, code.upper()))), None)
    named = (kind for kind in SPELLINGS.values() if len(code) > 2 and kind.title.startswith(lower))
    return known or next(named, None)


def in_order(code: str, words: list[str]) -> list[str]:
    """Return the words of an element in the order of its fields here, where they have a known order of their own."""
    letters = "".join("v" if TRIPLE.fullmatch(word) else "n" if re.fullmatch(NUMBER, word) else "w" for word in words)
    rows = (row for row in LAYOUTS if row.code == code and re.match(row.pattern, letters))
    return next((row.means(*words) for row in rows), words)


def edges(edge: str) -> str:
    """Return the sizes of a cube."""
    return ",".join([edge] * 3)


def first_of(sizes: str) -> str:
    """Return the first of three numbers."""
    return sizes.partition(",")[0]


def fields_of_words(
    kind: type[Element], words: list[str], colours: Mapping[str, str], changes: list[tuple[str, str]]
) -> tuple[list[str], list[str]] | None:
    """Spell the fields of an element by the first words, and return the others, too.

    None where a field is missing, or something else stands in its place; FieldError for a malformed word.
    """
    fields = []
    for field in positional_fields(kind):
        words = colour_first(words, colours) if isinstance(field, Colour) else words
        spelled = next(spellings(field, words, colours), None)
        is_absent = not (words and NUMERIC.match(words[0]) and "," in words[0])
        if spelled is None and isinstance(field, Colour) and field.required and is_absent:
            spelled = Spelling("255,255,255", 0, WHITE)
        if spelled is None and field.required:
            if words and not is_other(field, words[0]):
                raise FieldError(f"cannot be {quoted(words[0])}")
            return None
        if spelled is None:
            break
        if spelled.sort:
            changes.append((spelled.sort, " ".join(words[: spelled.words] or [kind.code])))
        fields.append(spelled.text)
        words = words[spelled.words :]
    return fields, words


def is_other(field: Field, word: str) -> bool:
    """Whether a word stands for something else: a number for three of them, three for one, or an attribute."""
    other = NUMBER if isinstance(field, Three) else TRIPLE.pattern
    return re.fullmatch(rf"{other}|[A-Za-z]\w*[:=].*", word) is not None


def colour_first(words: list[str], colours: Mapping[str, str]) -> list[str]:
    """Return the words with that of a colour before numbers and names that stand between the other fields and it."""
    if not words or words[0] in colours or css_colour(words[0]):
        return words
    index = next((index for index, word in enumerate(words) if TRIPLE.fullmatch(word)), 0)
    return [words[index], *words[:index], *words[index + 1 :]]


class Spelling(NamedTuple):
    """The spelling of a field, the number of words that it stands for, and the sort of change, '' for none."""

    text: str
    words: int
    sort: str = ""


def spellings(field: Field, words: list[str], colours: Mapping[str, str]) -> Iterator[Spelling]:
    """Yield what the first words may mean as the value of a field."""
    for text, count, sort in readings(field, words, colours):
        with suppress(FieldError):
            mended = field.mend(text)
            value = mended[0] if mended else field.parse(text)
            with suppress(FieldError):
                field.check(value)
                yield Spelling(field.format(value) if mended else text, count, sort)
            fitted, how = fit(field, value)
            yield Spelling(field.format(field.check(fitted)), count, how)


def readings(field: Field, words: list[str], colours: Mapping[str, str]) -> Iterator[Spelling]:
    """Yield texts that may spell the value of a field, not yet parsed."""
    if not words:
        return
    word = words[0].strip("()[]{};,") if isinstance(field, Three) else words[0].removesuffix(",")
    yield Spelling(word, 1)
    if isinstance(field, Three) and "," not in "".join(words[:3]):
        yield Spelling(",".join(words[:3]), 3, JOINED)
    if isinstance(field, Colour):
        if name := colours.get(word) or css_colour(word):
            yield Spelling(name, 1, NAMED)
        if levels := nearest_colour(word):
            yield Spelling(levels, 1, CLAMPED)
    if isinstance(field, Scalar) and word.count(",") == 1:
        yield Spelling(word.replace(",", "."), 1, DECIMALS)


def css_colour(name: str) -> str:
    """Return R,G,B of a colour of CSS, '' for none."""
    from PIL import ImageColor

    with suppress(ValueError):
        return ",".join(map(str, ImageColor.getrgb(name)[:3]))
    return ""


def nearest_colour(word: str) -> str:
    """Return the whole R,G,B from 0 to 255 next to the first three of some numbers, '' for other words."""
    parts = word.split(",")[:3]
    with suppress(ValueError):
        return ",".join(str(round(clamp(float(part), 0, 255))) for part in parts) if len(parts) == 3 else ""
    return ""


def fit(field: Field, value: Any) -> tuple[Any, str]:
    """Return the value of a field next to one that is out of range, and what was done; FieldError where none is."""
    if isinstance(field, Direction):
        return unit(value), SCALED
    if isinstance(field, Real) and not isinstance(field, Length):
        return clamp(value, field.low, field.high), CLAMPED
    raise FieldError("has no value next to it")


def meanings(kind: type[Element], words: list[str], folder: Path | None, changes: list[tuple[str, str]]) -> list[str]:
    """Return the attributes that words behind the fields mean."""
    keyed = fields_by_key(kind)
    are_guessed = sum(re.fullmatch(N, word) is not None for word in words) <= MOST_NUMBERS
    found: dict[str, str] = {}

    def own(word: str) -> bool:
        key, start = split_key(word)
        return key in keyed and not hindrance(keyed[key], word[start:] if start else keyed[key].bare, folder)

    while words:
        used, attributes, sort = (1, words[0], "") if own(words[0]) else meaning(words, are_guessed)
        for attribute in attributes.split():
            key, start = split_key(attribute)
            field = None if key in found else keyed.get(key)
            problem = hindrance(field, attribute[start:] if start else field.bare, folder) if field else LEFT_OUT
            if problem:
                sort = problem
            else:
                found[key] = attribute
        if sort:
            changes.append((sort, " ".join(words[:used])))
        words = words[used:]
    return list(found.values())


def meaning(words: list[str], are_guessed: bool) -> tuple[int, str, str]:
    """Return how many of the first words mean something together, the attributes, and the sort of change.

    Numbers alone have one only where they `are_guessed`.
    """
    for used in (2, 1):
        text = " ".join(words[:used])
        for row in ROWS if len(words) >= used else ():
            match = re.fullmatch(row.pattern, text, re.IGNORECASE)
            if match and (are_guessed or row.sort not in GUESSES):
                attributes = row.means(*match.groups())
                return used, attributes, row.sort if attributes else LEFT_OUT
    return 1, "", LEFT_OUT


def hindrance(field: Field, text: str, folder: Path | None) -> str:
    """Return why a text is no value of a field, as a sort of change; '' where it is one."""
    try:
        value = field.check(field.parse(text))
    except FieldError:
        return LEFT_OUT
    return "" if folder is None or are_readable(field.pictures(value), folder) else ABSENT


def are_readable(files: Iterable[PictureFile], folder: Path) -> bool:
    """Whether all pictures that a value names can be read."""
    from minirt.materials import pictures

    try:
        for file in files:
            pictures.reader(file)(file_io.located(folder, file.name))
    except FileError:
        return False
    return True


def promote_camera(items: list[Any], seen: dict[str, int], log: Log) -> None:
    """Let the first further camera be the camera of a file that has none, as the older subject means it."""
    index = next((index for index, item in enumerate(items) if isinstance(item, FurtherCamera)), None)
    if index is not None and Camera.code not in seen:
        first = items[index]
        items[index] = first.as_kind(Camera).replace(source=first.source)
        seen[Camera.code] = seen[first.code]
        log.change(line_from(seen[first.code], first.source), RENAMED, first.code)


def read_cones(items: list[Any], log: Log) -> None:
    """Give cones the meaning that was asked for, or say which one they have in a file that is in a dialect."""
    cones = [(number, item) for number, item in enumerate(items, 1) if isinstance(item, Cone)]
    meant = CONES.get(str(log.lenient))
    for number, cone in cones if meant or log.changes else ():
        line = line_from(number, cone.source)
        log.change(line, CONVENTION if meant else APEX, cone.code)
        try:
            items[number - 1] = cone.replace(**meant(cone)) if meant else cone
        except ValueError as error:
            log.error(line, f"{error} (--cone {log.lenient})", 1)


def check_shapes_left(items: list[Any], log: Log) -> None:
    """Report that a file has no shape that can be read, but others."""
    if MISSING in log.changes and not any(isinstance(item, SHAPES) for item in items):
        line, code = log.changes[MISSING][0]
        log.error(line, f"none of the shapes can be read, of which {quoted(code)} is the first", 1, len(code))


def suggestions(problems: Iterable[Problem]) -> Iterator[str]:
    """Yield what the first of the lines that a strict reader refuses may mean."""
    for number, text in list(dict.fromkeys((each.line, each.text) for each in problems))[:MOST_SUGGESTED]:
        meant = translated(line_from(number, text), colours={}, folder=None)
        if meant and meant.text:
            yield f"line {number}: did you mean '{printable(meant.text)}'?"
