"""Words for random scene files: right ones and wrong ones for each kind of field."""

from __future__ import annotations

import random
from collections.abc import Callable

from tests.fuzz import grammar
from tests.fuzz.grammar import MESHES, PICTURES

Chance = random.Random
WORD_EDGES = (
    "0", "1", "-1", "0.5", "180", "255", "1e15", "-1e15", "5e-324", "1e-400", "1e400", "360", "+1", "1.", ".5",
)  # fmt: skip
WRONG = (
    "nan", "inf", "1_0", "0x1", "--1", "", "٣", "1e", "2..0", "20f", "1.1", "256", "-0.5", "2e15", "0,0,0",
    "file.png",
)  # fmt: skip


def number(chance: Chance) -> str:
    """Return a number."""
    if chance.random() < 0.3:
        return chance.choice(WORD_EDGES)
    return chance.choice(("{:.3f}", "{!r}", "{:e}", "{:g}")).format(chance.choice((1, 10, 100)) * chance.uniform(-1, 1))


def within(low: float, high: float) -> Callable[[Chance], str]:
    """Return a maker of numbers in an interval, both ends included."""
    return lambda chance: repr(chance.choice((low, high, chance.uniform(low, high), chance.uniform(low, high))))


def three(part: Callable[[Chance], str]) -> Callable[[Chance], str]:
    """Return a maker of three parts."""
    return lambda chance: ",".join(part(chance) for _ in range(3))


def size(chance: Chance) -> str:
    """Return a length."""
    return repr(chance.choice((5e-324, 1e-9, 1e15, *[abs(chance.gauss(0, 3)) + 0.01] * 9)))


def level(chance: Chance) -> str:
    """Return a whole number from 0 to 255."""
    return str(chance.randint(0, 255))


def some(least: int, *makers: Callable[[Chance], str]) -> Callable[[Chance], str]:
    """Return a maker of values with commas between them, the last of which may be left out."""
    return lambda chance: ",".join(make(chance) for make in makers[: chance.randint(least, len(makers))])


def picture(chance: Chance) -> str:
    """Return the name of a picture."""
    return chance.choice(PICTURES)


RATIO, TURN, HEIGHT, FAR = within(0, 1), within(-360, 360), within(-10, 10), within(0, 1e15)
POINT, DIRECTION, COLOUR = three(number), three(within(-1, 1)), three(level)
PATTERN = some(1, size, COLOUR, lambda chance: str(chance.randint(1, 12)), HEIGHT)
MAKERS: dict[str, Callable[[Chance], str]] = {
    "specular spc": some(2, RATIO, within(1, 1e6), lambda _: "blinn"),
    "mirror mir": some(1, RATIO, FAR), "glass ref": some(1, within(1, 10), RATIO, FAR), "tint": some(1, COLOUR, size),
    "fresnel": RATIO, "glow": RATIO, "checker pat": some(1, size, COLOUR), "texture txm tx": picture,
    "bump bum": some(1, picture, HEIGHT), "normal nm": picture,
    "uv": some(2, size, size, within(-1e6, 1e6), within(-1e6, 1e6), TURN),
    "marble": PATTERN, "wood": PATTERN, "clouds": PATTERN, "roll": TURN, "axis": DIRECTION,
    "tone": lambda chance: chance.choice(("plain", "srgb", "filmic")), "exposure": within(-20, 20),
    "lens": size, "focus": size, "fade": size, "size": lambda chance: repr(chance.uniform(0, 90)), "rim": RATIO,
}  # fmt: skip
FIELDS: dict[grammar.Test, Callable[[Chance], str]] = {
    grammar.ratio: RATIO, grammar.colour: COLOUR, grammar.point: POINT, grammar.direction: DIRECTION,
    grammar.may_be_zero: DIRECTION, grammar.length: size, grammar.lengths: three(size), grammar.picture: picture,
    grammar.mesh: lambda chance: chance.choice(MESHES),
    grammar.paint: lambda chance: chance.choice((COLOUR, picture))(chance),
}  # fmt: skip


def line(code: str, chance: Chance) -> list[str]:
    """Return the words of a line; now and then one is wrong."""
    wanted, least, attributes = grammar.FORMS[code]
    kept = wanted[: chance.randint(least, len(wanted))]
    words = [FIELDS.get(field, lambda chance: str(chance.randint(0, 180)))(chance) for field in kept]
    for names in chance.sample(sorted(attributes), min(len(attributes), chance.choice((0, 0, 1, 1, 2, 4)))):
        key = chance.choice(names.split())
        words.append(key if key in grammar.BARE and chance.random() < 0.5 else f"{key}:{MAKERS[names](chance)}")
    if chance.random() < 0.02:
        spoil(words, chance)
    spellings = [spelling for spelling, own in grammar.CODES.items() if own == code]
    return [chance.choice(spellings), *words]


def spoil(words: list[str], chance: Chance) -> None:
    """Make one word of a line wrong, or leave it out, or write it twice."""
    at, wrong = chance.randrange(len(words)), chance.choice(WRONG)
    words[at : at + 1] = chance.choice(
        ([], [wrong], [words[at]] * 2, [words[at] + ",0"], [words[at], wrong], [words[at] + ","])
    )


def scene(chance: Chance) -> bytes:
    """Return the text of a scene file, most often a valid one."""
    codes = ["A", "C", *(code for code in ("R", "bg", "L") if chance.random() < 0.4)]
    codes += chance.choices(sorted(set(grammar.FORMS) - grammar.ONCE), k=chance.randint(0, 6))
    chance.shuffle(codes)
    lines = []
    for code in codes:
        blank = chance.choice((" ", " ", "  ", "\t", " \t "))
        end = chance.choice(("", "", "", " ", " # é", "#fff", "\t#", "\r", " # //\r"))
        lines.append(chance.choice(("", "", " ")) + blank.join(line(code, chance)) + end)
        lines += chance.choice(([], [], [""], ["# \x0b"], [" \t"]))
    return (chance.choice(("", "", "", "\ufeff")) + "\n".join(lines) + chance.choice(("", "\n"))).encode()
