"""Fuzzing: a damaged file gives a scene or a SceneError, and nothing else."""

from __future__ import annotations

from hypothesis import example, given, settings
from hypothesis import strategies as st

from minirt.errors import SceneError
from minirt.scene import dump, parse
from tests.guards import must_end
from tests.scene.examples import CYLINDER, SUBJECT, WHOLE
from tests.scene.strategies import texts

ODD = [*"\r\n\v\f\x85\u2028\xa0\ufeff\ud800\0\u2212٣, #:.", "//", "L ", "\t,", "C 0,0,0 0,0,1 7", "9" * 299, "9" * 309]
ODD += ["nan", "1e999", "1_0", "0x1", "--", "sp", "roll:", "roll:1", "e", "1e309", "255,255,255"]
LIGHTS = (
    "C 0,0,0,1 0,0,1 7 roll:3\nL 0,0,0 1\nL 0, 0, 0 1 2.5,0,0 // a\nL 0,0,0,0 .5 1,2,3\nl 0,0,0 1\n"  # lenient only
)

UNDAMAGED = st.one_of(st.sampled_from([WHOLE, SUBJECT, LIGHTS]), texts())
HOW_OFTEN, LENGTHS = st.integers(1, 4), st.integers(0, 5)
INSERTIONS = st.one_of(st.sampled_from(ODD), st.text(max_size=3), st.none())


@st.composite
def damaged(draw: st.DrawFn) -> str:
    """Draw a scene file with characters deleted, doubled, replaced or inserted."""
    text = draw(UNDAMAGED)
    for _ in range(draw(HOW_OFTEN)):
        at = draw(st.integers(0, len(text)))
        end = at + draw(LENGTHS)
        insertion = draw(INSERTIONS)
        text = text[:at] + (text[at:end] * 2 if insertion is None else insertion) + text[end:]
    return text


def check_outcome(text: str | bytes) -> None:
    """Parse a text strictly and leniently: each accepts it or refuses it with columns in the text."""
    accepted = []
    for lenient in (False, True):
        try:
            with must_end():
                scene = parse(text, "test.rt", lenient).scene
        except SceneError as error:
            refused = error
        else:
            accepted.append(lenient)
            assert dump(scene) == (text if isinstance(text, str) else text.decode())
            continue
        assert str(refused).startswith("test.rt:")
        assert all(problem.column <= len(problem.text) + 1 for problem in refused.problems)
    assert accepted in ([], [True], [False, True])


@given(damaged())
@settings(max_examples=400)
def test_a_damaged_file_is_read_or_refused(text: str) -> None:
    check_outcome(text)


@given(st.binary() | st.text())
@settings(max_examples=200)
@example("sp 0,0,0 1 1,1,1,\n,")
@example("\r")
@example(" ,")
def test_any_bytes_and_texts_are_read_or_refused(data: bytes | str) -> None:
    check_outcome(data)


def test_a_line_with_any_character_dropped_doubled_or_replaced_is_read_or_refused() -> None:
    frame = "A 0.2 1,2,3\nC 0,0,0 0,0,1 70\n"
    for at in range(len(CYLINDER)):
        for insertion in ["", CYLINDER[at] * 2, *ODD]:
            check_outcome(frame + CYLINDER[:at] + insertion + CYLINDER[at + 1 :])


def test_every_prefix_of_a_file_is_read_or_refused() -> None:
    for end in range(len(WHOLE)):
        check_outcome(WHOLE[:end])
