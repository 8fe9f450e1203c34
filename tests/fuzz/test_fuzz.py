"""A short seeded run of each fuzzer, and wrong programs that it must find."""

from __future__ import annotations

from math import inf
from pathlib import Path

import pytest

from minirt.errors import FileError, MiniRTError, SceneError
from minirt.kernel.machine_code.library import LIBRARY
from minirt.rendering.kernels import Kernels
from minirt.rendering.packing import camera
from tests.cli.program import program
from tests.fuzz import scenes
from tests.fuzz.__main__ import FUZZERS
from tests.fuzz.mutations import Fuzzer, seeded
from tests.seeds import seed_of
from tests.skipping import skip_incomplete

NEW = ("extremes", "names")  # of which each run tries new inputs
FRAME = "A 1 9,9,9\nC 0,0,0 0,0,1 60\n"


def run(name: str, seed: int = 0) -> set[str]:
    """Check the inputs of a short run of a fuzzer; return the verdicts."""
    if name == "extremes" and not all(map(LIBRARY.has, Kernels("single", 8).for_all_scenes)):
        skip_incomplete("generic kernels are not compiled: make all")
    fuzzer: Fuzzer = FUZZERS[name]
    print(f"python -m tests.fuzz 60 {seed} {name}")  # in the report of a failure
    return {fuzzer.check(fuzzer.make(seeded(name, seed * 10**9 + number))) for number in range(fuzzer.short)}


@pytest.mark.parametrize("name", FUZZERS)
def test_no_input_crashes_the_program_or_gets_a_wrong_verdict(name: str) -> None:
    seed = seed_of(f"fuzz {name}") if name in NEW else 0
    assert len(run(name, seed)) > 1, "all inputs had the same fate"


def test_extreme_scenes_are_drawn_by_processes_of_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing of the first is in view, and a camera that would show it is beyond the range of coordinates."""
    monkeypatch.setattr(scenes, "run_program", lambda arguments, folder: program(folder, *arguments))
    seed = seed_of("extreme scenes of processes")
    for data in (FAR.encode(), *(scenes.make_extreme(seeded("process", seed + more)) for more in range(2))):
        print(data)  # in the report of a failure
        assert scenes.check_extreme(data)


def refuse(path: Path, _: bytes) -> None:
    """Decode no picture."""
    raise FileError(path, "broken data stream")


LENS = (
    "# --precision single --samples 4 -o out.png\n" + FRAME.replace("60", "60 lens:1 focus:1e-50") + "sp 0,0,5 1 1,2,3"
)
FAR = f"# -o out.png\n{FRAME}sp -1e15,0,-9e14 1e15 9,9,9"
LONG = f"{FRAME}sp 0,0,0 {'0' * 300}1 1,2,3"


@pytest.mark.parametrize(
    ("name", "text", "where", "wrong", "error"),
    [
        ("scenes", LONG, "minirt.fields.scalars.LONGEST", 302, AssertionError),
        ("scenes", "", "minirt.scene.dialect_files.complete", lambda items, *_: items.reverse(), AssertionError),
        ("scenes", "", "minirt.scene.dialects.MISSING", "missing: ", AssertionError),  # which is no comment
        ("names", "", "minirt.helpers.file_io.reading.found", Path.stat, (OSError, ValueError)),
        ("names", "", "minirt.meshes.mtl.is_file", Path.is_file, (OSError, ValueError)),
        ("meshes", "", "minirt.meshes.obj_bytes.NOWHERE", 0, AssertionError),
        ("pictures", "", "minirt.materials.pictures.decode_by_pillow", refuse, AssertionError),
        (
            "replays",
            "wait x",
            "minirt.mlx.recording.RecordedLine.seconds",
            lambda self, at: float(self.words[at]),
            ValueError,
        ),
        ("arguments", "", "minirt.cli.MiniRTError", SceneError, MiniRTError),
        ("extremes", LENS, "minirt.rendering.packing.camera.CLOSEST", 0.0, Warning),
        ("extremes", "", "minirt.rendering.queries.unseen.FARTHEST", inf, AssertionError),
    ],
)
def test_a_wrong_program_is_found(
    name: str,
    text: str,
    where: str,
    wrong: object,
    error: type[Exception] | tuple[type[Exception], ...],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """By an input, or by those of the short run."""
    monkeypatch.setattr(where, wrong)
    monkeypatch.setattr(camera, "SMALLEST", 0.0)  # which limits the focus, too
    with pytest.raises(error):
        FUZZERS[name].check(text.encode()) if text else run(name)
