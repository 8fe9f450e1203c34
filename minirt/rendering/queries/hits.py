"""Closest hits of rays, and how exact they are."""

from __future__ import annotations

from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.shapes import Shape

if TYPE_CHECKING:
    from minirt.rendering.queries.certificate import Certificate


class Traced(NamedTuple):
    """Rays and shapes from which certificates are computed."""

    shapes: tuple[Shape, ...]
    first_primitive: NDArray[np.int64]  # of each shape
    primitives: NDArray[np.int64]  # that were hit, of the rays that hit something
    origins: NDArray[np.float64]
    directions: NDArray[np.float64]


class ClosestHits(NamedTuple):
    """The closest hits of n rays, as arrays."""

    distance: NDArray[np.float64]  # (n,) from the origin, in units of the scene; infinity where nothing is hit
    owner: NDArray[np.int64]  # (n,) the index in `scene.shapes` of the shape that is hit; -1 where nothing is
    point: NDArray[np.float64]  # (n, 3) on the surface; NaN where nothing is hit
    normal: NDArray[np.float64]  # (n, 3) of the surface, of unit length, outward where there is an outside; or NaN


class Hits(ClosestHits):
    """The closest hits of n rays, and their certificates, which are computed on first use.

    They are computed from the arrays that `trace` was given, which must not have changed.
    """

    traced: Traced | None = None

    @cached_property
    def certificate(self) -> Certificate:
        """Backward error, condition and normal error; ValueError for hits that are not those of a call of `trace`."""
        if self.traced is None:
            raise ValueError("only hits that minirt.trace returned have a certificate, not parts of them or copies")
        certificate = import_module("minirt.rendering.queries.certificate")
        shapes, first_primitive, primitives, *rays = self.traced
        parts = np.zeros_like(self.owner)
        is_hit = self.owner >= 0
        parts[is_hit] = primitives - first_primitive[self.owner[is_hit]]
        found: Certificate = certificate.certify(
            shapes, self.owner, parts, certificate.Rays(*rays, self.distance, self.normal)
        )
        return found

    @property
    def primitive(self) -> NDArray[np.int64]:
        """(n,) the index among the primitives of the scene, in the order of its shapes, of which a mesh has one for
        each triangle; 0 where nothing is hit. ValueError for hits that are not those of a call of `trace`."""
        if self.traced is None:
            raise ValueError("only hits that minirt.trace returned know their primitives, not parts of them or copies")
        primitive = np.zeros(len(self.owner), np.int64)
        primitive[self.owner >= 0] = self.traced.primitives
        return primitive

    def columns(self) -> dict[str, NDArray[np.float64] | NDArray[np.int64]]:
        """Return the hits as columns of a table: `pandas.DataFrame(hits.columns())`.

        They are distance, owner, point_x, point_y, point_z, normal_x, normal_y and normal_z, each (n,).
        """
        vectors = {"point": self.point, "normal": self.normal}
        parts = {f"{name}_{axis}": vector[:, i] for name, vector in vectors.items() for i, axis in enumerate("xyz")}
        return {"distance": self.distance, "owner": self.owner, **parts}

    def __repr__(self) -> str:
        return f"<Hits of {len(self.owner)} rays, {np.count_nonzero(self.owner >= 0)} of which hit a shape>"

    @property
    def backward_error(self) -> NDArray[np.float64]:
        """(n,) distance of the hit from the exact surface, in units of 2^-53 (t + |o - c| + size): the rounding errors
        of t, of the way from the origin of the ray to the shape, and of the shape's lengths. NaN where nothing is hit.
        """
        return self.certificate.backward_error

    @property
    def condition(self) -> NDArray[np.float64]:
        """(n,) relative change of t per relative change of the numbers of ray and shape; infinity where a ray only
        touches a surface, NaN where nothing is hit. t is exact within 2^-53 times this times the backward error."""
        return self.certificate.condition

    @property
    def normal_error(self) -> NDArray[np.float64]:
        """(n,) distance of the normal from the exact unit normal, in radians while it is small. NaN where nothing is
        hit."""
        return self.certificate.normal_error
