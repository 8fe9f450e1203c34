"""A short seeded run of each fuzzer, and wrong programs that it must find."""

from __future__ import annotations

from pathlib import Path

import pytest

from minirt.errors import FileError, MiniRTError, SceneError
from minirt.fields import scalars
from minirt.materials import pictures
from minirt.meshes import obj_lines
from minirt.mlx.recording import Line
from minirt.rendering.packing import camera
from tests.fuzz import grammar, inputs, scenes
from tests.fuzz.mutations import Fuzzer, seeded
from tests.fuzz.worker import FUZZERS

FRAME = "A 1 9,9,9\nC 0,0,0 0,0,1 60\n"


def run(name: str, inputs: int) -> set[str]:
    """Check some inputs of a fuzzer; return the verdicts."""
    fuzzer: Fuzzer = FUZZERS[name]
    return {fuzzer.check(fuzzer.make(seeded(name, number))) for number in range(inputs)}


@pytest.mark.parametrize("name", FUZZERS)
def test_no_input_crashes_the_program_or_gets_a_wrong_verdict(name: str) -> None:
    assert len(run(name, FUZZERS[name].short)) > 1, "all inputs had the same fate"


def test_the_same_number_gives_the_same_input() -> None:
    for name, fuzzer in FUZZERS.items():
        assert fuzzer.make(seeded(name, 7)) == fuzzer.make(seeded(name, 7)) != fuzzer.make(seeded(name, 8))


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("sp 0,0,0 1 1,2,3", True),
        ("sp 0,0,0 1 1,2,3 mirror:0.5,2 axis:1,0,0", True),
        ("sp 0,0,0 1 1,2,3 mirror:0.5 mir:0.5", False),
        ("sp 0,0,0 0 1,2,3", False),
        ("sp 0,0,0 1 1,2,256", False),
        ("pl 0,0,0 0,1,0,0 1,2,3", True),
        ("pl 0,0,0 0,0,0 1,2,3", False),
        ("hy 0,0,0 0,1,0 2 1 1 1,2,3", False),
        ("tr 0,0,0 1,1,1 2,2,2 1,2,3", False),
        ("sp 0,0,0 1 1,2,3 fresnel checker uv:1,2,0,0,90", True),
        ("sp 0,0,0 1 1,2,3\r", True),
        ("sp 0,0,0 1 1,2,3 \xa0", False),
    ],
)
def test_the_grammar_agrees_with_the_description(line: str, expected: bool) -> None:
    assert grammar.is_scene((FRAME + line).encode()) is expected


def test_a_limit_that_is_off_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scalars, "LONGEST", 302)
    with pytest.raises(AssertionError, match="the grammar says False"):
        scenes.check_scene(f"{FRAME}sp 0,0,0 {'0' * 300}1 1,2,3".encode())


def test_a_fast_reader_of_meshes_that_counts_wrongly_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    table = obj_lines.corner_table
    monkeypatch.setattr(obj_lines, "corner_table", lambda faces: abs(table(faces)))
    with pytest.raises(AssertionError, match="diagnosing reader"):
        run("meshes", FUZZERS["meshes"].short)


def test_a_decoder_that_refuses_good_pictures_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def strict(path: Path, _: bytes) -> None:
        raise FileError(path, "broken data stream")

    monkeypatch.setattr(pictures, "decode_by_pillow", strict)
    with pytest.raises(AssertionError, match="a good picture is refused"):
        run("pictures", FUZZERS["pictures"].short)


def test_a_recording_whose_times_are_not_checked_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Line, "seconds", lambda self, index: float(self.words[index]))
    with pytest.raises(ValueError, match="could not convert"):
        FUZZERS["replays"].check(b"wait x")


def test_a_program_that_lets_errors_through_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("minirt.cli.MiniRTError", SceneError)
    with pytest.raises(MiniRTError):
        run("arguments", inputs.ARGUMENTS.short)


def test_a_lens_whose_focus_has_no_reciprocal_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(camera, "SMALLEST", 0.0)
    monkeypatch.setattr(camera, "CLOSEST", 0.0)
    line = "A 1 9,9,9\nC 0,0,0 0,0,1 60 lens:1 focus:1e-310\nsp 0,0,5 1 1,2,3"
    with pytest.raises(Warning):
        FUZZERS["extremes"].check(line.encode())
