"""Mesh: `ob file x,y,z scale R,G,B`.

Triangles from a Wavefront .obj file, whose path begins at the folder of the scene file. The origin of the file is at
`x,y,z` in the scene, and lengths of the file are multiplied by `scale`. Triangles that share corners have no gap
between them. Normals of the file make the surface look smooth (Phong shading), and its texture coordinates place
pictures. With `axis:ax,ay,az` the file's y axis points there, turned as for a box, and with `roll:degrees` the mesh is
turned about it. The colours of the materials of its .mtl files, and their textures, are multiplied by `R,G,B`; their
other attributes count where the line has none of its own (`minirt.meshes.mtl`).

    ob meshes/knot.obj 0,1,20 2.5 220,180,90    a knot, two and a half times as large as in its file
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np

from minirt import meshes
from minirt.element import fields_of
from minirt.fields import FARTHEST, Colour, Length, MeshField, MeshFile, Point, Triple, declare
from minirt.lanes import Vec
from minirt.materials import Attributes
from minirt.records import record
from minirt.shapes import smooth_triangle
from minirt.shapes.plane_normals import plane_normals
from minirt.shapes.shape import Ball, Bounds, Turnable
from minirt.shapes.smooth_triangle import BARYCENTRIC, PackedMeshTriangle

BLOCK = 16384  # triangles that are packed at a time, and stay in the cache of a core
ATTRIBUTES = tuple(field.name for field in fields_of(Attributes))
# Columns of `Mesh.rows`: three corners, the normal of the plane, a normal at each corner, u and v at each corner.
CORNERS, NORMAL, NORMALS, UVS = slice(0, 9), slice(9, 12), slice(12, 21), slice(21, 27)


@record()
class Mesh(Turnable):
    """A line `ob` of a scene file."""

    code, title, plural, aliases, batched = "ob", "mesh", "meshes", ("obj",), True
    file: MeshFile = declare(MeshField, "a mesh file")
    position: Triple = declare(Point, "where its origin is")
    scale: float = declare(Length, "length of what is 1 in the file")
    colour: Triple = declare(Colour, "colour")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.file.triangles is None:
            object.__setattr__(self, "file", MeshFile(self.file.name, self.triangles))
            super().__post_init__()  # now that its size is known

    @classmethod
    def from_arrays(
        cls, vertices: Any, faces: Any, *, normals: Any = None, uvs: Any = None, file: str | None = None,
        position: Triple = (0.0, 0.0, 0.0), scale: float = 1.0, colour: Triple = (255, 255, 255), **attributes: Any,
    ) -> Mesh:  # fmt: skip
        """Return a mesh of `vertices` (n, 3) and `faces` (m, 3), indices of vertices that run counter-clockwise as seen
        from outside. A list of faces of any numbers of corners will do, too: they are cut into triangles.

        `normals` (n, 3) of the vertices let the mesh look smooth, `uvs` (n, 2) place pictures. `position` is where the
        origin of the vertices is, `scale` the length of what is 1 there. Saving a scene writes the mesh beside the
        scene, into `file`, which is named after the contents where it is left out. ElementError for other arrays.

            mesh = minirt.Mesh.from_arrays(data.points, data.regular_faces)  # a PolyData of pyvista
        """
        from minirt.meshes.from_arrays import digest, triangles_of

        triangles = triangles_of(vertices, faces, normals, uvs)
        named = MeshFile(file or f"mesh-{digest(triangles)[:12]}.obj", triangles, is_new=True)
        return cls(named, position, scale, colour, **attributes)

    @classmethod
    def from_trimesh(cls, mesh: Any, *, smooth: bool = False, **how: Any) -> Mesh:
        """Return a mesh of a `trimesh.Trimesh` with its texture coordinates; if `smooth`, with its normals, too.

        The other arguments are those of `from_arrays`. TypeError for another object.
        """
        if not (hasattr(mesh, "vertices") and hasattr(mesh, "faces")):
            raise TypeError(f"from_trimesh takes a trimesh.Trimesh, got {mesh!r:.60}; a trimesh.Scene has .to_mesh()")
        uvs = getattr(getattr(mesh, "visual", None), "uv", None)
        return cls.from_arrays(
            mesh.vertices, mesh.faces, normals=mesh.vertex_normals if smooth else None, uvs=uvs, **how
        )

    def conflict(self) -> tuple[str, str] | None:
        if self.file.triangles is None or np.abs(self.hull).max() <= FARTHEST:  # the box takes a look at all points
            return None
        if np.abs(self.box).max() <= FARTHEST:
            return None
        fits_about_origin = np.abs(self.box - self.position).max() <= FARTHEST
        name, much = ("position", "far out") if fits_about_origin else ("scale", "large")
        return name, f"must not be so {much} that the mesh reaches beyond {FARTHEST:g}"

    @property
    def triangles(self) -> meshes.Triangles:
        """The triangles of its file, which is read now if it was not yet; FileError where it cannot be read."""
        loaded: meshes.Triangles | None = self.file.triangles
        return meshes.load_mesh(self.file.name) if loaded is None else loaded

    @property
    def parts(self) -> int:  # type: ignore[override]
        return len(self.triangles)

    @property
    def smooth(self) -> bool:  # type: ignore[override]
        """Whether its file has normals."""
        return self.triangles.normals is not None

    @cached_property
    def looks(self) -> tuple[Mesh, ...]:
        """A mesh of one triangle for each material of the file, which has all attributes of triangles of that material.

        They are those of the material, but where the mesh has its own; the colours of both are multiplied. For a file
        without materials it is the mesh itself.
        """
        if self.triangles.material_of is None:
            return (self,)
        triangle = replace(self.triangles.some(np.arange(1)), material_of=None)
        own = {name: value for name in ATTRIBUTES if (value := getattr(self, name)) is not None}
        return tuple(
            self.replace(
                file=MeshFile(self.file.name, replace(triangle, materials=(material,) if self.texture is None else ())),
                **{name: getattr(material, name) for name in ATTRIBUTES} | own,
                colour=tuple(round(a * b / 255) for a, b in zip(self.colour, material.colour, strict=True)),
            )
            for material in self.triangles.materials
        )

    @property
    def filter(self) -> Triple:  # type: ignore[override]
        """The colour of one of the `looks`, which multiplies the texture of its material; white otherwise."""
        return self.colour if self.triangles.materials else super().filter

    def look_numbers(self) -> np.ndarray:
        """The index in `looks` of that of each triangle, (m,)."""
        numbers: np.ndarray | None = self.triangles.material_of
        return np.zeros(len(self.triangles), np.int64) if numbers is None else numbers

    def colours(self) -> np.ndarray:
        """The colour of each triangle, (m, 3), in [0, 1]."""
        colours = np.array([look.colour for look in self.looks], np.float64)[self.look_numbers()] / 255
        return colours if self.triangles.colours is None else colours * self.triangles.colours / 255

    def some(self, indices: np.ndarray) -> Mesh:
        return self.replace(file=replace(self.file, triangles=self.triangles.some(indices)))

    def placed(self, points: np.ndarray) -> np.ndarray:
        """Transform points of the file into the scene. Equal points stay equal."""
        placed: np.ndarray = self.scale * self.turned(points) + self.position
        return placed

    def turned(self, vectors: np.ndarray) -> np.ndarray:
        """Turn vectors of the file, (n, 3), as the mesh is turned. Equal vectors stay equal."""
        if not self.is_turned:
            return vectors
        own_z, own_x, own_y = self.frame()
        x, y, z = vectors.T.copy()
        turned = own_x * x + own_y * y + own_z * z  # no matrix product, which may round row by row
        return np.stack([turned.x, turned.y, turned.z], axis=1)

    @property
    def hull(self) -> np.ndarray:
        """Corners of the bounding box in the file, placed in the scene, (8, 3)."""
        return self.placed(np.array([*product(*self.triangles.box.T)]))

    @cached_property
    def box(self) -> np.ndarray:
        """Bounding box in the scene: least and greatest corner, (2, 3)."""
        if not self.is_turned:
            return self.placed(self.triangles.box)
        columns = self.placed(self.triangles.points).T.copy()
        return np.stack([columns.min(axis=1), columns.max(axis=1)])

    def rows(self) -> np.ndarray:
        """All packed triangles, (m, 27): a row has the numbers of one `PackedMeshTriangle`, in the scene.

        A file without normals gets those of the planes, one without texture coordinates `BARYCENTRIC` ones.
        """
        triangles = self.triangles
        packed = np.empty((len(triangles), 27))
        points, flat = self.placed(triangles.points), self.turned(triangles.flat_normals)
        for start in range(0, len(triangles), BLOCK):
            which = slice(start, start + BLOCK)
            rows = packed[which]
            rows[:, CORNERS] = points[triangles.corners[which]].reshape(-1, 9)
            rows[:, NORMAL] = plane_normals(rows[:, CORNERS], flat[which])
            if triangles.normals is None:
                rows[:, NORMALS].reshape(-1, 3, 3)[...] = rows[:, None, NORMAL]
            else:
                rows[:, NORMALS] = self.turned(triangles.normals[which].reshape(-1, 3)).reshape(-1, 9)
            rows[:, UVS] = BARYCENTRIC if triangles.uvs is None else triangles.uvs[which].reshape(-1, 6)
        return packed

    def pack(self) -> PackedMeshTriangle:
        """One `PackedMeshTriangle` whose numbers are arrays over all triangles."""
        columns = self.rows().T
        vecs = [Vec(*columns[start : start + 3]) for start in range(0, 21, 3)]
        return PackedMeshTriangle._make([*vecs, *columns[21:]])

    def balls(self) -> tuple[Ball, ...]:
        return tuple((tuple(corner), 0.0) for corner in self.hull.tolist())

    def bounds(self) -> Bounds:
        low, high = self.box.tolist()
        return tuple(low), tuple(high)


# The formulas of its triangles.
intersect, surface, may_meet = smooth_triangle.intersect, smooth_triangle.surface, smooth_triangle.may_meet
mapping, shading = smooth_triangle.mapping, smooth_triangle.shading
smooth_point, boundary = smooth_triangle.smooth_point, smooth_triangle.boundary
