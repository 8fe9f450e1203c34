"""Fuzzers of the scene reader, with the strict grammar as the referee, and of rendering extreme scenes.

Each file is read twice: as it is, by the diagnosing reader, and behind many comments, by the fast reader. Both must
agree with the referee. A lenient reader accepts whatever a strict one does.
"""

from __future__ import annotations

import warnings
from functools import cache

import numpy as np

from minirt.errors import SceneError
from minirt.rendering import Renderer
from minirt.rendering.queries.preview import notice_about
from minirt.rendering.queries.stiffness import stiff_shapes
from minirt.scene import Scene, dump, parse
from minirt.scene.fast import FEW_LINES
from tests.fuzz import grammar
from tests.fuzz.grammar import Chance, folder
from tests.fuzz.mutations import Fuzzer, mutated

COMMENTS = b"#\n" * FEW_LINES  # so many lines that the fast reader is used
BOM = b"\xef\xbb\xbf"
LONELY = sorted(set(grammar.FORMS) - grammar.ONCE)
WRONG = (
    "nan", "inf", "1_0", "0x1", "--1", "", "٣", "1e", "2..0", "20f", "1.1", "256", "-0.5", "2e15", "0,0,0",
    "file.png",
)  # fmt: skip


def line(code: str, chance: Chance) -> list[str]:
    """Return the words of a line; now and then one is wrong."""
    wanted, least, attributes = grammar.FORMS[code]
    kept = wanted[: chance.randint(least, len(wanted))]
    words = [kind.make(chance) for kind in kept]
    for names in chance.sample(sorted(attributes), min(len(attributes), chance.choice((0, 0, 1, 1, 2, 4)))):
        key = chance.choice(names.split())
        is_bare = key in grammar.BARE and chance.random() < 0.5
        words.append(key if is_bare else f"{key}:{attributes[names].make(chance)}")
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


def make_scene(chance: Chance) -> bytes:
    """Make a scene file, most often a valid one before it may be mutated."""
    codes = ["A", "C", *(code for code in ("R", "bg", "L") if chance.random() < 0.4)]
    codes += chance.choices(LONELY, k=chance.randint(0, 6))
    chance.shuffle(codes)
    lines = []
    for code in codes:
        blank = chance.choice((" ", " ", "  ", "\t", " \t "))
        end = chance.choice(("", "", "", " ", " # é", "#fff", "\t#", "\r", " # //\r"))
        lines.append(chance.choice(("", "", " ")) + blank.join(line(code, chance)) + end)
        lines += chance.choice(([], [], [""], ["# \x0b"], [" \t"]))
    data = (chance.choice(("", "", "", "\ufeff")) + "\n".join(lines) + chance.choice(("", "\n"))).encode()
    return mutated(data, chance) if chance.random() < 0.5 else data


def check_scene(data: bytes) -> str:
    """Compare the readers with the referee."""
    expected = grammar.is_scene(data)
    scene = read(data)
    behind = read(COMMENTS + data.removeprefix(BOM))
    assert (scene is None) == (behind is None), "the fast and the diagnosing reader disagree"
    assert expected is None or expected == (scene is not None), f"the grammar says {expected}, the reader the opposite"
    if scene is None:
        read(data, lenient=True)
        return "refused"
    assert scene.elements == getattr(behind, "elements", None), (
        "the fast and the diagnosing reader read different values"
    )
    assert dump(scene).encode() == data, "an unchanged scene is written with other bytes"
    assert scene.elements == getattr(read(data, lenient=True), "elements", None), "a lenient reader reads other values"
    return "accepted"


def read(data: bytes, lenient: bool = False) -> Scene | None:
    """Return the scene of a file; None if it is refused, with places that are within it."""
    try:
        return parse(data, folder() / "fuzz.rt", lenient).scene
    except SceneError as error:
        check_places(error, data)
        return None


def check_places(error: SceneError, data: bytes) -> None:
    """Check that each problem is at a place within the file."""
    assert error.problems
    for problem in error.problems:
        assert problem.line <= data.count(b"\n") + 1
        assert problem.column <= len(problem.text) + 1


SCENES = Fuzzer(make_scene, check_scene, 300)


# Extreme valid scenes: what the reader accepts renders without warnings, by kernels that were compiled ahead of time.

WIDTH, HEIGHT = 8, 6
PRECISIONS = ("double", "single")
EXTREME = ("0", "5e-324", "-5e-324", "1e-308", "1e-160", "1e-30", "0.001", "1e8", "1e15", "-1e15", "999999999999999.9")


def make_extreme(chance: Chance) -> bytes:
    """Make a scene; in many of its numbers stand extreme ones."""
    codes = ["A", "C", *(code for code in ("bg", "L") if chance.random() < 0.7)]
    codes += chance.choices(LONELY, k=chance.randint(1, 5))
    return "\n".join(" ".join(extreme(line(code, chance), chance)) for code in codes).encode()


def extreme(words: list[str], chance: Chance) -> list[str]:
    """Replace some numbers of a line by extreme ones; a line that this makes wrong is made anew."""
    for _ in range(20):
        tried = [words[0], *(",".join(other(part, chance) for part in word.split(",")) for word in words[1:])]
        if grammar.code_of(" ".join(tried)) not in ("wrong", "open"):
            return tried
    return words


def other(part: str, chance: Chance) -> str:
    """Return a number, most often as it is."""
    is_number = not np.isnan(grammar.value_of(part))
    return chance.choice(EXTREME) if is_number and chance.random() < 0.15 else part


def check_extreme(data: bytes) -> str:
    """Render the scene in both precisions."""
    scene = read(data)
    if scene is None:
        return "refused"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for precision in PRECISIONS:
            render(scene, precision)
    return "rendered"


@cache
def renderer(precision: str) -> Renderer:
    """Return a renderer that compiles nothing."""
    made = Renderer(1, precision)
    made.kernels.specialised_after = float("inf")
    return made


def render(scene: Scene, precision: str) -> None:
    """Render a scene: all of the picture, with finite light."""
    pixels, light = np.zeros((HEIGHT, WIDTH, 4), np.uint8), np.full((HEIGHT, WIDTH, 3), np.nan)
    assert renderer(precision).render(scene, pixels, 1, light)
    assert (pixels[..., 3] == 255).all(), "pixels were left out"
    assert np.isfinite(light).all(), "light that is not finite"
    assert (light >= 0).all(), "light below 0"
    notice_about(scene, pixels)
    assert all(map(str, stiff_shapes(scene, renderer(precision).packing.shape_arrays, WIDTH, HEIGHT)))


EXTREMES = Fuzzer(make_extreme, check_extreme, 40)
