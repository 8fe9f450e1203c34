"""Random elements, lines and scenes."""

from __future__ import annotations

from hypothesis import reject
from hypothesis import strategies as st

from minirt.element import Element, fields_of
from minirt.errors import ElementError
from minirt.fields import FARTHEST, Colour, Direction, Field, Length, Lengths, Point, Real, Whole
from minirt.scene import Camera, Scene, describe
from minirt.scene.registry import ELEMENTS

BLANKS = st.text(" \t", min_size=1, max_size=3)
INDENTS = st.text(" \t", max_size=2)
COMMENTS = st.one_of(
    st.just(""),
    st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\n\r\0"), max_size=10).map("#".__add__),
)
ENDS = st.sampled_from(["", "\r"])


def values(field: Field) -> st.SearchStrategy[object]:
    """Random values of a field."""
    coordinate = st.floats(-FARTHEST, FARTHEST, allow_nan=False)
    if isinstance(field, Real):
        return st.floats(field.low, field.high)
    if isinstance(field, (Length, Lengths)):
        size = st.floats(0, FARTHEST, exclude_min=True)
        return size if isinstance(field, Length) else st.tuples(size, size, size)
    if isinstance(field, Whole):
        return st.integers(field.low, field.high)
    if isinstance(field, Point):
        return st.tuples(coordinate, coordinate, coordinate)
    if isinstance(field, Direction):
        component = st.floats(-1, 1)
        return st.tuples(component, component, component).filter(any)
    assert isinstance(field, Colour)
    return st.tuples(*[st.integers(0, 255)] * 3)


@st.composite
def elements(draw: st.DrawFn, kind: type[Element]) -> Element:
    """Random elements of a kind."""
    drawn = {field.name: draw(values(field)) for field in fields_of(kind)}
    try:
        return kind(**drawn)
    except ElementError:
        reject()


ANY = [elements(kind) for kind in ELEMENTS.values() if not kind.once]
ONCE = [elements(kind) for kind in ELEMENTS.values() if kind.once and not kind.required]


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    """Random scenes whose elements have no source."""
    items = [draw(elements(kind)) for kind in ELEMENTS.values() if kind.required]
    items += [draw(each) for each in ONCE if draw(st.booleans())]
    return Scene(draw(st.permutations(items + draw(st.lists(st.one_of(ANY), max_size=5)))))


@st.composite
def texts(draw: st.DrawFn) -> str:
    """Random scene files with blanks, comments, byte order marks and both line ends."""
    lines = []
    for element in draw(scenes()).elements:
        blank = draw(st.lists(st.tuples(INDENTS, COMMENTS), max_size=1))
        lines += [indent + comment + draw(ENDS) for indent, comment in blank]
        words = describe(element).split(" ")
        if isinstance(element, Camera) and draw(st.booleans()):
            words = [*words[:4], f"roll:{element.roll!r}"]
        body = "".join(word + draw(BLANKS) for word in words[:-1]) + words[-1]
        lines.append(draw(INDENTS) + body + draw(INDENTS) + draw(COMMENTS) + draw(ENDS))
    return draw(st.sampled_from(["", "\ufeff"])) + "\n".join(lines) + draw(st.sampled_from(["", "\n", "\n\n"]))
