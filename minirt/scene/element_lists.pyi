"""The lists of a scene: its elements of each kind.

Written by python -m tests.make_tables.
"""

from minirt.scene.elements import Ambient
from minirt.scene.elements import Background
from minirt.scene.elements import FurtherCamera
from minirt.scene.elements import FurtherLight
from minirt.scene.elements import ParallelLight
from minirt.scene.elements import Resolution
from minirt.scene.elements import SpotLight
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

class ElementLists:
    resolutions: tuple[Resolution, ...]
    ambients: tuple[Ambient, ...]
    backgrounds: tuple[Background, ...]
    further_cameras: tuple[FurtherCamera, ...]
    further_lights: tuple[FurtherLight, ...]
    parallel_lights: tuple[ParallelLight, ...]
    spot_lights: tuple[SpotLight, ...]
    spheres: tuple[Sphere, ...]
    planes: tuple[Plane, ...]
    cylinders: tuple[Cylinder, ...]
    cones: tuple[Cone, ...]
    paraboloids: tuple[Paraboloid, ...]
    hyperboloids: tuple[Hyperboloid, ...]
    triangles: tuple[Triangle, ...]
    squares: tuple[Square, ...]
    discs: tuple[Disc, ...]
    boxes: tuple[Box, ...]
    tori: tuple[Torus, ...]
    ellipsoids: tuple[Ellipsoid, ...]
    meshes: tuple[Mesh, ...]
