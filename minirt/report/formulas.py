"""Measure the formulas of shape types, for the report of a scene and for that of all shapes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from minirt.report.measurements import formula_errors
from minirt.report.measurements.exact_hits import SOLIDS
from minirt.report.measurements.eye_rays import rays_from_the_eye
from minirt.report.measurements.plan import RAYS, Plan
from minirt.report.measurements.regimes import regimes_of
from minirt.scene import Scene
from minirt.shapes import ALL_KINDS, Kind

SEED = 20240607
FROM_EYE = "this scene"


def kinds_of(scene: Scene) -> list[Kind]:
    """Return the kinds of shapes that a scene has."""
    elements = set(map(type, scene.shapes))
    return [kind for kind in ALL_KINDS if kind.element in elements]


def formula_rows(
    kinds: Iterable[Kind], plan: Plan, step: Callable[[str], object], scene: Scene | None = None
) -> Iterator[formula_errors.Row]:
    """Measure the formulas of some shape types in all their regimes and, if a scene is given, from its eye."""
    for number, kind in enumerate(kinds):
        if kind.element not in SOLIDS:
            continue
        random = np.random.default_rng([SEED, number])
        poses = [(each.name, each.pose(kind, random, plan.shapes, RAYS)) for each in regimes_of(kind)]
        if scene:
            poses.append((FROM_EYE, rays_from_the_eye(kind, scene, random, plan.shapes, RAYS)))
        for name, rays in poses:
            step(f"{kind.element.title}, {name}")
            yield from formula_errors.measure_formulas(kind, name, rays)


def formula_names(kinds: Iterable[Kind], scene: Scene | None = None) -> Iterator[str]:
    """Yield the names of the steps of `formula_rows`."""
    for kind in kinds:
        if kind.element in SOLIDS:
            regimes = [each.name for each in regimes_of(kind)] + [FROM_EYE] * bool(scene)
            yield from (f"{kind.element.title}, {name}" for name in regimes)


def kinds_not_measured(kinds: Iterable[Kind]) -> list[str]:
    """Remarks on the shape types that have no exact reference to measure against."""
    return [f"formula of the {kind.element.title}: none in 60 digits" for kind in kinds if kind.element not in SOLIDS]
