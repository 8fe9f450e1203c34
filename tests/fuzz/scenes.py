"""Fuzzer of the scene reader: grammar and byte mutations of scenes, with the strict grammar as the referee.

Each file is read twice: as it is, by the diagnosing reader, and behind many comments, by the fast reader. Both must
agree with the referee. A lenient reader accepts whatever a strict one does.
"""

from __future__ import annotations

import random

from minirt.errors import SceneError
from minirt.scene import Scene, dump, parse
from minirt.scene.fast import FEW_LINES
from tests.fuzz import scene_grammar, scene_words
from tests.fuzz.fuzzer import Fuzzer
from tests.fuzz.mutations import mutated
from tests.fuzz.scene_files import folder

COMMENTS = b"#\n" * FEW_LINES  # so many lines that the fast reader is used
BOM = b"\xef\xbb\xbf"


def make(chance: random.Random) -> bytes:
    """Make a scene file, mutated or not."""
    data = scene_words.scene(chance)
    return mutated(data, chance) if chance.random() < 0.5 else data


def check(data: bytes) -> str:
    """Compare the readers with the referee."""
    expected = scene_grammar.is_scene(data)
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


FUZZER = Fuzzer(make, check, 300)
