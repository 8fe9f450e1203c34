"""Meshes of glTF, .ply and .stl files are what their formats mean: normals, colours and points that are no numbers."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.errors import FileError
from minirt.meshes import gltf, load_mesh
from minirt.meshes.obj import NOT_FINITE
from minirt.scene import parse

pytest.importorskip("trimesh", reason="pip install trimesh scipy")

FOLD = np.array([[-1, 0, 1], [0, 0, 0], [0, 1, 0], [1, 0, 1]], np.float32)
FACES = np.array([0, 1, 2, 1, 3, 2], np.uint16)
NORMALS = np.array([[0, 0, -1], [0, 0.6, -0.8], [0, 0, -1], [0, 0, -1]], np.float32)
UVS = np.zeros((4, 2), np.float32)
PARTS = {"POSITION": (FOLD, "VEC3"), "NORMAL": (NORMALS, "VEC3"), "TEXCOORD_0": (UVS, "VEC2")}
HEAD = "A 1 255,255,255\nC 0,0.3,-4 0,0,1 30 {}\nob {} 0,0,0 1 255,255,255\n"


def written(path: Path, *parts: dict[str, Any], material: Any = None, points: Any = FOLD) -> Path:
    """Write a .gltf file of folds, each with these attributes beside POSITION, and one material for all."""
    blob, views, accessors, primitives = b"", [], [], []
    for extra in parts:
        named = {"POSITION": (points, "VEC3"), **extra, "indices": (FACES, "SCALAR")}
        numbers = {}
        for name, (array, sort) in named.items():
            data = array.tobytes()
            views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
            kind = 5126 if array.dtype == np.float32 else 5123
            accessors.append({"bufferView": len(views) - 1, "componentType": kind, "count": len(array), "type": sort})
            numbers[name] = len(accessors) - 1
            blob += data
        primitive = {"indices": numbers.pop("indices"), "attributes": numbers}
        primitives.append(primitive | ({"material": 0} if material else {}))
    tree = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "rotation": [0, 0, 1, 0]}],
        "meshes": [{"primitives": primitives}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(blob), "uri": "data:;base64," + base64.b64encode(blob).decode()}],
    }
    if material:
        tree |= {"materials": [{"pbrMetallicRoughness": material}], "textures": [{"source": 0}]}
        tree["images"] = [{"uri": "even.png"}]
    path.write_text(json.dumps(tree))
    return path


def test_parts_without_normals_are_flat(tmp_path: Path) -> None:
    normal, uvs = {"NORMAL": PARTS["NORMAL"]}, {"TEXCOORD_0": PARTS["TEXCOORD_0"]}
    assert load_mesh(written(tmp_path / "flat.gltf", {})).normals is None
    mixed = load_mesh(
        written(tmp_path / "mixed.gltf", {}, normal | {"COLOR_0": (FOLD, "VEC3")}, uvs, points=UNUSED[:4])
    )
    assert mixed.normals is not None
    turned = NORMALS[FACES.reshape(2, 3)] * (-1, -1, 1)
    assert np.allclose(mixed.normals[2:4], turned, atol=1e-6)
    for flat in (slice(0, 2), slice(4, 6)):
        assert np.allclose(mixed.normals[flat], mixed.flat_normals[flat, None])
    assert not np.allclose(mixed.normals[0], mixed.normals[1])


@pytest.mark.parametrize(("factor", "level"), [(0.5, 188), (0.0, 0), (0.001, 3), (1.0, 255), (2.0, 255)])
def test_factors_are_linear(tmp_path: Path, factor: float, level: int) -> None:
    mesh = load_mesh(written(tmp_path / "a.gltf", {}, material={"baseColorFactor": [factor] * 3 + [1]}))
    assert {each.colour for each in mesh.materials[1:]} == {(level,) * 3}


def linear(path: Path, tone: str) -> np.ndarray:
    """Return the light of a mesh in the middle of a picture in white light."""
    scene = parse(HEAD.format(tone, path.name), str(path.with_suffix(".rt"))).scene
    return np.asarray(minirt.render(scene, 9, 9, linear=True).linear[6, 4])


@pytest.mark.parametrize("factor", [(1, 0, 0), (0, 0, 0), (0.5, 0.25, 1)])
def test_factors_multiply_pictures(tmp_path: Path, factor: tuple[float, float, float]) -> None:
    """In light that the picture is decoded to; what is shown without decoding differs little from that, encoded."""
    Image.new("RGB", (2, 2), (188, 188, 188)).save(tmp_path / "even.png")
    material = {"baseColorFactor": [*factor, 1], "baseColorTexture": {"index": 0}}
    path = written(tmp_path / "a.gltf", {"TEXCOORD_0": PARTS["TEXCOORD_0"]}, material=material)
    assert np.allclose(linear(path, "tone:srgb"), 0.5 * np.array(factor), atol=4e-3)
    encoded = gltf.encoded(0.5 * np.array(factor))
    assert np.allclose(linear(path, "tone:plain"), encoded, atol=0.02)


def test_colours_of_points_are_linear(tmp_path: Path) -> None:
    colours = np.full((4, 3), (0.5, 0, 1), np.float32)
    mesh = load_mesh(written(tmp_path / "a.gltf", {"COLOR_0": (colours, "VEC3")}))
    assert mesh.colours is not None
    assert mesh.colours.tolist() == [[188, 0, 255]] * 2


UNUSED = np.concatenate([FOLD, [[np.nan, 0, 0]], [[0, np.inf, 0]]]).astype(np.float32)


def ply(path: Path, points: np.ndarray, faces: np.ndarray) -> Path:
    """Write a binary .ply file."""
    head = "ply\nformat binary_little_endian 1.0\nelement vertex {}\n" + "".join(f"property float {x}\n" for x in "xyz")
    head += "element face {}\nproperty list uchar int vertex_indices\nend_header\n"
    data = points.astype("<f4").tobytes() + b"".join(struct.pack("<B3i", 3, *each) for each in faces.tolist())
    path.write_bytes(head.format(len(points), len(faces)).encode() + data)
    return path


def test_points_that_are_no_numbers_count_only_if_a_face_names_them(tmp_path: Path) -> None:
    faces = FACES.reshape(2, 3)
    for path in (written(tmp_path / "a.gltf", {}, points=UNUSED), ply(tmp_path / "a.ply", UNUSED, faces)):
        mesh = load_mesh(path)
        assert (len(mesh), len(mesh.points), mesh.notices) == (2, 4, (NOT_FINITE,))
        assert load_mesh(ply(tmp_path / "b.ply", FOLD, faces)).notices == ()
    used = np.where(np.arange(4)[:, None] == 3, np.nan, FOLD).astype(np.float32)
    stl = bytes(80) + struct.pack("<I12fH", 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, np.inf, 0, 0)
    (tmp_path / "c.stl").write_bytes(stl)
    for path in (
        written(tmp_path / "c.gltf", {}, points=used),
        ply(tmp_path / "c.ply", used, faces),
        tmp_path / "c.stl",
    ):
        with pytest.raises(FileError) as caught:
            load_mesh(path)
        assert caught.value.reason == "v must be a number"


def test_points_out_of_range_are_named_without_a_line(tmp_path: Path) -> None:
    with pytest.raises(FileError) as caught:
        load_mesh(ply(tmp_path / "a.ply", FOLD * 1e30, FACES.reshape(2, 3)))
    assert caught.value.reason == "v must be in [-1e+15, 1e+15]"


def test_a_ply_file_with_uvs_and_without_colours_is_white(tmp_path: Path) -> None:
    text = "ply\nformat ascii 1.0\nelement vertex 3\n" + "".join(f"property float {x}\n" for x in "xyzst")
    text += "element face 1\nproperty list uchar uint vertex_indices\nend_header\n"
    path = tmp_path / "a.ply"
    path.write_text(text + "-1 -1 0 0 0\n1 -1 0 1 0\n0 1 0 0.5 1\n3 0 1 2\n")
    assert np.array_equal(linear(path, "tone:plain"), (1, 1, 1))
