"""One property of every kind of shape: its answers to hard rays are exact, and no ray hits again the surface it leaves.

Rays through special places, from any distance, exactly and by units in the last place beside (`rays.py`), at shapes of
all sizes, stretched, turned and up to 1e12 sizes from the origin of the scene; then rays sent on from what they hit, as
near-tangents and anyhow. `verdicts.py` says which answers are right. Each run draws others: MINIRT_SEED replays one.
"""

from __future__ import annotations

import numpy as np
import pytest

import minirt
from minirt.scene import Camera, Scene
from minirt.shapes import KINDS, Cone, Kind, Shape, quadrics
from tests.seeds import RUN
from tests.shapes.execution_modes import Intersect, compiled, on_arrays, surfaces
from tests.shapes.regimes import GREY, Array, log_uniform, random_directions, random_perpendiculars, unit
from tests.stability import mutants
from tests.stability.rays import ANY, Pose, pose, rays, sent_on
from tests.stability.verdicts import BOUND, off, wrong

KIND = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
SHAPES, RAYS = 16, 64
EYE = Camera((0, 0, 0), (0, 0, 1), 60)


def traced(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """Distances by `minirt.trace`, each shape in a scene of its own."""
    rays = zip(shapes, origins, directions, strict=True)
    return np.stack([minirt.trace(Scene((EYE, shape)), *each).distance for shape, *each in rays])


MODES: dict[str, Intersect] = {"arrays": on_arrays, "compiled": compiled, "traced": traced}


def complaints(kind: Kind, *ways: Intersect, seed: int = RUN, shapes: int = SHAPES, drawn: Pose = ANY) -> list[str]:
    """Complaints about the answers of ways to intersect: of each shape the first few."""
    random, found = np.random.default_rng(seed), []
    for _ in range(shapes):
        with np.errstate(all="ignore"):
            shape = pose(kind, random, drawn)
            origins, directions = rays(shape, random, RAYS)
            points, normals = struck(shape, origins, directions)
            onward = sent_on(shape, points, normals, random)
        for each in ((origins, directions), (points, onward)):
            is_finite = np.isfinite(np.concatenate(each, axis=1)).all(axis=1)  # a far point may have no normal
            if not is_finite.any():
                continue
            o, d = (np.resize(part[is_finite], (RAYS, 3)) for part in each)
            answers = [intersect([shape], o[None], d[None])[0] for intersect in ways]
            for t in {each.tobytes(): each for each in answers}.values():  # most ways give the same bits
                found += [str(each) for each in wrong(shape, o, d, t)]
                far = np.flatnonzero(off(shape, o, d, np.where(np.isfinite(t), t, np.nan)) > BOUND)
                found += [f"off: {shape} from {o[i].tolist()} along {d[i].tolist()}" for i in far[:2]]
    return found


def struck(shape: Shape, origins: Array, directions: Array) -> tuple[Array, Array]:
    """Points of a shape that rays hit, as `minirt.trace` gives them, and the normals there."""
    t = on_arrays([shape], origins[None], directions[None])[0]
    hit = np.isfinite(t)
    if not hit.any():
        return origins, directions
    points, normals = surfaces([shape], (origins[hit] + t[hit, None] * directions[hit])[None])
    return points[0], normals[0]


@KIND
def test_answers_are_exact_and_no_surface_is_hit_again(kind: Kind) -> None:
    assert not complaints(kind, *MODES.values()), RUN


@pytest.mark.parametrize(
    ("name", "kind"), mutants.PAIRS, ids=lambda each: each if isinstance(each, str) else each.element.title
)
def test_a_wrong_formula_is_found(name: str, kind: Kind) -> None:
    with np.errstate(all="ignore"):  # its answers may be anything
        assert any(complaints(kind, mutants.EVERY[name][0], seed=RUN + i, shapes=4) for i in range(12)), RUN


def off_beside_apexes(seed: int) -> float:
    """The greatest backward error of hits beside the apexes of cones, of rays nearly along generators."""
    random, found = np.random.default_rng(seed), []
    for _ in range(64):
        axis, height, slope = random_directions(random), log_uniform(random, 1e-6, 1e6), log_uniform(random, 0.1, 10)
        cone = Cone((0, 0, 0), tuple(axis.tolist()), float(2 * slope * height), float(height), GREY)
        aside = random_perpendiculars(random, np.tile(axis, (RAYS, 1)))
        lean = log_uniform(random, 2.0**-9, 0.5, RAYS, 1) * random.choice([-1.0, 1.0], (RAYS, 1))
        directions = unit(axis - slope * np.sqrt(1 + lean) * aside)
        through = slope * height * log_uniform(random, 1e-6, 1, RAYS, 1) * aside
        origins = through - height * random.choice([0, 0.1, 1, 30], (RAYS, 1)) * directions
        t = on_arrays([cone], origins[None], directions[None])[0]
        errors = off(cone, origins, directions, np.where(np.isfinite(t), t, np.nan))
        found.append(np.nanmax(errors, initial=0.0))
    return max(found)


def test_hits_beside_an_apex_are_exact_for_rays_nearly_along_the_side(monkeypatch: pytest.MonkeyPatch) -> None:
    assert off_beside_apexes(RUN) <= BOUND, RUN
    monkeypatch.setattr(quadrics, "PARALLEL", 2.0**-8)
    assert off_beside_apexes(RUN) > BOUND, RUN
