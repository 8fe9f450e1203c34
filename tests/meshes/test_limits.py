"""Meshes that would take too much memory or time are refused before trimesh reads them, and nothing is written about
damaged ones but the message."""

from __future__ import annotations

import base64
import json
import os
import random
import struct
import sys
from pathlib import Path
from typing import Any

import pytest

from minirt.errors import FileError
from minirt.helpers import file_io, system
from minirt.materials import pictures
from minirt.meshes import gltf, load_mesh, obj
from tests import processes
from tests.guards import must_not_open
from tests.materials.test_pictures import encoded, png
from tests.seeds import seed_of

trimesh = pytest.importorskip("trimesh", reason="pip install trimesh scipy")

POINTS = struct.pack("<9f", -1, -1, 0, 1, -1, 0, 0, 1, 0)
UVS = struct.pack("<6f", 0, 0, 1, 0, 0.5, 1)
DOTS = encoded("PNG")


def tree_of(*images: bytes, materials: int | None = None) -> tuple[dict[str, Any], bytes]:
    """Return the JSON tree and the bytes of a glTF file: triangles, one for each material, which share the pictures."""
    blob, views = b"", []
    for part in (POINTS, UVS, *images):
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(part)})
        blob += part
    numbers = range(len(images) if materials is None else materials)
    attributes = {"POSITION": 0, "TEXCOORD_0": 1}
    primitives = [{"attributes": attributes, "material": number} for number in numbers] or [{"attributes": attributes}]
    return {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "materials": [
            {
                "pbrMetallicRoughness": {"baseColorFactor": [n / 1000, 1, 1, 1]}
                | ({"baseColorTexture": {"index": n % len(images)}} if images else {})
            }
            for n in numbers
        ],
        "textures": [{"source": number} for number in range(len(images))],
        "images": [{"bufferView": 2 + number, "mimeType": "image/png"} for number in range(len(images))],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": len(blob)}],
    }, blob


def glb(tree: dict[str, Any], blob: bytes) -> bytes:
    """Return the .glb file of a tree and bytes."""
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(blob)) + struct.pack("<I4s", len(text), b"JSON")
    return head + text + struct.pack("<I4s", len(blob), b"BIN\0") + blob


def refusal(path: Path) -> str:
    """Return the reason for which a mesh is refused."""
    with pytest.raises(FileError) as caught:
        load_mesh(path)
    assert str(caught.value) == f"{path}: {caught.value.reason}"
    return str(caught.value.reason)


@pytest.fixture
def unread(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let trimesh read nothing."""
    monkeypatch.delattr(trimesh, "load_scene")


def many_triangles() -> tuple[dict[str, Any], bytes]:
    tree, blob = tree_of()
    tree["accessors"][0]["count"] = 3000
    tree["bufferViews"][0]["byteLength"] = 36000
    tree["nodes"] = [{"mesh": 0}] * 10_000
    tree["scenes"] = [{"nodes": [*range(10_000)]}]
    return tree, blob


def with_nodes(*nodes: dict[str, Any]) -> tuple[dict[str, Any], bytes]:
    tree, blob = tree_of()
    return tree | {"nodes": nodes}, blob


def changed(kind: str, **values: Any) -> tuple[dict[str, Any], bytes]:
    tree, blob = tree_of()
    tree[kind].append(values)
    return tree, blob


TWICE = "has a node that is in two places, or within itself"
ARRAYS = "has arrays of more than 256 MiB"
HUGE = "has a picture that cannot be used: has "
BEYOND = {
    "a picture": (tree_of(png(8193, 1)), HUGE + "8193x1 pixels, more than 8192x8192"),
    "pictures": (tree_of(DOTS, png(13_000, 13_000)), HUGE + "more than 8192x8192 pixels"),
    "a program": (
        tree_of(b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 2 2\n%%EndComments\n"),
        HUGE[:-4] + "is not a picture",
    ),
    "doubling": (with_nodes(*({"children": [n + 1, n + 1]} for n in range(40)), {"mesh": 0}), TWICE),
    "a cycle": (with_nodes({"children": [1]}, {"children": [0], "mesh": 0}), TWICE),
    "triangles": (many_triangles(), "has more than 10,000,000 triangles"),
    "zeros": (changed("accessors", componentType=5126, count=10**9, type="VEC3"), ARRAYS),
    "views": (changed("bufferViews", buffer=0, byteLength=2**28), ARRAYS),
}


@pytest.mark.parametrize("name", BEYOND)
@pytest.mark.usefixtures("unread")
def test_what_is_beyond_a_limit_is_refused_before_it_is_read(tmp_path: Path, name: str) -> None:
    (tree, blob), reason = BEYOND[name]
    (tmp_path / "a.glb").write_bytes(glb(tree, blob))
    assert refusal(tmp_path / "a.glb") == reason


@pytest.mark.usefixtures("unread")
def test_values_and_parts_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tree, blob = tree_of(materials=20)
    (tmp_path / "a.glb").write_bytes(glb(tree, blob))
    monkeypatch.setattr(gltf, "MOST_PLACED", 39)  # each is made once, and placed once
    assert refusal(tmp_path / "a.glb") == "has more than 39 parts"
    monkeypatch.setattr(gltf, "MOST_VALUES", 100)
    assert refusal(tmp_path / "a.glb") == "has more than 100 values"


@pytest.mark.usefixtures("unread")
def test_memory_is_checked_for_all_pictures_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(system, "room", lambda: 2**28)
    tree, blob = tree_of(*[png(2000, 2000) + bytes([number]) for number in range(9)])  # none of which can be decoded
    (tmp_path / "a.glb").write_bytes(glb(tree, blob))
    assert refusal(tmp_path / "a.glb").startswith("the pictures need about 515 MiB of memory, allowed 256 MiB")


def test_a_picture_of_many_materials_is_decoded_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    decoded, decode = [], pictures.decode
    monkeypatch.setattr(pictures, "decode", lambda path: decoded.append(path) or decode(path))
    tree, blob = tree_of(DOTS, materials=30)
    (tmp_path / "a.glb").write_bytes(glb(tree, blob))
    mesh = load_mesh(tmp_path / "a.glb")
    assert (len(mesh), len({each.colour for each in mesh.materials[1:]}), len(decoded)) == (30, 30, 1)
    assert decoded[0].read_bytes() == DOTS
    assert {each.texture for each in mesh.materials[1:]} == {str(decoded[0])}


def gltf_naming(folder: Path, place: str, uri: str) -> Path:
    """Write a .gltf file that names another as its buffer or its picture, and return its path."""
    tree, blob = tree_of(DOTS)
    tree["buffers"][0]["uri"] = "data:;base64," + base64.b64encode(blob).decode()
    tree[place][0] = {"uri": uri, "byteLength": len(blob)}
    (folder / "a.gltf").write_text(json.dumps(tree))
    return folder / "a.gltf"


@pytest.mark.parametrize("place", ["buffers", "images"])
def test_named_files_are_regular_ones_within_the_limit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str
) -> None:
    os.mkfifo(tmp_path / "a fifo")
    (tmp_path / "large").write_bytes(bytes(2**20 + 1))
    with must_not_open(tmp_path / "a fifo", tmp_path / "large"):
        path = gltf_naming(tmp_path, place, "a%20fifo")
        assert refusal(path) == "names a file that cannot be used: is not a regular file"
        monkeypatch.setattr(file_io, "LARGEST_ASSET", 2**20)
        path = gltf_naming(tmp_path, place, "large")
        assert refusal(path) == "names a file that cannot be used: larger than 1 MiB"


def test_a_mesh_without_its_picture_is_drawn_with_a_notice(tmp_path: Path) -> None:
    mesh = load_mesh(gltf_naming(tmp_path, "images", "none.png"))
    assert mesh.notices == ("has materials of which this is not used: pictures that cannot be read",)
    assert (len(mesh), mesh.materials[1].texture) == (1, None)
    assert refusal(gltf_naming(tmp_path, "buffers", "none")).endswith("cannot be read: no such file or directory")


PLY = """ply
format ascii 1.0
comment TextureFile dots.png
element vertex 3
property float x
property float y
property float z
property float s
property float t
element face {}
property list uchar int vertex_indices
element edge 2
property int vertex1
property int vertex2
end_header
-1 -1 0 0 0
1 -1 0 1 0
0 1 0 .5 1
3 0 1 2
0 1
1 2
"""


def test_a_ply_file_and_its_picture_are_checked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.ply"
    path.write_text(PLY.format(1))
    (tmp_path / "dots.png").write_bytes(DOTS)
    mesh = load_mesh(path)
    assert Path(str(mesh.materials[1].texture)).read_bytes() == DOTS
    monkeypatch.delattr(trimesh, "load_scene")
    (tmp_path / "dots.png").write_bytes(png(8193, 1))
    path.write_text(PLY.format(1) + " ")
    assert refusal(path) == HUGE + "8193x1 pixels, more than 8192x8192"
    path.write_text(PLY.format(10**7 + 1))
    assert refusal(path) == "has more than 10,000,000 triangles"
    monkeypatch.setattr(obj, "MAX_LINES", 20)
    path.write_text(PLY.format(1) + "  ")
    assert refusal(path) == "has 21 lines, more than 20"
    path.write_text(PLY.format(1).replace("\n0 1\n", "\v0 1\v") + "\r")  # each makes a line of its own
    assert refusal(path) == "has 22 lines, more than 20"
    (tmp_path / "a.stl").write_text("vertex 0 0 0\n" * 21)
    assert refusal(tmp_path / "a.stl") == "has 21 lines, more than 20"


def test_of_edges_no_paths_are_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trimesh.path.exchange.misc.edges_to_path", None)
    (tmp_path / "a.ply").write_text(PLY.format(1))
    assert len(load_mesh(tmp_path / "a.ply")) == 1


SAMPLES = struct.pack("<HHIH", 277, 3, 1, 3)  # a pixel of a TIFF has three
INFINITE = bytes(80) + struct.pack("<I12fH", 1, 0, 0, 0, *[float("inf")] * 5, *[-3e38] * 4, 0)
TIFF = ("RGB", "tiff_lzw"), ("RGB", "jpeg"), ("RGB", "tiff_adobe_deflate"), ("1", "group4")
READ_ALL = """
import logging
import sys
from contextlib import suppress
from pathlib import Path
from minirt.errors import FileError
from minirt.materials.pictures import picture
from minirt.meshes import load_mesh
for path in sorted(Path(sys.argv[1]).iterdir()):
    with suppress(FileError):
        (picture if path.suffix == ".tif" else load_mesh)(path)
logging.getLogger("trimesh.util").warning("unable to convert colors!")
"""


def damaged(data: bytes, chance: random.Random) -> bytes:
    """Return a file with some other bytes, or without its end."""
    changed = bytearray(data)
    for _ in range(chance.randint(1, 5)):
        changed[chance.randrange(len(data))] = chance.randrange(256)
    return bytes(changed[: chance.choice((len(data), len(data) * 9 // 10))])


def test_nothing_is_written_about_damaged_files(tmp_path: Path) -> None:
    """Neither by libtiff, which is no Python, nor by the loggers of Pillow and trimesh, nor as warnings of numpy."""
    chance = random.Random(seed_of("damaged meshes and pictures"))
    box = trimesh.creation.box()
    files = [("tif", encoded("TIFF", mode, compression=each)) for mode, each in TIFF]
    files += [("glb", glb(*tree_of(encoded("TIFF", compression="tiff_lzw"))))]
    files += [(kind, box.export(file_type=kind)) for kind in ("stl", "ply")] + [("ply", PLY.format(1).encode())]
    for number in range(20):
        for index, (suffix, data) in enumerate(files):
            (tmp_path / f"{index}-{number}.{suffix}").write_bytes(damaged(data, chance))
    (tmp_path / "samples.tif").write_bytes(encoded("TIFF").replace(SAMPLES, SAMPLES[:-2] + b"\x4d\0"))
    deflated = bytearray(encoded("TIFF", compression="tiff_adobe_deflate"))
    deflated[40:42] = b"\0\0"
    (tmp_path / "deflated.tif").write_bytes(deflated)
    (tmp_path / "infinite.stl").write_bytes(INFINITE)
    ended = processes.run([sys.executable, "-c", READ_ALL, str(tmp_path)], text=True)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")
