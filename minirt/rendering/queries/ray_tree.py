"""Rays of a pixel as records: a tree, with what each ray meets and what each light gives there."""

from __future__ import annotations

from dataclasses import dataclass, field

from minirt.fields import Triple

PRIMARY, REFLECTED, REFRACTED = "primary", "reflected", "refracted"
COLOURS = {PRIMARY: (255, 255, 255), REFLECTED: (80, 200, 255), REFRACTED: (255, 110, 220)}  # wherever rays are drawn


@dataclass(frozen=True)
class Meeting:
    """A shape that a ray meets, and where it does so first."""

    shape: int  # index in `scene.shapes`
    name: str
    distance: float
    point: Triple


@dataclass(frozen=True)
class LightPart:
    """What a light gives to a surface."""

    light: int  # index in `scene.lights`
    origin: Triple  # of the shadow ray, clear of the surface
    direction: Triple  # from there to the light
    distance: float  # to the light; infinite for parallel light
    cosine: float  # of the angle between the direction and the shading normal
    strength: float  # share that the cone of a spot, fading with the distance and bumps leave
    passes: Triple  # shares that shapes in between let through: 0 in shadow, the tint of glass; 0 from behind
    meets: tuple[Meeting, ...]  # these shapes, the first one first
    diffuse: Triple  # light that falls onto the surface
    highlight: Triple  # light that is reflected as a specular highlight


@dataclass(frozen=True)
class SurfacePoint:
    """The point of a surface that a ray hits."""

    shape: int  # index in `scene.shapes`
    name: str
    distance: float  # from the origin of the ray
    point: Triple
    leaves: bool  # whether the ray comes from inside the shape
    normal: Triple  # towards the side from which the ray comes
    shading_normal: Triple  # smooth, bump mapped or normal mapped
    uv: tuple[float, ...]
    colour: Triple  # with texture and patterns
    specular: Triple  # share, exponent, and 1 for Blinn's form
    mirror: float  # share of a ray of this angle that is reflected
    glass: float  # share that is refracted
    ior: float
    glow: float
    ambient: Triple  # light that falls onto the surface from everywhere
    lights: tuple[LightPart, ...]
    light: Triple  # (ambient + diffuse) * colour * (1 - mirror - glass) + highlights + glow * colour


@dataclass
class RayNode:
    """A ray, and those that the surface which it hits sends on."""

    kind: str  # primary, reflected or refracted
    origin: Triple
    direction: Triple
    meets: tuple[Meeting, ...]  # all shapes along it, the first one first
    weight: float = 1.0  # share of its light in the pixel
    tint: Triple = (1.0, 1.0, 1.0)  # shares of red, green and blue that tinted glass on its way leaves
    surface: SurfacePoint | None = None  # None where it meets nothing
    light: Triple = (0.0, 0.0, 0.0)  # what it adds to the pixel: weight * tint * light of the surface or background
    rays: list[RayNode] = field(default_factory=list)
