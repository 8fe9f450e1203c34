"""Explains a pixel by the kernel's own formulas, which run, interpreted, on its one ray.

No formula is stated a second time: copies of the kernel's functions report the calls of other ones. Light is additive,
so a light's part is what `direct_light` computes for a scene that has this light alone.
"""

from __future__ import annotations

from functools import partial
from math import inf
from typing import Any

import numpy as np

from minirt.errors import RenderError, check_whole
from minirt.fields import Triple
from minirt.kernel import frame
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.kernel.scene_arrays import SceneArrays
from minirt.kernel.shading import shade, whitted
from minirt.kernel.shading.patterns import remember_spacing
from minirt.kernel.shading.surfaces import Ray, Surface
from minirt.kernel.trace import DISTANCE, OWNER, ClosestHit
from minirt.lanes import Mask, Number, Vec, dot, lane
from minirt.lanes import width as lanes_of
from minirt.rendering.buffers import coordinates
from minirt.rendering.frame import frame_rays, thread_memory
from minirt.rendering.notes import shape_name
from minirt.rendering.packing.lights import emitting_lights
from minirt.rendering.packing.ray_casting import hit_distances
from minirt.rendering.queries.explanation import Explanation
from minirt.rendering.queries.ray_tree import PRIMARY, REFLECTED, REFRACTED, LightPart, Meeting, RayNode, SurfacePoint
from minirt.rendering.queries.watched import watched
from minirt.rendering.renderer import PATIENCE, Renderer, renderer
from minirt.rendering.scene_packing import Packing
from minirt.rendering.tone_mapping import map_tones
from minirt.scene import Scene, check_scene


def explain(scene: Scene, width: int, height: int, x: int, y: int, *, depth: int | None = None) -> Explanation:
    """Return the tree of rays of the pixel in column x and row y of a picture: why it has its colour.

    The ray is that of a picture with one sample a pixel: through the pixel's centre, from the centre of a lens, to the
    centres of lights. `depth` is that of `minirt.render`. RenderError for a pixel that does not lie in the picture.

        print(minirt.explain(scene, 640, 480, 320, 240))
    """
    check_scene(scene, "explain")
    width, height = check_whole("width", width, 1), check_whole("height", height, 1)
    x, y = check_whole("x", x, 0), check_whole("y", y, 0)
    return explained_by(renderer(depth=depth), scene, width, height, x, y)


def explained_by(chosen: Renderer, scene: Scene, width: int, height: int, x: int, y: int) -> Explanation:
    """Return the tree of rays of a pixel. RenderError for one that does not lie in the picture.

    The scene is packed by the chosen renderer; while that is busy, or in single precision, it is packed anew.
    """
    if not (0 <= x < width and 0 <= y < height):
        raise RenderError(f"pixel {x},{y} does not lie in the picture of {width}x{height} pixels")
    is_free = chosen.precision == "double" and chosen.busy.acquire(timeout=PATIENCE)
    packing = chosen.packing if is_free else Packing(depth=chosen.depth)
    try:
        with np.errstate(all="ignore"):
            ray, light = Watch(packing, scene, width, height).trace(x, y)
    finally:
        if is_free:
            chosen.busy.release()
    pixel = np.empty((1, 1, 4), np.uint8)
    map_tones(np.array([[light]]), pixel, scene.camera.tone)
    blue, green, red, _ = pixel[0, 0].tolist()
    return Explanation(x, y, width, height, ray, light, scene.camera.tone, (red, green, blue))


# The functions whose calls are reported.
OF_RAYS = "primary_ray attenuated direct_light shade coloured push_rays load_rays weighted_background background_light"
OF_LIGHTS = "aim bump_fading trace_shadow_rays shares_of_light"


class Watch:
    """Traces the ray of a pixel, the same in all lanes of a packet, and takes down what the formulas compute.

    A method whose name begins with `on_` is the report of a function of the kernel, see `watched`.
    """

    root: RayNode
    ray: RayNode  # that is being traced

    def __init__(self, packing: Packing, scene: Scene, width: int, height: int) -> None:
        self.scene, self.across = scene, width
        self.arrays, self.shapes = packing.pack(scene, width, height, samples=1), packing.shape_arrays
        self.memory = thread_memory(self.arrays)[0]
        self.waiting: dict[int, RayNode] = {}  # rays by their numbers on the kernel's stack
        self.lights: tuple[LightPart, ...] = ()  # of the surface that is being shaded
        self.is_background = False  # whether what is coloured next is the light of the background
        self.last: dict[str, Any] = {}  # the last results of functions for the light of a lamp
        emitting = [*map(id, emitting_lights(scene))]
        self.lamps = [number for number, lamp in enumerate(scene.lights) if id(lamp) in emitting]
        self.tracing = watched(whitted, {name: getattr(self, f"on_{name}") for name in OF_RAYS.split()})
        self.lighting = watched(shade, {name: partial(self.on_light, name) for name in OF_LIGHTS.split()})

    def trace(self, x: int, y: int) -> tuple[RayNode, Triple]:
        """Return the tree of rays of a pixel, and its light."""
        lanes = lanes_of(self.arrays.camera)
        packet_width = lanes // PACKET_HEIGHT
        column, row = x % packet_width, y % PACKET_HEIGHT
        rays = frame_rays(self.arrays, 1)[0].reshape(-1, lanes)[:, row * packet_width + column].repeat(lanes)
        remember_spacing(self.arrays, self.memory, 1, 0)
        tile = frame.tile_at(self.arrays, x, y, self.across)
        tracing = watched(frame, {}, incoming_radiance=self.tracing.incoming_radiance)
        light = tracing.packet_radiance(self.arrays, self.memory, tile, rays, x - column, y - row)
        return self.root, triple(frame.without_non_finite(light, self.memory))

    def node(self, kind: str, ray: Ray) -> RayNode:
        origin, direction = triple(ray.origin), triple(ray.direction)
        return RayNode(kind, origin, direction, self.meets(origin, direction))

    def on_primary_ray(self, ray: Ray, *_: Any) -> None:
        self.root = self.ray = self.node(PRIMARY, ray)

    def on_push_rays(self, count: int, scene: SceneArrays, stack: Any, waiting: int, ray: Ray, level: int) -> None:
        assert self.ray.surface
        is_outside = np.dot(np.subtract(triple(ray.origin), self.ray.surface.point), self.ray.surface.normal) > 0.0
        self.waiting[waiting] = self.node(REFLECTED if is_outside else REFRACTED, ray)
        self.ray.rays.append(self.waiting[waiting])

    def on_load_rays(self, _: Any, scene: SceneArrays, stack: Any, number: int, zero: Number) -> None:
        self.ray = self.waiting[number]

    def on_attenuated(self, result: tuple[Number, Vec], *_: Any) -> None:
        weight, tint = result
        self.ray.weight = lane(weight, 0)
        if self.arrays.media is not None:  # else rays have no colour
            self.ray.tint = triple(tint)

    def on_weighted_background(self, *_: Any) -> None:
        self.is_background = True

    def on_coloured(self, light: Vec, *_: Any) -> None:
        red, green, blue = triple(light)
        if not self.is_background:
            self.ray.light = self.ray.weight * red, self.ray.weight * green, self.ray.weight * blue
        elif not self.ray.surface:
            self.ray.light = red, green, blue
        self.is_background = False

    def on_background_light(self, light: Vec, *_: Any) -> None:
        self.ray.light = triple(light)  # of the only ray of a scene without mirrors and glass

    def on_shade(
        self, result: tuple[Vec, Surface], scene: SceneArrays, memory: Any, ray: Ray, found: ClosestHit, hit: Mask
    ) -> None:
        """Note the surface where a ray was shaded, and the light that it sends back along the ray."""
        light, surface = result
        primitive, point, normal = int(lane(found[OWNER], 0)), triple(surface.point), triple(surface.normal)
        shape, side = int(self.shapes.owner[primitive]), lane(surface.side, 0)
        uv = coordinates(self.shapes, np.array([primitive]), np.array([point]), side * np.array([normal]))
        mirror, glass, ior = triple(surface.reflective)
        self.ray.surface = SurfacePoint(
            shape=shape,
            name=shape_name(self.scene, shape),
            distance=lane(found[DISTANCE], 0),
            point=point,
            leaves=side < 0.0,
            normal=normal,
            shading_normal=triple(surface.shading_normal),
            uv=tuple(uv[0].tolist()),
            colour=triple(surface.colour),
            specular=triple(surface.specular),
            mirror=mirror,
            glass=glass,
            ior=ior,
            glow=lane(surface.glow, 0),
            ambient=tuple(scene.ambient.tolist()),
            lights=self.lights,
            light=triple(light),
        )

    def on_direct_light(
        self, _: Any, scene: SceneArrays, memory: Any, ray: Ray, found: ClosestHit, surface: Surface, hit: Mask
    ) -> None:
        """Compute the light of each lamp by the same function, in a scene that has no other light."""
        self.lights = tuple(self.light_part(row, lamp, ray, found, surface, hit) for row, lamp in enumerate(self.lamps))

    def light_part(self, row: int, lamp: int, ray: Ray, found: ClosestHit, surface: Surface, hit: Mask) -> LightPart:
        """Return what a lamp gives to a surface: the one with the index `lamp` in the scene, in the row `row` of the
        kernel's lights."""
        self.last = {}
        memory = self.memory[[row, -1]]  # of this light, and of all
        light = self.lighting.direct_light(self.lit_by(row), memory, ray, found, surface, hit)
        rays, strength = self.last["aim"]
        origin, direction, distance = triple(rays.origin), triple(rays.direction), lane(rays.distance, 0)
        traced = self.last.get("shares_of_light", self.last.get("trace_shadow_rays"))
        passes = (0.0, 0.0, 0.0)  # no ray was traced: no light comes from the lamp
        if isinstance(traced, Vec):  # through coloured glass
            passes = triple(traced)
        elif traced is not None:
            passes = (lane(traced, 0),) * 3
        diffuse, highlight = map(triple, light)
        return LightPart(
            light=lamp,
            origin=origin,
            direction=direction,
            distance=distance,
            cosine=lane(dot(surface.shading_normal, rays.direction), 0),
            strength=lane(strength * self.last.get("bump_fading", 1.0), 0),
            passes=passes,
            meets=() if traced is None else self.meets(origin, direction, distance),
            diffuse=diffuse,
            highlight=highlight,
        )

    def on_light(self, name: str, result: Any, *_: Any) -> None:
        self.last[name] = result

    def lit_by(self, row: int) -> SceneArrays:
        """Return the arrays of the scene with one of its lights alone."""
        arrays, one = self.arrays, slice(row, row + 1)
        kept = {name: getattr(arrays, name) for name in ("lights", "light_cones", "spots", "soft")}
        some: Any = {name: None if rows is None else rows[one] for name, rows in kept.items()}
        groups = tuple(group._replace(light_starts=group.light_starts[one]) for group in arrays.groups)
        return arrays._replace(ambient=np.zeros(3), light_grid=None, groups=groups, **some)

    def meets(self, origin: Triple, direction: Triple, end: float = inf) -> tuple[Meeting, ...]:
        """Return the shapes that a ray meets before its end, the first one first."""
        start, way = Vec(*np.array(origin)), Vec(*np.array(direction))
        distances = hit_distances(self.shapes, start, way)
        found: dict[int, Meeting] = {}
        for primitive in np.argsort(distances).tolist():
            distance, shape = float(distances[primitive]), int(self.shapes.owner[primitive])
            if distance >= end:
                break
            name = shape_name(self.scene, shape)
            found.setdefault(shape, Meeting(shape, name, distance, triple(start + distance * way)))
        return tuple(found.values())


def triple(v: Vec) -> Triple:
    """Return the vector of the first lane."""
    x, y, z = (float(np.ravel(part)[0]) for part in (v.x, v.y, v.z))
    return x, y, z
