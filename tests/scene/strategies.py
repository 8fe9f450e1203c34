"""Hypothesis strategies for elements, lines and scenes."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from functools import cache
from typing import Any, TypeVar

from hypothesis import reject
from hypothesis import strategies as st

from minirt.element import Record, fields_of
from minirt.errors import ElementError
from minirt.fields import (
    FARTHEST,
    Choice,
    Colour,
    Direction,
    Field,
    Flag,
    Length,
    Lengths,
    MeshField,
    Paint,
    Picture,
    Point,
    Real,
    Whole,
)
from minirt.fields.scalars import SMALLEST
from minirt.materials import Compound
from minirt.scene import Camera, Scene, describe
from minirt.scene.registry import ELEMENTS
from tests.paths import ROOT

R = TypeVar("R", bound=Record)

FOLDER = tempfile.TemporaryDirectory(prefix="minirt-")  # file names in scenes have no blanks; the project's folder may
PICTURES = [shutil.copy(path, FOLDER.name) for path in sorted((ROOT / "assets").glob("*.png"))[:2]]
MESH = shutil.copy(ROOT / "scenes" / "meshes" / "icosahedron.obj", FOLDER.name)
BLANKS = st.text(" \t", min_size=1, max_size=3)
INDENTS = st.text(" \t", max_size=2)
COMMENTS = st.one_of(
    st.just(""),
    st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\n\r\0"), max_size=10).map("#".__add__),
)
ENDS = st.sampled_from(["", "\r"])


COORDINATE = st.floats(-FARTHEST, FARTHEST, allow_nan=False)
COLOUR = st.tuples(*[st.integers(0, 255)] * 3)
VALUES: dict[type[Field], Callable[[Any], st.SearchStrategy[object]]] = {
    Compound: lambda field: built(field.record),
    Picture: lambda _: st.sampled_from(PICTURES),
    MeshField: lambda _: st.just(MESH),
    Choice: lambda field: st.sampled_from(field.words),
    Flag: lambda _: st.booleans(),
    Real: lambda field: st.floats(field.low, field.high),
    Length: lambda _: st.floats(SMALLEST, FARTHEST),
    Lengths: lambda _: st.tuples(*[st.floats(SMALLEST, FARTHEST)] * 3),
    Whole: lambda field: st.integers(field.low, field.high),
    Point: lambda _: st.tuples(*[COORDINATE] * 3),
    Direction: lambda _: st.tuples(*[st.floats(-1, 1)] * 3).filter(any),
    Paint: lambda _: COLOUR | st.sampled_from(PICTURES),
    Colour: lambda _: COLOUR,
}


def values(field: Field) -> st.SearchStrategy[object]:
    """Return a strategy for the values of a field."""
    return next(make(field) for sort, make in VALUES.items() if isinstance(field, sort))


@cache
def field_values(kind: type[Record]) -> dict[str, st.SearchStrategy[object]]:
    """Return strategies for the fields of a kind, None for optional attributes; cached, for they are slow to make."""
    strategies = {field.name: values(field) for field in fields_of(kind)}
    optional = [field.name for field in fields_of(kind) if field.keyed and field.default is None]
    return {**strategies, **{name: st.none() | strategies[name] for name in optional}}


@st.composite
def built(draw: st.DrawFn, kind: type[R]) -> R:
    """Draw a record or an element of a kind; optional attributes may be absent."""
    try:
        return kind(**{name: draw(value) for name, value in field_values(kind).items()})
    except ElementError:
        reject()


ANY = [built(kind) for kind in ELEMENTS.values() if not kind.once]
ONCE = [built(kind) for kind in ELEMENTS.values() if kind.once and not kind.required]
REQUIRED = [built(kind) for kind in ELEMENTS.values() if kind.required]
MORE = st.lists(st.one_of(ANY), max_size=5)
COIN = st.booleans()
BEFORE = st.lists(st.tuples(INDENTS, COMMENTS), max_size=1)
BEGINS, ENDINGS = st.sampled_from(["", "\ufeff"]), st.sampled_from(["", "\n", "\n\n"])


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    """Draw a scene whose elements have no source lines."""
    items = [draw(each) for each in REQUIRED]
    items += [draw(each) for each in ONCE if draw(COIN)]
    return Scene(draw(st.permutations(items + draw(MORE))))


SCENES = scenes()


@st.composite
def texts(draw: st.DrawFn) -> str:
    """Draw the text of a scene file with blanks, comments, byte order marks and both line ends."""
    lines = []
    for element in draw(SCENES).elements:
        blank = draw(BEFORE)
        lines += [indent + comment + draw(ENDS) for indent, comment in blank]
        words = describe(element).split(" ")
        if isinstance(element, Camera) and draw(COIN):
            words = [*words[:4], f"roll:{element.roll!r}", f"exposure:{element.exposure!r}", f"tone:{element.tone}"]
        body = "".join(word + draw(BLANKS) for word in words[:-1]) + words[-1]
        lines.append(draw(INDENTS) + body + draw(INDENTS) + draw(COMMENTS) + draw(ENDS))
    return draw(BEGINS) + "\n".join(lines) + draw(ENDINGS)
