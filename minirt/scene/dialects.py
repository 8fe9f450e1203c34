"""Dialects of other programs: a lenient reader translates a line that it cannot read into one that it can.

Words fill the fields of the element in turn, as far as they can be meant for them; what other words mean stands in
`minirt.scene.dialect_tables`, and those without a meaning are left out. What was done is told once for each sort of
change, with its places.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from minirt.element import Element, fields_by_key, positional_fields
from minirt.errors import FieldError, FileError, Problem, quoted
from minirt.fields import Colour, Direction, Field, Real, Three, Triple, Whole, clamp, unit
from minirt.fields.directions import SCALED
from minirt.fields.scalars import Scalar
from minirt.helpers import file_io
from minirt.materials import pictures
from minirt.scene import dialect_tables as tables
from minirt.scene.dialect_tables import NUMBER
from minirt.scene.element_reader import HEX_COLOUR, SLASHES, split_key
from minirt.scene.elements import FURTHER, LAMPS, Ambient, Background, Camera, FurtherCamera, Light, Resolution
from minirt.scene.lines import MAX_WORDS, TAKEN, Line, Log, first_unprintable, line_from
from minirt.scene.registry import NUMERIC, SHAPES, SPELLINGS
from minirt.shapes import Cone

# Blanks may stand around the commas of three numbers, and within quotes.
WORD = re.compile(rf"{NUMBER}[ \t]*,[ \t]*{NUMBER}[ \t]*,[ \t]*{NUMBER},?(?![^ \t])|(?:\"[^\"]*\"|[^ \t\"])+|[^ \t]+")
TRIPLE = re.compile(rf"{NUMBER},{NUMBER},{NUMBER},?")
FRAMING = re.compile(r"\(((?:[^(),]*+,)++[^()]*+)\),?|(?<=[ \t])\|(?![^ \t])")  # of three numbers, and between fields
SEMICOLONS = re.compile(rf"(?<![^ \t])({NUMBER});({NUMBER});({NUMBER})(?![^ \t])")
# The value of an attribute that a blank parts from it, or a number from a comma; and a resolution with a comma or x.
DETACHED = re.compile(r"(?<=[ \t])([A-Za-z]\w*:(?:[^ \t]*,(?=[ \t]+[0-9.]))?)[ \t]+(?=[^ \t])(?![A-Za-z]\w*:)")
JOINED_SIZE = re.compile(r"^([ \t]*R[ \t]+[0-9]+)[,x]([0-9]+)(?![^ \t])")
DASHES = re.compile(r"(?<![^ \t])--(?![^ \t])")
LIGHT, SETTING = (re.compile(pattern, re.IGNORECASE) for pattern in (tables.LIGHT, tables.SETTING))
LEAST_PERCENT = 10  # a share from here on is one in percent
MOST_NUMBERS = 2  # behind the fields of a shape, whose meaning is guessed

Changes = list[tuple[str, str]]  # sorts of changes, and the words that each is about


class RangeError(FieldError):
    """A value that is well spelled, and that no field can take."""


class Translation(NamedTuple):
    """A line of the format, "" for none, and the sorts of changes that led to it, with the words that each is about."""

    text: str
    changes: Iterable[tuple[str, str]]


class Spelling(NamedTuple):
    """The spelling of a field, the number of words that it stands for, and the sort of change, '' for none."""

    text: str
    words: int
    sort: str = ""


def colours_of_materials(sources: list[str]) -> dict[str, str]:
    """Return the R,G,B of named materials, from the lines of a file that begin as settings: `mat red 255,0,0 ...`."""
    found = {}
    for source in sources:
        code, name, *values = [*source.split()[:12], "", ""]
        colour = next(filter(TRIPLE.fullmatch, values), "")
        if colour and SETTING.fullmatch(code) and code not in SPELLINGS:
            found[name] = colour.rstrip(",")
    return found


def translated(
    line: Line, colours: Mapping[str, str], folder: Path | None, seen: Mapping[str, int] | None = None
) -> Translation | None:
    """Translate a line: to '' where it is no element, or one that is not known; None where it stays an error.

    `colours` are those of named materials, and pictures are looked for in `folder`. `seen` has the identifiers of
    earlier lines.
    """
    body, comment, changes = body_of(line)
    found = WORD.findall(FRAMING.sub(r" \1 ", body))
    if first_unprintable(line) >= 0 or len(found) > MAX_WORDS:
        return None
    if not found:
        return Translation("", changes)
    code, *values = words = [word if '"' in word else "".join(word.split()) for word in found]
    changes += [(tables.JOINED, old) for old, new in zip(found, words, strict=True) if old != new]
    kind = kind_of(code)
    if kind is None:
        is_setting = SETTING.fullmatch(code) or len(values) < 2 or not any(map(TRIPLE.fullmatch, values))
        unread = tables.LIGHTS if LIGHT.fullmatch(code) else tables.MISSING
        unread = tables.SETTINGS if is_setting and code != tables.FACE else unread
        return Translation("", [(unread, code)])
    is_second = kind.code in (seen or ())
    kind = FURTHER.get(kind, kind) if is_second else kind
    if kind is not SPELLINGS.get(code):
        is_repeated = is_second and code in (Camera.code, Light.code)
        changes.append((tables.SECOND if is_repeated else tables.RENAMED, f"{code}{TAKEN}{kind.code}"))
    ordered = in_order(kind.code, values)
    if ordered != values:
        changes.append((tables.ORDER, code))
    try:
        spelled = fields_of_words(kind, ordered, colours, changes)
    except FieldError as error:
        is_missing = kind in SHAPES and isinstance(error, RangeError)
        told = (tables.INCOMPLETE, f"{code} ({error})") if is_missing else (tables.SETTINGS, code)
        return Translation("", [told]) if is_missing or kind in (Resolution, FurtherCamera) else None
    if spelled is None:
        unread = tables.INCOMPLETE if kind in SHAPES else tables.LIGHTS if kind in LAMPS else tables.SETTINGS
        return Translation("", [(unread, code)]) if kind not in (Ambient, Camera) else None
    fields, others = spelled
    attributes = meanings(kind, others, folder, changes)
    return Translation(" ".join([kind.code, *fields, *attributes]) + comment, changes)


def body_of(line: Line) -> tuple[str, str, Changes]:
    """Return a line without its comment, the comment, and what was changed: `#F00` behind a word is a colour."""
    changes: Changes = []
    text = line.text
    hex_colour = HEX_COLOUR.match(text, line.end)
    if hex_colour:
        changes.append((tables.NAMED, hex_colour[0]))
        text = text[: line.end] + css_colour(hex_colour[0]) + text[hex_colour.end() :]
    text, joined = with_words_joined(text)
    changes += joined
    body, _, comment = text.partition("#")
    slashes = SLASHES.search(body) or DASHES.search(body)
    if slashes:
        changes.append((tables.SLASHES, slashes[0]))
        body, comment = text[: slashes.start()], text[slashes.end() :]
    return body, f" #{comment}" * bool(comment), changes


def with_words_joined(text: str) -> tuple[str, Changes]:
    """Return a line whose words are joined as they may be meant, and what was changed."""
    body, mark, comment = text.partition("#")
    changes: Changes = []
    for pattern, words in ((SEMICOLONS, r"\1,\2,\3"), (DETACHED, r"\1"), (JOINED_SIZE, r"\1 \2")):
        changes += [(tables.JOINED, found[0]) for found in pattern.finditer(body)]
        body = pattern.sub(words, body)
    return body + mark + comment, changes


def without_element(line: Line, errors: list[Problem]) -> Translation | None:
    """Leave out a line that is well spelled but for `errors`, such as a file that is absent: that of a shape, or of a
    background under another name. None for others, whose errors stay."""
    code = line.text.split()[0]
    reason = errors[0].message.rpartition(": ")[2]
    if kind_of(code) in SHAPES:
        return Translation("", [(tables.MISSING, f"{code} ({reason})")])
    is_foreign = kind_of(code) is Background and code != Background.code
    return Translation("", [(tables.SETTINGS, code)]) if is_foreign else None


def kind_of(code: str) -> type[Element] | None:
    """Return the kind of element that a line begins with; three letters of its name are enough."""
    lower = code.lower()
    known = next(filter(None, map(SPELLINGS.get, (code, tables.CODES.get(lower, ""), lower, code.upper()))), None)
    named = (kind for kind in SPELLINGS.values() if len(code) > 2 and kind.title.startswith(lower))
    return known or next(named, None)


def in_order(code: str, words: list[str]) -> list[str]:
    """Return the words of an element in the order of its fields here: where they have a known order of their own, or
    are as many numbers and triples as the fields of a shape, or of what has one number, each of which then takes the
    next one."""
    letters = "".join("v" if TRIPLE.fullmatch(word) else "n" if re.fullmatch(NUMBER, word) else "w" for word in words)
    fitting = (means for kind, pattern, means in tables.LAYOUTS if kind == code and re.match(pattern, letters))
    known = next((means(*words) for means in fitting), words)
    kind = SPELLINGS[code]
    wanted = "".join("v" if isinstance(field, Three) else "n" for field in positional_fields(kind))
    given = letters[: len(wanted)]
    is_clear = kind in SHAPES or wanted.count("n") == 1
    if known is not words or not is_clear or given == wanted or sorted(given) != sorted(wanted):
        return known
    triples, numbers = (iter([word for word, of in zip(words, given, strict=False) if of == sort]) for sort in "vn")
    return [*(next(triples if sort == "v" else numbers) for sort in wanted), *words[len(wanted) :]]


def fields_of_words(
    kind: type[Element], words: list[str], colours: Mapping[str, str], changes: Changes
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
            spelled = Spelling("255,255,255", 0, tables.WHITE)
        if spelled is None and field.required:
            other = NUMBER if isinstance(field, Three) else TRIPLE.pattern  # and attributes
            if words and is_well_spelled(field, words[0]):
                raise RangeError(f"its {field.title} cannot be {words[0]}")
            if words and not re.fullmatch(rf"{other}|[A-Za-z]\w*[:=].*", words[0]):
                raise FieldError(f"cannot be {quoted(words[0])}")
            return None
        if spelled is None:
            break
        if spelled.sort:
            old = " ".join(words[: spelled.words])
            changes.append((spelled.sort, f"{old}{TAKEN}{spelled.text}" if old else kind.code))
        fields.append(spelled.text)
        words = words[spelled.words :]
    return fields, words


def is_well_spelled(field: Field, text: str) -> bool:
    """Whether a text is that of a value, in range or not."""
    with suppress(FieldError):
        field.parse(text)
        return True
    return False


def colour_first(words: list[str], colours: Mapping[str, str]) -> list[str]:
    """Return the words with that of a colour before numbers and names that stand between the other fields and it."""
    if not words or words[0] in colours or css_colour(words[0]):
        return words
    index = next((index for index, word in enumerate(words) if TRIPLE.fullmatch(word)), 0)
    return [words[index], *words[:index], *words[index + 1 :]]


def spellings(field: Field, words: list[str], colours: Mapping[str, str]) -> Iterator[Spelling]:
    """Yield what the first words may mean as the value of a field."""
    for text, count, sort in readings(field, words, colours):
        with suppress(FieldError):
            value = field.parse(text)
            with suppress(FieldError):
                field.check(value)
                yield Spelling(text, count, sort)
            fitted, how = fit(field, value)
            yield Spelling(field.format(field.check(fitted)), count, how)


def readings(field: Field, words: list[str], colours: Mapping[str, str]) -> Iterator[Spelling]:
    """Yield texts that may spell the value of a field, not yet parsed."""
    if not words:
        return
    word = words[0].strip("()[]{};,") if isinstance(field, Three) else words[0].removesuffix(",")
    yield Spelling(word, 1)
    head, _, fourth = word.rpartition(",")
    if isinstance(field, Three) and re.fullmatch(NUMBER, fourth):
        yield Spelling(head, 1, tables.FOURTH)
    if isinstance(field, Three) and "," not in "".join(words[:3]):
        yield Spelling(",".join(words[:3]), 3, tables.JOINED)
    if isinstance(field, Colour):
        if name := colours.get(word) or css_colour(word):
            yield Spelling(name, 1, tables.NAMED)
        if levels := levels_of_shares(word):
            yield Spelling(levels, 1, tables.SHARES)
        if levels := nearest_colour(word):
            yield Spelling(levels, 1, tables.NEAREST)
    if isinstance(field, Scalar) and word.count(",") == 1:
        yield Spelling(word.replace(",", "."), 1, tables.DECIMALS)


def css_colour(name: str) -> str:
    """Return R,G,B of a colour of CSS, '' for none."""
    from PIL import ImageColor

    with suppress(ValueError):
        return ",".join(map(str, ImageColor.getrgb(name)[:3]))
    return ""


def levels_of_shares(word: str) -> str:
    """Return the R,G,B from 0 to 255 of three shares from 0 to 1, of which one is no whole number; '' for others."""
    with suppress(ValueError):
        shares = [float(part) for part in word.split(",")]
        if len(shares) == 3 and min(shares) >= 0 and max(shares) <= 1 and any(each % 1 for each in shares):
            return ",".join(str(int(255 * each + 0.5)) for each in shares)
    return ""


def nearest_colour(word: str) -> str:
    """Return the whole R,G,B from 0 to 255 next to the first three of some numbers, '' for other words."""
    parts = word.split(",")[:3]
    with suppress(ValueError):
        return ",".join(str(int(clamp(float(part), 0, 255) + 0.5)) for part in parts) if len(parts) == 3 else ""
    return ""


def fit(field: Field, value: Any) -> tuple[Any, str]:
    """Return the value of a field next to one that is out of range, and what was done; FieldError where none is."""
    if isinstance(field, Direction):
        return (unit(value), SCALED) if any(value) else (field.instead, tables.NOWHERE)
    if isinstance(field, Real) and field.high == 1 and LEAST_PERCENT <= value <= 100:
        return value / 100, tables.PERCENT
    if isinstance(field, Real) or (isinstance(field, Whole) and value > field.high):
        return clamp(value, field.low, field.high), tables.NEAREST
    raise FieldError("has no value next to it")


def meanings(kind: type[Element], words: list[str], folder: Path | None, changes: Changes) -> list[str]:
    """Return the attributes that words behind the fields mean."""
    keyed = fields_by_key(kind)
    has_colour = tables.WHITE not in dict(changes)  # without one a number names a material
    are_guessed = has_colour and sum(re.fullmatch(NUMBER, word) is not None for word in words) <= MOST_NUMBERS
    found: dict[str, str] = {}

    def hindrance(attribute: str) -> str:
        """Return why a word is no further attribute of the element, as a sort of change; '' where it is one."""
        key, start = split_key(attribute)
        try:
            if (field := keyed.get(key)) is None or key in found:
                return tables.LEFT_OUT
            value = field.check(field.parse(attribute[start:] if start else field.bare))
            for file in field.pictures(value):
                if folder:
                    pictures.reader(file)(file_io.located(folder, file.name))
        except (FieldError, FileError) as error:
            return tables.ABSENT if isinstance(error, FileError) else tables.LEFT_OUT
        found[key] = attribute
        return ""

    while words:
        used, attributes, sort = 1, "", ""
        if hindrance(words[0].replace("=", ":", 1)):
            used, attributes, sort = meaning(words, are_guessed)
            attributes = attributes.replace(tables.USUAL, getattr(keyed.get("checker"), "bare", ""))
        sort = next(filter(None, map(hindrance, attributes.split())), sort)
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
        for pattern, means, sort in tables.ROWS if len(words) >= used else ():
            match = re.fullmatch(pattern, text, re.IGNORECASE)
            if match and (are_guessed or sort not in tables.GUESSES):
                attributes = means(*match.groups())
                return used, attributes, sort if attributes else tables.LEFT_OUT
    return 1, "", tables.LEFT_OUT


def unread_lines(log: Log) -> int:
    """Return the number of lines that no meaning was found for, and that became comments."""
    return sum(len(log.changes.get(sort, ())) for sort in tables.UNREAD)


def complete(items: list[Any], seen: dict[str, int], log: Log) -> None:
    """Do what takes all lines of a file: choose its camera, give it an ambient light, tell cones and missing shapes."""
    promote_camera(items, seen, log)
    apply_conventions(items, log)
    unread = [*log.changes.get(tables.MISSING, ()), *log.changes.get(tables.INCOMPLETE, ())]
    if unread and not any(isinstance(item, SHAPES) for item in items):
        line, code = unread[0]
        log.error(line, f"none of the shapes can be read, of which {quoted(code)} is the first", 1, len(code))
    if Camera.code in seen and seen.setdefault(Ambient.code, 0) == 0:
        items.insert(0, Ambient(0.0, (255, 255, 255)))
        log.change(line_from(1, ""), tables.DARK, Ambient.code)


def promote_camera(items: list[Any], seen: dict[str, int], log: Log) -> None:
    """Let the first further camera be the camera of a file that has none, as the older subject means it."""
    index = next((index for index, item in enumerate(items) if isinstance(item, FurtherCamera)), None)
    if index is not None and Camera.code not in seen:
        first = items[index]
        source = first.source.replace(FurtherCamera.code, Camera.code, 1)
        items[index] = first.as_kind(Camera).replace(source=source)
        seen[Camera.code] = seen[first.code]
        log.change(line_from(seen[first.code], first.source), tables.RENAMED, first.code)


def apply_conventions(items: list[Any], log: Log) -> None:
    """Give cones and cameras the meaning that was asked for, or say which one cones have in a file in a dialect.

    ValueError for a word that asks for nothing.
    """
    words = log.lenient.split() if isinstance(log.lenient, str) else []
    if unknown := [word for word in words if word not in tables.OPTIONS]:
        raise ValueError(f"lenient must be a bool, or some of {' '.join(tables.OPTIONS)}, got {quoted(unknown[0])}")
    is_dialect = bool(log.changes.keys() - {SCALED})
    for number, item in enumerate(items, 1):
        if not isinstance(item, Cone | Camera):
            continue
        line = line_from(number, item.source)
        table = tables.CONES if isinstance(item, Cone) else tables.CAMERAS
        meant = [word for word in table if word in words]
        if is_dialect and isinstance(item, Cone) and not meant:
            log.change(line, tables.APEX, item.code)
        for word in meant:
            log.change(line, tables.CONVENTION.format(item.plural, tables.OPTIONS[word]), item.code)
            before, written = items[number - 1], direction_as_written(line, log)
            try:
                items[number - 1] = before.replace(**table[word](before, written))
            except ValueError as error:
                log.error(line, f"{error} ({tables.OPTIONS[word]})", 1)


def direction_as_written(line: Line, log: Log) -> Triple:
    """Return the second three numbers of a line, before they were scaled to a direction."""
    scaled = (words for each, words in log.changes.get(SCALED, ()) if each.number == line.number)
    text = next(scaled, "") or TRIPLE.findall(line.text)[1]
    x, y, z = map(float, re.findall(NUMBER, text)[:3])
    return x, y, z
