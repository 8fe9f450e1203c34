"""Solids a billion times longer, wider, shorter or thinner than usual, along one of their lengths."""

from __future__ import annotations

from contextlib import suppress
from functools import partial

import numpy as np

from minirt.element import fields_of
from minirt.errors import ElementError
from minirt.fields import Length, Lengths
from minirt.shapes import Kind, Shape
from tests.shapes.examples import example
from tests.shapes.regimes import RAYS, Array, Random, Rays, random_directions
from tests.stability.regime import Regime

COUNT = 4  # shapes of a regime


def stretched(shape: Shape, name: str, factor: float) -> Shape:
    """A shape with one length multiplied by a factor; of three lengths the second."""
    value = getattr(shape, name)
    new = (value[0], factor * value[1], value[2]) if isinstance(value, tuple) else factor * value
    return shape.replace(**{name: new})


def seen(kind: Kind, seed: int, name: str, factor: float) -> Rays:
    """Rays from inside, and from 3 to 20 away at points inside; both mostly far from the middle."""
    random = np.random.default_rng(seed)
    shapes: list[Shape] = []
    while len(shapes) < COUNT:
        with suppress(ElementError):
            shapes.append(stretched(example(kind, random), name, factor))
    places = np.stack([within(shape, random) for shape in shapes])
    directions = random_directions(random, COUNT, RAYS)
    away = np.where(np.arange(RAYS)[:, None] % 2, random.uniform(3, 20, (COUNT, RAYS, 1)), 0.0)
    return Rays(shapes, places - away * directions, directions)


def within(shape: Shape, random: Random) -> Array:
    """Random points in the hull of a shape's balls, (RAYS, 3)."""
    centres = np.array([centre for centre, _ in shape.balls()])
    radii = np.array([radius for _, radius in shape.balls()])
    shares = random.dirichlet(np.ones(len(centres)), RAYS)
    return shares @ centres + 0.7 * (shares @ radii)[:, None] * random.random((RAYS, 1)) * random_directions(
        random, RAYS
    )


def regimes(kind: Kind) -> list[Regime]:
    """The regimes of a kind of solid; an answer must lie between those for a thicker and a thinner shape."""
    found = []
    for field in fields_of(kind.element):
        if field.keyed or not isinstance(field, (Length, Lengths)):
            continue
        for factor in (1e-9, 1e9):
            with suppress(ElementError):
                stretched(example(kind, np.random.default_rng(1)), field.name, factor)
                make = partial(seen, kind, 21, field.name, factor)
                found.append(Regime(f"{field.title} times {factor:g}", make, blur=np.inf))
    return found
