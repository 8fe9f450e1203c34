"""Fuzzers of the scene reader, with the strict grammar as the referee, and of rendering extreme scenes.

Each file is read twice: as it is, by the diagnosing reader, and behind many comments, by the fast reader. Both must
agree with the referee. A lenient reader accepts whatever a strict one does, and what it makes of others is saved in
this format.
"""

from __future__ import annotations

import warnings
from math import inf, nextafter
from unittest.mock import patch

import numpy as np

from minirt.element import Element, fields_of, positional_fields
from minirt.errors import SceneError
from minirt.fields import Choice, Field, MeshField, Paint, Picture, Three, Whole
from minirt.fields.scalars import Scalar
from minirt.materials import Compound
from minirt.rendering import kernels
from minirt.rendering.notices import NOT_COMPUTED
from minirt.scene import Resolution, Scene, dump, parse
from minirt.scene.fast import FEW_LINES
from minirt.scene.registry import ELEMENTS
from tests.fuzz import grammar
from tests.fuzz.grammar import Chance, folder
from tests.fuzz.inputs import OK, run_program
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
        translated = read(data, lenient=True)
        saved = translated and read(dump(translated).encode())
        assert not translated or (saved and saved.elements == translated.elements), (
            "what is saved is not in this format"
        )
        return "translated" if translated else "refused"
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


# Extreme valid scenes of all kinds and attributes in the registry, through the whole command: what `--check` takes is
# drawn. Kernels were compiled ahead of time.

KINDS = [kind for kind in ELEMENTS.values() if kind is not Resolution]  # whose place `SIZE` takes
FRAME = {"A": "A 1 9,9,9", "C": "C 0,0,0 0,0,1 60"}
EXTREME = (0.0, 5e-324, 1e-308, 1e-160, 1e-30, 1e-9, 0.001, 1.0, 1e8, 1e14, 1e15)
SIZE = ("--size", "8x6")
OPTIONS = (
    *("", "--precision single", "--precision single -v", "--samples 2 --threads 1", "--exposure 20 -v", "--depth 0"),
    *("--samples auto --error 0.1 --strict", "--depth 32 --tone filmic", "--lenient --left-handed", "--turntable 2"),
    *("--samples auto --error 0.01", "--region 2,1,3,4", "--precision single --bits 16", "--dither -v"),
)


def make_extreme(chance: Chance) -> bytes:
    """Make a scene, many of whose numbers are extreme, behind a comment with the options that draw it."""
    kinds = [kind for kind in KINDS if kind.required or (kind.once and chance.random() < 0.5)]
    kinds += chance.choices([kind for kind in KINDS if not kind.once], k=chance.randint(1, 5))
    extreme, options = chance.choice((0.05, 0.3, 0.8)), chance.choice(OPTIONS)
    suffix = chance.choice((".pfm", ".png")) if "--bits" not in options else ".png"
    return "\n".join((f"#{options} -o out{suffix}", *(extreme_line(kind, extreme, chance) for kind in kinds))).encode()


def extreme_line(kind: type[Element], extreme: float, chance: Chance) -> str:
    """Return a line of a kind, each of whose numbers is extreme with the given probability."""
    others = [line for code, line in FRAME.items() if code != kind.code]
    while True:
        keyed = [field for field in fields_of(kind) if field.keyed]
        some = chance.sample(keyed, min(len(keyed), chance.choice((0, 0, 1, 2, 4))))
        words = [word_of(field, extreme, chance) for field in positional_fields(kind)]
        words += [f"{field.prefix}{word_of(field, extreme, chance)}" for field in some]
        line = " ".join((kind.code, *words))
        if read("\n".join((line, *others)).encode()):  # its values go together
            return line


def word_of(field: Field, extreme: float, chance: Chance) -> str:
    """Return a value of a field; of the last ones of a material, some are left out."""
    if isinstance(field, Compound):
        parts = fields_of(field.record)
        count = chance.randint(sum(part.required for part in parts), len(parts))
        return ",".join(word_of(part, extreme, chance) for part in parts[:count])
    if isinstance(field, Picture) or (isinstance(field, Paint) and chance.random() < 0.3):
        return chance.choice(grammar.PICTURES)
    if isinstance(field, Three):
        return ",".join(number_of(field.component, extreme, chance) for _ in range(field.width))
    if isinstance(field, MeshField | Choice):
        return chance.choice(grammar.MESHES if isinstance(field, MeshField) else field.words)
    return number_of(field, extreme, chance) if isinstance(field, Scalar) else field.name


def number_of(field: Scalar, extreme: float, chance: Chance) -> str:
    """Return a number that a field can take."""
    low, high = field.low, field.high
    if isinstance(field, Whole):
        return str(chance.choice((int(low), int(high), chance.randint(int(low), int(high)))))
    ends = low, high, nextafter(low, high), nextafter(high, low), *EXTREME, *(-each for each in EXTREME)
    usual = chance.uniform(max(low, -9.0), min(high, chance.choice((1.0, 9.0, 99.0))))
    return repr(chance.choice([each for each in ends if low <= each <= high]) if chance.random() < extreme else usual)


def check_extreme(data: bytes) -> str:
    """Let the command draw the scene with its options, and check some scenes before; read the pictures.

    Checking takes as long as drawing, as both look for what is unseen.
    """
    options = data.partition(b"\n")[0].decode().removeprefix("#").split()
    (folder() / "fuzz.rt").write_bytes(data)
    with warnings.catch_warnings(), patch.object(kernels, "SPECIALISED_AFTER", inf):
        warnings.simplefilter("error")
        if "-v" in options:
            status, _, err = run_program(["fuzz.rt", "--check"], folder())
            assert status == OK, f"--check: {err}"
        status, _, err = run_program(["fuzz.rt", *SIZE, *options], folder())
    assert status == OK or "not reached" in err or "no more samples" in err, f"status {status}: {err}"
    assert NOT_COMPUTED not in err
    assert "-v" not in options or "rays whose light is not finite: 0" in err
    pictures = list(folder().glob("out*"))
    assert len(pictures) == (2 if "--turntable" in options else 1)
    for path in pictures:
        if path.suffix == ".pfm":
            light = np.frombuffer(path.read_bytes().split(b"\n", 3)[3], "<f4")
            assert np.isfinite(light).all()
            assert (light >= 0).all()
        else:
            assert run_program([path.name, "--check"], folder())[0] == OK, "the scene in the picture cannot be read"
        path.unlink()
    return options[0]


EXTREMES = Fuzzer(make_extreme, check_extreme, 400)
