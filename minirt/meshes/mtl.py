"""Reader of Wavefront .mtl files: each material becomes attributes of this program's shapes.

`Kd` is the colour: 1 is the level 255, 0.5 the level 128. `map_Kd` is the texture, whose light is multiplied by that of
`Kd` (Wavefront, Material Library File format); a black `Kd`, which some programs write beside `map_Kd`, is left out
there, with a notice. `Ks` and `Ns` make a highlight, by the halfway vector and without colour, unless `illum` is 0 or
1; where it is 3 to 8, `Ks` is also the share of a mirror. `d` below 1, or `Tr` above 0, makes glass of the index `Ni`
that lets the rest through. `map_Bump` is the bump map, or the normal map if its name has "norm".
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from minirt.errors import FieldError, FileError
from minirt.fields import Colour, Triple, clamp, declare
from minirt.fields.field import file_name
from minirt.fields.scalars import number
from minirt.helpers import file_io
from minirt.helpers.file_io import is_file
from minirt.materials import GREATEST, Attributes, Bump, Glass, Mirror, Specular, pictures
from minirt.records import record

MAPS = re.compile(r"map_Kd|(?:map_)?[Bb]ump|norm|map_Kn")
UNUSED = re.compile(r"Ke|Tf|P[rmsc]|map_(?:Ks|Ns|d|Ke|Pr|Pm)|disp|decal|refl")
STRENGTH = 0.02  # of a bump map with the multiplier 1
OPTIONS = re.compile(r"^(?:-\w+ (?:(?:[-+.0-9e]+|on|off|[rgbmlz]) )*)*")  # before the name of a picture
MULTIPLIER = re.compile(r"-bm ([0-9.]+)")


@record(kw_only=True)
class MeshMaterial(Attributes):
    """A material of a mesh: attributes, and a colour by which that of the mesh is multiplied."""

    title = "material"
    colour: Triple = declare(Colour, "colour", default=(255, 255, 255))


def library_paths(names: Iterable[str], folder: Path) -> tuple[Path, ...]:
    """Return the files of materials that lines of a mesh name: several a line, or one whose name has blanks."""
    return tuple(folder / each for name in names for each in ([name] if is_file(folder / name) else name.split()))


def read_libraries(paths: Iterable[Path], folder: Path) -> tuple[dict[str, MeshMaterial], set[str]]:
    """Return the materials of the files `paths`, by their names, and words for what is not used of them.

    Pictures are looked for in `folder`. Where a name is given twice, later statements of one key count.
    """
    found: dict[str, dict[str, str]] = {}
    unused: set[str] = set()
    for path in paths:
        said: dict[str, str] = {}  # statements of the present material; those before the first one are dropped
        try:
            lines = file_io.read(path, file_io.LARGEST_ASSET).decode("utf-8", "replace").splitlines()
        except FileError:
            unused.add("a file of materials that cannot be read")
            continue
        for line in lines:
            key, _, value = " ".join(line.partition("#")[0].split()).partition(" ")
            if key == "newmtl":
                said = found.setdefault(value, {})
            else:
                said[key] = value
    return {name: material_of(said, folder, unused) for name, said in found.items()}, unused


def material_of(said: dict[str, str], folder: Path, unused: set[str]) -> MeshMaterial:
    """Return the material that the statements `said` mean, values by their keys; add to `unused` what is not used.

    Pictures are looked for in `folder`.
    """
    values: dict[str, Any] = {"colour": tuple(round(255 * clamp(each, 0, 1)) for each in three(said.get("Kd"), 1.0))}
    share = clamp(sum(three(said.get("Ks"), 0.0)) / 3, 0, 1)
    exponent, illum = three(said.get("Ns"), 0.0)[0], three(said.get("illum"), 2.0)[0]
    opacity = three(said.get("d", "").removeprefix("-halo "), 1 - three(said.get("Tr"), 0.0)[0])[0]
    if share and exponent > 0 and illum >= 2:
        values["specular"] = Specular(share, clamp(exponent, 1, GREATEST), blinn=True)
    if share and 3 <= illum <= 8:
        values["mirror"] = Mirror(share)
    if opacity < 1:
        values["glass"] = Glass(clamp(three(said.get("Ni"), 1.0)[0], 1, 10), 1 - clamp(opacity, 0, 1))
    for key, value in said.items():
        if MAPS.fullmatch(key):
            try:
                values |= map_of(key, value, folder)
            except (FileError, FieldError):
                unused.add("pictures that cannot be read")
        elif UNUSED.fullmatch(key):
            neutral = 1.0 if key == "Tf" else 0.0  # the value without an effect; 2 stands for what is no number
            if any(each != neutral for each in three(value, 2.0)):
                unused.add(key)
    if "texture" in values and not any(values["colour"]):
        del values["colour"]
        unused.add("a black Kd beside map_Kd")
    return MeshMaterial(**values)


def three(text: str | None, usual: float) -> list[float]:
    """Return the three numbers of a statement, which are alike where it has one; the usual ones for other words."""
    with suppress(FieldError):
        found = list(map(number, (text or "").split()))
        return found[:3] if len(found) > 2 else found[:1] * 3 or [usual] * 3
    return [usual] * 3


def map_of(key: str, text: str, folder: Path) -> dict[str, Any]:
    """Return the attribute of a map, such as `-bm 0.5 relief.png`; FileError where its picture cannot be read."""
    name = OPTIONS.sub("", text).replace("\\", "/")
    path = next(filter(is_file, (folder / name, folder / Path(name).name)), folder / name)
    file = file_name(os.path.abspath(path), ",")  # noqa: PTH100 - looked up from the folder of any scene
    is_bump = key.lower().endswith("bump") and "norm" not in path.name.lower()
    (pictures.heights if is_bump else pictures.picture)(path)
    if is_bump:
        multiplier = MULTIPLIER.search(text)
        return {"bump": Bump(file, clamp(STRENGTH * three(multiplier and multiplier[1], 1.0)[0], -10, 10))}
    return {"texture" if key == "map_Kd" else "normal_map": file}
