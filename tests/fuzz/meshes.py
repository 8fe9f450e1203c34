"""Fuzzer of the mesh reader: the fast and the diagnosing reader agree, and the size of blocks changes nothing."""

from __future__ import annotations

import random
import warnings
from io import BytesIO

import numpy as np

from minirt.meshes import obj, obj_lines
from minirt.meshes.obj_lines import Block, Counts, ObjError
from minirt.meshes.triangles import Triangles
from tests.fuzz.fuzzer import Fuzzer
from tests.fuzz.mutations import mutated

NUMBERS = ("0", "1", "-1", "0.5", "1e15", "-1e15", "5e-324", "1e-400", ".5", "1.", "+2", "1e3")
OTHERS = ("", "# é", "g a", "s off", "usemtl x", "o # y", "l 1 2", "\t", "v 1 2 \\", "#v")
SMALL_BLOCK = 60  # bytes


def number(chance: random.Random) -> str:
    """Return a number."""
    return chance.choice(NUMBERS) if chance.random() < 0.2 else f"{chance.gauss(0, 2):.{chance.randint(0, 9)}f}"


def make(chance: random.Random) -> bytes:
    """Make a mesh, mutated or not; most are written as programs write them."""
    points, uvs, normals = chance.randint(3, 9), chance.choice((0, 0, 2, 5)), chance.choice((0, 0, 1, 4))
    lines = []
    for key, count, width in (("v", points, 3), ("vt", uvs, 2), ("vn", normals, 3)):
        lines += [" ".join((key, *(number(chance) for _ in range(width)))) for _ in range(count)]
    faces = [face(points, uvs, normals, chance) for _ in range(chance.randint(1, 6))]
    lines += faces if chance.random() < 0.8 else [*faces, *lines]
    if chance.random() < 0.3:
        lines.insert(chance.randint(0, len(lines)), chance.choice(OTHERS))
    if chance.random() < 0.1:
        chance.shuffle(lines)
    data = chance.choice(("\n", "\n", "\r\n")).join([*lines, ""]).encode()
    return mutated(data, chance) if chance.random() < 0.6 else data


def face(points: int, uvs: int, normals: int, chance: random.Random) -> str:
    """Return a face of some corners."""
    words = []
    for _ in range(chance.choice((3, 3, 3, 4, 5))):
        parts = [str(chance.randint(1, count) * chance.choice((1, 1, -1))) if count else "" for count in
                 (points, uvs, normals)]  # fmt: skip
        words.append("/".join(parts).rstrip("/"))
    return " ".join(("f", *words))


def check(data: bytes) -> str:
    """Compare the readers; a mesh that is accepted is finite and names corners that exist."""
    lines = BytesIO(data).readlines()
    quick = obj_lines.read_quickly(lines, Counts())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            careful = obj_lines.diagnose(lines, Counts())
        except ObjError:
            careful = None
        assert not quick or same(quick, careful), "the fast reader accepts what the diagnosing reader does not"
        whole, blocks = parse(data), parse_in_small_blocks(data)
    assert (whole is None) == (blocks is None), "the size of blocks decides whether a mesh is accepted"
    if whole is None or blocks is None:
        return "refused"
    for name in ("points", "corners", "normals", "uvs"):
        assert np.array_equal(getattr(whole, name), getattr(blocks, name)), f"the size of blocks changes {name}"
    assert np.isfinite(whole.points).all()
    assert whole.corners.min() >= 0
    assert whole.corners.max() < len(whole.points)
    return "accepted"


def same(one: Block, other: Block | None) -> bool:
    """Whether two readers have read the same."""
    return other is not None and all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))


def parse(data: bytes) -> Triangles | None:
    """Return the triangles of a mesh; None where it is refused."""
    try:
        return obj.parse(data)
    except ObjError:
        return None


def parse_in_small_blocks(data: bytes) -> Triangles | None:
    """Return the triangles of a mesh that is read in blocks of a line or two."""
    whole, obj.BLOCK_BYTES = obj.BLOCK_BYTES, SMALL_BLOCK
    try:
        return parse(data)
    finally:
        obj.BLOCK_BYTES = whole


FUZZER = Fuzzer(make, check, 300)
