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
from typing import Any, NamedTuple

import numpy as np

from minirt import meshes
from minirt.element import fields_of
from minirt.fields import FARTHEST, Colour, Length, MeshField, MeshFile, Point, Triple, declare
from minirt.lanes import Number, Vec, any, copysign, cross, dot, max_norm, maximum, minimum, unit, where
from minirt.materials import Attributes
from minirt.records import record
from minirt.shapes import triangle
from minirt.shapes.boundary import Boundary, facing
from minirt.shapes.shape import Ball, Bounds, Position, Turnable
from minirt.shapes.triangle import plane_normals

BARYCENTRIC = (0.0, 0.0, 1.0, 0.0, 0.0, 1.0)  # u and v at the three corners where the file has none
BLOCK = 16384  # triangles that are packed at a time, and stay in the cache of a core
ATTRIBUTES = tuple(field.name for field in fields_of(Attributes))
OPPOSED = 1e-3  # squared length of a mean of unit normals; below it they cancel, and the mean points anywhere


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
        from outside; or of a list of faces of any numbers of corners, which are cut into triangles.

        `normals` (n, 3) of the vertices let it look smooth, `uvs` (n, 2) place pictures. Saving a scene writes the mesh
        beside it, into `file`, which is named after the contents where it is left out. ElementError for other arrays.

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
        """One of its triangles for each material of its file, with the attributes of that and the mesh's own, which
        count more; the mesh itself where the file has none. The colours are multiplied."""
        if self.triangles.material_of is None:
            return (self,)
        triangle = replace(self.triangles.some(np.arange(1)), material_of=None)
        own = {name: value for name in ATTRIBUTES if (value := getattr(self, name)) is not None}
        return tuple(
            self.replace(
                file=MeshFile(self.file.name, replace(triangle, materials=(material,) * (self.texture is None))),
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
        """All packed triangles, (m, 27), the numbers of one `PackedMeshTriangle` a row."""
        triangles = self.triangles
        packed = np.empty((len(triangles), 27))
        points, flat = self.placed(triangles.points), self.turned(triangles.flat_normals)
        for start in range(0, len(triangles), BLOCK):
            which = slice(start, start + BLOCK)
            rows = packed[which]
            rows[:, :9] = points[triangles.corners[which]].reshape(-1, 9)
            rows[:, 9:12] = plane_normals(rows[:, :9], flat[which])
            if triangles.normals is None:
                rows[:, 12:21].reshape(-1, 3, 3)[...] = rows[:, None, 9:12]
            else:
                rows[:, 12:21] = self.turned(triangles.normals[which].reshape(-1, 3)).reshape(-1, 9)
            rows[:, 21:] = BARYCENTRIC if triangles.uvs is None else triangles.uvs[which].reshape(-1, 6)
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


class PackedMeshTriangle(NamedTuple):
    """Packed form of one triangle of a mesh."""

    a: Position
    b: Position
    c: Position
    normal: Vec
    normal_a: Vec  # shading normals at the corners
    normal_b: Vec
    normal_c: Vec
    u_a: float  # texture coordinates at the corners
    v_a: float
    u_b: float
    v_b: float
    u_c: float
    v_c: float


intersect, surface, may_meet = triangle.intersect, triangle.surface, triangle.may_meet


def barycentric_coordinates(mesh: PackedMeshTriangle, point: Vec) -> tuple[Number, Number, Number]:
    """Barycentric coordinates of a point of the triangle, clamped to [0, 1]."""
    ab, ac, ap = mesh.b - mesh.a, mesh.c - mesh.a, point - mesh.a
    whole = dot(cross(ab, ac), mesh.normal)  # twice the area
    of_b = minimum(maximum(dot(cross(ap, ac), mesh.normal) / whole, 0.0), 1.0)
    of_c = minimum(maximum(dot(cross(ab, ap), mesh.normal) / whole, 0.0), 1.0 - of_b)
    return 1.0 - of_b - of_c, of_b, of_c


def shading(mesh: PackedMeshTriangle, point: Vec, normal: Vec) -> Vec:
    """Interpolate the normals of the corners (Phong, Illumination for Computer Generated Pictures, 1975).

    Where they cancel, or all are 0 or that of the triangle, its own `normal` is used.
    """
    uneven = max_norm(mesh.normal_b - mesh.normal_a) + max_norm(mesh.normal_c - mesh.normal_a)
    if not any(uneven + max_norm(mesh.normal_a) * max_norm(mesh.normal_a - mesh.normal) > 0.0):
        return normal
    of_a, of_b, of_c = barycentric_coordinates(mesh, point)
    mean = of_a * mesh.normal_a + of_b * mesh.normal_b + of_c * mesh.normal_c
    return unit(where(dot(mean, mean) > OPPOSED, mean, normal))


def smooth_point(mesh: PackedMeshTriangle, point: Vec, normal: Vec) -> Vec:
    """Move a point of the triangle onto the smooth surface that the normals at its corners suggest.

    At each corner its normal defines a tangent plane. The point is projected onto each of those that it lies below, and
    the mean of the projections is weighted by the barycentric coordinates (Hanika, Hacking the Shadow Terminator, Ray
    Tracing Gems II, 2021, chapter 4). With the normals of a sphere it lies as far above the sphere as the triangle lies
    below. "Below" is as seen from the side of the unit vector `normal`.
    """
    of_a, of_b, of_c = barycentric_coordinates(mesh, point)
    side = copysign(1.0, dot(mesh.normal, normal))
    to_a = of_a * minimum(side * dot(point - mesh.a, mesh.normal_a), 0.0)
    to_b = of_b * minimum(side * dot(point - mesh.b, mesh.normal_b), 0.0)
    to_c = of_c * minimum(side * dot(point - mesh.c, mesh.normal_c), 0.0)
    return point - side * (to_a * mesh.normal_a + to_b * mesh.normal_b + to_c * mesh.normal_c)


def mapping(mesh: PackedMeshTriangle, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Texture coordinates of the file, or one picture a triangle as on `tr`; tangents perpendicular to `normal`.

    `normal` is the interpolated one, so that bumps rise from the smooth surface.
    """
    of_a, of_b, of_c = barycentric_coordinates(mesh, point)
    ab, ac = mesh.b - mesh.a, mesh.c - mesh.a
    u_b, v_b, u_c, v_c = mesh.u_b - mesh.u_a, mesh.v_b - mesh.v_a, mesh.u_c - mesh.u_a, mesh.v_c - mesh.v_a
    area = u_b * v_c - u_c * v_b  # twice the area of the triangle in the picture
    per_area = where(area == 0.0, 0.0, 1.0 / where(area == 0.0, 1.0, area))
    along_u, along_v = per_area * (v_c * ab - v_b * ac), per_area * (u_b * ac - u_c * ab)
    return (
        of_a * mesh.u_a + of_b * mesh.u_b + of_c * mesh.u_c,
        of_a * mesh.v_a + of_b * mesh.v_b + of_c * mesh.v_c,
        along_u - dot(along_u, normal) * normal,
        along_v - dot(along_v, normal) * normal,
    )


def boundary(mesh: Any, point: Vec) -> Boundary:
    """As for `tr`, of a triangle with rounded corners; its normal is on the side of the normals of the file."""
    flat = triangle.boundary(mesh, point)
    return Boundary((facing(mesh.normal, flat.faces[0]),), flat.limits)
