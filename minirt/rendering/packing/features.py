"""Features of a scene: the shapes, materials and lights that its kernel is compiled for."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from itertools import chain
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from minirt.element import Element, fields_of
from minirt.kernel.scene_arrays import SceneArrays
from minirt.kernel.shading.texturing import SurfaceMaps
from minirt.materials import Attributes
from minirt.scene import Background, Lamp, Scene
from minirt.scene.pages import Crowd
from minirt.shapes import Shape
from minirt.shapes.mesh import Mesh


class Feature(NamedTuple):
    """Optional code of the kernel, and its array, which is None in a kernel that is compiled without it."""

    words: str = ""  # in notes and reports; empty for a part of another feature
    absent: float | tuple[float, ...] | None = None  # of the array of rows: the row of a shape or a light without it
    of_shapes: bool = True  # whether it has a row for each shape
    single: bool = False  # whether kernels in single precision have it, too
    dtype: type = np.float64
    secondary: bool = False  # whether only reflected and refracted rays have it

    def rows(self, count: int, number: Any = None) -> np.ndarray:
        """Return rows for shapes or lights without the feature; `number` is the type of those that are no integers."""
        absent: Any = self.absent
        dtype = number if number and self.dtype is np.float64 else self.dtype
        return np.full((count, *np.shape(absent)), absent, dtype)


# By the field of `minirt.kernel.scene_arrays.SceneArrays` or of `minirt.kernel.shading.texturing.SurfaceMaps`.
FEATURES = {
    "specular": Feature("highlights", (0.0, 0.0, 0.0), single=True),
    "reflective": Feature("mirrors and glass", (0.0, 0.0, 1.0), secondary=True),
    "media": Feature("tinted glass", (0.0, 0.0, 0.0, 1.0, 1.0, 1.0), secondary=True),
    "fresnel": Feature("Fresnel's equations", 0.0, secondary=True),
    "glow": Feature("glow", 0.0, single=True),
    "checks": Feature("checkerboards", (0.0,) * 4, single=True),
    "textures": Feature("textures", 0, dtype=np.int64),
    "bumps": Feature("bumps", (0.0, 0.0)),
    "normals": Feature("maps of normals", 0, dtype=np.int64),
    "placements": Feature("scaled and turned maps", (0.0,) * 15, single=True),
    "patterns": Feature("marble, wood and clouds", of_shapes=False, single=True),
    "raised_patterns": Feature("raised patterns", of_shapes=False),
    "soft": Feature("lights with a size", (0.0,) * 4, of_shapes=False, single=True),
    "lens": Feature("a lens", 0.0, of_shapes=False, single=True),
    "spots": Feature("spots, parallel and fading light", (0.0,) * 7, of_shapes=False, single=True),
    "background": Feature("a coloured background", of_shapes=False, single=True),
    "environment": Feature("a picture as background", of_shapes=False),
    "transparent": Feature("", (0.0, 0.0, 1.0, 0.0, 0.0), secondary=True),
    "fades": Feature("", (0.0, 0.0), secondary=True),
}
WORDS = {name: feature.words for name, feature in FEATURES.items() if feature.words}
SECONDARY = frozenset(name for name, feature in FEATURES.items() if feature.secondary)
MAPS = tuple(name for name in SurfaceMaps._fields if name in FEATURES)
COORDINATE_MAPS = frozenset(MAPS) - {"placements"}  # features that look up u and v
APERTURES = frozenset({"soft", "lens"})  # features that one sample a pixel does not show
SPREAD = frozenset({"parallel", "soft"})  # features of light sources that are not points: shadow rays share no end
DEPTH = 8  # reflections and refractions of a ray, at most
MATERIALS = tuple((field.name, field) for field in fields_of(Attributes))
NEEDS = {name: field.facts.needs for name, field in MATERIALS}
ATTRIBUTES = attrgetter(*(name for name, _ in MATERIALS))
NO_MATERIALS = (None,) * len(MATERIALS)  # the `ATTRIBUTES` of a shape that has none


def features(scene: Scene, samples: object = None) -> frozenset[Hashable]:
    """The kinds of shapes in a scene, and the keys of `FEATURES` that its picture with so many samples a pixel uses: 1,
    which needs no `APERTURES`, or others.

    Of these "parallel", "transparent", "fades" and "smooth" are parts: parallel light, glass, fading reflections, and
    smooth meshes.
    """
    among = {page.cached(features_among) for page in scene.pages}
    found = frozenset({"lens"} if scene.camera.lens else ()).union(*among)
    return found - APERTURES if samples == 1 else found


def examples(scene: Scene) -> dict[tuple[Any, ...], Shape]:
    """A shape of a scene for each kind, with each set of features, by these."""
    found: dict[tuple[Any, ...], Shape] = {}
    for page in scene.pages:
        found.update(page.cached(examples_among))
    return found


def examined(items: Sequence[Element | str]) -> Sequence[Element | str]:
    """Return the items that have the features of all: of a crowd, whose shapes have no materials, the first one."""
    return items.some([0]) if isinstance(items, Crowd) else items


def examples_among(items: Sequence[Element | str]) -> dict[tuple[Any, ...], Shape]:
    """A shape of some items for each kind, with each set of features, by these."""
    shapes = [item for item in examined(items) if isinstance(item, Shape)]
    looks = chain.from_iterable(item.looks if isinstance(item, Mesh) else (item,) for item in shapes)
    return {(type(item), *shape_features(item)): item for item in looks}


def features_among(items: Sequence[Element | str]) -> frozenset[Hashable]:
    """The kinds of shapes among some items, and the features of these and of the other elements."""
    beside_shapes = (features_of(item) for item in examined(items) if not isinstance(item, Shape))
    return frozenset().union(*examples_among(items), *beside_shapes)


def features_of(item: Element | str) -> Iterable[Hashable]:
    """The features that an item which is no shape needs; none for one without effect, such as a light that is off."""
    if isinstance(item, Lamp) and item.brightness and any(item.colour):
        return item.features()
    if isinstance(item, Background):
        if isinstance(item.paint, str):
            return ("environment",)
        return ("background",) if any(item.paint) else ()
    return ()


def shape_features(shape: Shape) -> Iterable[str]:
    """The features that a shape needs, beside its kind."""
    smooth = ["smooth"] if shape.smooth else []
    return [*smooth, *material_features(shape)]


def material_features(shape: Shape) -> Iterable[str]:
    """The features that the materials of a shape need. An attribute that NEEDS others, such as a colour of glass,
    counts only where the shape has one of these."""
    if ATTRIBUTES(shape) == NO_MATERIALS:
        return ()
    values = zip(MATERIALS, ATTRIBUTES(shape), strict=True)
    of_materials = {name: field.features_of(value) for (name, field), value in values if value is not None}
    found = {
        feature
        for name, features_of_it in of_materials.items()
        if not NEEDS[name] or any(map(of_materials.get, NEEDS[name]))
        for feature in features_of_it
    }
    if shape.map_frame() and not COORDINATE_MAPS.isdisjoint(found):
        found.add("placements")
    return found


def fits_single(arrays: SceneArrays) -> bool:
    """Whether float32 will do: a BVH consists of float64, and float32 cannot count the pixels of a large picture."""
    return (
        arrays.bvh is None
        and arrays.environment is None
        and (arrays.surface_maps is None or not len(arrays.surface_maps.pictures))
    )
