"""Elements of a scene by kind, as type checkers and editors see them: `scene.spheres`.

`python -m tests.make_plurals` writes this file from the registry of elements.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from minirt.scene.elements import Ambient, Background, Camera, Resolution
    from minirt.scene.lights import FurtherLight, ParallelLight, SpotLight
    from minirt.shapes.box import Box
    from minirt.shapes.cone import Cone
    from minirt.shapes.cylinder import Cylinder
    from minirt.shapes.disc import Disc
    from minirt.shapes.ellipsoid import Ellipsoid
    from minirt.shapes.hyperboloid import Hyperboloid
    from minirt.shapes.mesh import Mesh
    from minirt.shapes.paraboloid import Paraboloid
    from minirt.shapes.plane import Plane
    from minirt.shapes.sphere import Sphere
    from minirt.shapes.square import Square
    from minirt.shapes.torus import Torus
    from minirt.shapes.triangle import Triangle


class Plurals:
    """Base class of scenes: the elements of each kind, in the order of the file."""

    if TYPE_CHECKING:

        @property
        def resolutions(self) -> tuple[Resolution, ...]: ...

        @property
        def ambients(self) -> tuple[Ambient, ...]: ...

        @property
        def backgrounds(self) -> tuple[Background, ...]: ...

        @property
        def cameras(self) -> tuple[Camera, ...]: ...

        @property
        def further_lights(self) -> tuple[FurtherLight, ...]: ...

        @property
        def parallel_lights(self) -> tuple[ParallelLight, ...]: ...

        @property
        def spot_lights(self) -> tuple[SpotLight, ...]: ...

        @property
        def spheres(self) -> tuple[Sphere, ...]: ...

        @property
        def planes(self) -> tuple[Plane, ...]: ...

        @property
        def cylinders(self) -> tuple[Cylinder, ...]: ...

        @property
        def cones(self) -> tuple[Cone, ...]: ...

        @property
        def paraboloids(self) -> tuple[Paraboloid, ...]: ...

        @property
        def hyperboloids(self) -> tuple[Hyperboloid, ...]: ...

        @property
        def triangles(self) -> tuple[Triangle, ...]: ...

        @property
        def squares(self) -> tuple[Square, ...]: ...

        @property
        def discs(self) -> tuple[Disc, ...]: ...

        @property
        def boxes(self) -> tuple[Box, ...]: ...

        @property
        def tori(self) -> tuple[Torus, ...]: ...

        @property
        def ellipsoids(self) -> tuple[Ellipsoid, ...]: ...

        @property
        def meshes(self) -> tuple[Mesh, ...]: ...
