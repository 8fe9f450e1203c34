"""Prepare glTF files, .gltf or .glb, for trimesh: it gets the triangles, once they are within the limits.

Factors and colours of points are linear in glTF, pictures are encoded by the curve of sRGB. The colours of a scene are
as those of pictures: with `tone:srgb` they are decoded by that curve, with `tone:plain` they are shown as they are. So
a linear colour is encoded here, for any tone: a factor of 0.5 becomes the level 188.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from operator import index, mul
from typing import Any

import numpy as np

from minirt.fields import clamp
from minirt.helpers import file_io
from minirt.meshes.named_files import WHITE, Files, Look
from minirt.meshes.obj import check_triangles
from minirt.meshes.obj_lines import ObjError

MOST_VALUES = 2**22  # objects, arrays and commas of the JSON text, which take up to 100 bytes each in Python
MOST_PLACED = 2**16  # primitives of nodes, for each of which trimesh takes a millisecond
BINARY = "binary"  # the name of the bytes behind the JSON text of a .glb file
WEBP = "EXT_texture_webp"
LEFT_OUT = ("name", "extras", "extensions", "camera", "images", "textures")  # trimesh copies some of them for each node
SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


def prepare(data: bytes, files: Files) -> tuple[bytes, dict[str, Look], bool]:
    """Return a .gltf file for trimesh, how its materials look, by their names in it, and whether it has normals.

    `data` is a .gltf or .glb file. `files` gets the binary part of a .glb file, and pictures. ObjError where the file
    is beyond a limit, FileError where a file that it names is; any other error where it is damaged.
    """
    text = data
    if data.startswith(b"glTF"):  # a header of 12 bytes; length and kind, 8 bytes, before the text and the binary part
        (length,) = struct.unpack_from("<I", data, 12)
        text, files.contents[BINARY] = data[20 : 20 + length], data[28 + length :]
    if sum(map(text.count, (b"{", b"[", b","))) > MOST_VALUES:
        raise ObjError(f"has more than {MOST_VALUES:,} values")
    tree = json.loads(text)
    check(tree)
    looks = {str(number): look_of(each, tree, files) for number, each in enumerate(tree.get("materials", ()))}
    kept = json.loads(text, object_hook=bare) | {"materials": [{"name": name} for name in looks]}
    kept["buffers"] = [{"uri": BINARY} | buffer for buffer in kept["buffers"]]
    has_normals = add_normals(kept)
    return json.dumps(kept).encode(), looks, has_normals


def bare(values: dict[str, Any]) -> dict[str, Any]:
    """Return the values of an object that trimesh gets: no words, pictures, extensions or attributes of programs."""
    return {name: value for name, value in values.items() if name not in LEFT_OUT and not name.startswith("_")}


def add_normals(tree: Mapping[str, Any]) -> bool:
    """Add normals of length 0, which stand for flat ones, to the parts without normals of a file that has some; return
    whether it has."""
    parts = [part["attributes"] for mesh in tree["meshes"] for part in mesh["primitives"]]
    flat = [part for part in parts if "NORMAL" not in part]
    has_some = len(flat) < len(parts)
    for part in flat if has_some else []:
        points, part["NORMAL"] = tree["accessors"][part["POSITION"]], len(tree["accessors"])
        tree["accessors"].append({"componentType": 5126, "count": points["count"], "type": "VEC3"})
    return has_some


def encoded(light: Any) -> np.ndarray:
    """Encode shares of light in [0, 1] by the curve of sRGB (IEC 61966-2-1)."""
    shares = np.asarray(light, np.float64)
    return np.where(shares <= 0.0031308, 12.92 * shares, 1.055 * shares ** (1 / 2.4) - 0.055)


def check(tree: Mapping[str, Any]) -> None:
    """Raise ObjError if the arrays of a file are too large, or if the nodes of its scene show too many triangles or
    parts. Any other error tells that the file is damaged."""
    counts = [abs(index(each["count"])) for each in tree["accessors"]]
    widths = [SIZES[each["componentType"]] * WIDTHS[each["type"]] for each in tree["accessors"]]
    views = sum(abs(index(view["byteLength"])) for view in tree["bufferViews"])
    if max(views, sum(map(mul, counts, widths))) > file_io.LARGEST_ASSET:
        raise ObjError(f"has arrays of more than {file_io.LARGEST_ASSET // 2**20} MiB")
    corners, parts = [], [len(mesh["primitives"]) for mesh in tree["meshes"]]  # of each mesh
    for mesh in tree["meshes"]:
        points = [each["attributes"]["POSITION"] for each in mesh["primitives"]]
        order = [each.get("indices", point) for each, point in zip(mesh["primitives"], points, strict=True)]
        corners.append(sum(max(counts[one], counts[other]) for one, other in zip(points, order, strict=True)))
    shown, placed, seen = sum(corners), sum(parts), set()  # trimesh makes each mesh once, and once for each node
    waiting = [*tree["scenes"][tree.get("scene", 0)].get("nodes", ())]
    while waiting:
        number = waiting.pop()
        if number in seen:
            raise ObjError("has a node that is in two places, or within itself")
        seen.add(number)
        node = tree["nodes"][number]
        waiting += node.get("children", ())
        if "mesh" in node:
            shown, placed = shown + corners[node["mesh"]], placed + parts[node["mesh"]]
    check_triangles(shown // 3)
    if placed > MOST_PLACED:
        raise ObjError(f"has more than {MOST_PLACED:,} parts")


def look_of(material: Mapping[str, Any], tree: Mapping[str, Any], files: Files) -> Look:
    """Return how a material looks; its picture becomes one of `files`. FileError where that is beyond a limit."""
    look = material.get("pbrMetallicRoughness", {})
    colour = tuple(encoded([clamp(share, 0, 1) for share in look.get("baseColorFactor", WHITE)[:3]]).tolist())
    if "baseColorTexture" not in look:
        return Look(colour)
    texture = tree["textures"][look["baseColorTexture"]["index"]]
    number = texture.get("source", texture.get("extensions", {}).get(WEBP, {}).get("source"))
    name = f"picture{number}"
    if number is not None and name not in files.pictures:
        image = tree["images"][number]
        if "uri" in image:
            files.add_picture(name, image["uri"])
        else:
            view = tree["bufferViews"][image["bufferView"]]
            start = view.get("byteOffset", 0)
            uri = tree["buffers"][view["buffer"]].get("uri", BINARY)
            files.add_picture(name, uri, slice(start, start + view["byteLength"]))
    return Look(colour, name)
