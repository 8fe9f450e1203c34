"""Pictures streamed into a file are those of `minirt.render`, whoever renders their bands, and go on after a kill."""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import minirt
from minirt.cluster import pictures
from minirt.cluster.job import rows_of
from minirt.cluster.journal import HEAD
from minirt.errors import RenderError
from minirt.rendering.packing.camera import Region
from tests.cli.program import environment
from tests.cluster.scenes import BALL, with_files
from tests.lines import next_line
from tests.processes import run, started

SIZE = 600, 400
BANDS = len(rows_of(Region(0, 0, *SIZE)))


def rendered(path: Path, **how: Any) -> list[int]:
    """The numbers of bands that were done, each time that one more was."""
    done: list[int] = []
    minirt.render_to(path, BALL, *SIZE, **how, on_progress=lambda number, _: done.append(number))
    return done


def picture(**how: Any) -> np.ndarray:
    return minirt.render(BALL, *SIZE, **how).array


@pytest.mark.parametrize(
    "make",
    [lambda: None, lambda: ThreadPoolExecutor(3), lambda: ProcessPoolExecutor(2)],
    ids=["here", "threads", "pool"],
)
def test_the_picture_is_the_same_whoever_renders_its_bands(make: Callable[[], Executor | None], tmp_path: Path) -> None:
    executor = make()
    assert rendered(tmp_path / "a.tif", samples=2, executor=executor) == list(range(BANDS + 1))
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture(samples=2))
    assert [each.name for each in tmp_path.iterdir()] == ["a.tif"]
    if executor:
        assert executor.submit(int, "3").result() == 3  # it is the caller's, and stays open
        executor.shutdown()


def test_tone_dithering_and_16_bits_are_those_of_the_picture(tmp_path: Path) -> None:
    scene = BALL.replace(BALL.camera, tone="srgb", exposure=0.5)
    minirt.render_to(tmp_path / "a.tif", scene, *SIZE, dither=True)
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), minirt.render(scene, *SIZE, dither=True).array)
    minirt.render_to(tmp_path / "b.tif", scene, *SIZE, bits=16)
    assert np.array_equal(tifffile.imread(tmp_path / "b.tif"), minirt.render(scene, *SIZE).deep)


def test_files_of_a_scene_are_found_by_processes(tmp_path: Path) -> None:
    scene = with_files(tmp_path / "home")
    with ProcessPoolExecutor(1) as pool:
        minirt.render_to(tmp_path / "a.tif", scene, 40, 50, executor=pool)
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), minirt.render(scene, 40, 50).array)


def test_a_region_has_the_pixels_of_the_picture(tmp_path: Path) -> None:
    minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, region=(37, 21, 300, 370))
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture()[21:391, 37:337])
    with pytest.raises(RenderError, match="does not lie in the picture"):
        minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, region=(37, 21, 600, 370))


def test_an_error_is_reached_by_the_whole_picture(tmp_path: Path) -> None:
    """The estimate, and the error against a picture of many samples."""
    reached = minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, samples="auto", error=0.004, bits=16)
    assert reached
    assert 0 < reached.error <= 0.004
    assert reached.goal == 0.004
    assert reached.is_reached
    converged = np.minimum(minirt.render(BALL, *SIZE, samples=1024).linear, 1.0)
    true = np.sqrt(((tifffile.imread(tmp_path / "a.tif") / 65535 - converged) ** 2).mean())
    assert true <= 0.005
    one = np.sqrt(((np.minimum(minirt.render(BALL, *SIZE).linear, 1.0) - converged) ** 2).mean())
    assert one > 0.005  # a planted picture of one sample


class StoppedError(Exception):
    """Ends a rendering from outside."""


def interrupted(path: Path, after: int, **how: Any) -> None:
    """Render until so many bands are done, then stop as if killed."""

    def stop(done: int, _: int) -> None:
        if done == after:
            raise StoppedError

    with pytest.raises(StoppedError):
        minirt.render_to(path, BALL, *SIZE, **how, on_progress=stop)


def test_another_run_goes_on_with_the_missing_bands(tmp_path: Path) -> None:
    interrupted(tmp_path / "a.tif", 4)
    assert sorted(each.name for each in tmp_path.iterdir()) == [".a.tif.journal"]
    assert rendered(tmp_path / "a.tif") == list(range(4, BANDS + 1))
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture())
    assert rendered(tmp_path / "a.tif")[0] == 0  # a complete picture is made anew


def test_a_link_stays_and_its_file_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    (tmp_path / "a.tif").symlink_to(tmp_path / "inner" / "real.tif")
    rendered(tmp_path / "a.tif")
    assert (tmp_path / "a.tif").is_symlink()
    assert [each.name for each in (tmp_path / "inner").iterdir()] == ["real.tif"]
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture())


def damaged(data: bytes) -> bytes:
    """Change a byte of the first band."""
    start = data.index(b"\n") + 1 + HEAD.size + 200
    return data[:start] + bytes([data[start] ^ 1]) + data[start + 1 :]


@pytest.mark.parametrize(
    ("harm", "left"),
    [
        (damaged, 3),
        (lambda data: data[:-20], 3),
        (lambda data: data + b"half a record", 4),
        (lambda data: b"II" + data[:50], 0),
        (lambda data: b"", 0),
    ],
)
def test_what_is_damaged_is_made_again(harm: Callable[[bytes], bytes], left: int, tmp_path: Path) -> None:
    interrupted(tmp_path / "a.tif", 4)
    journal = tmp_path / ".a.tif.journal"
    journal.write_bytes(harm(journal.read_bytes()))
    assert rendered(tmp_path / "a.tif") == list(range(left, BANDS + 1))
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture())


@pytest.mark.parametrize("other", [{"samples": 2}, {"depth": 1}, {"bits": 16}, {"dither": True}], ids=str)
def test_the_journal_of_another_picture_is_not_gone_on_with(other: dict[str, Any], tmp_path: Path) -> None:
    interrupted(tmp_path / "a.tif", 4)
    assert rendered(tmp_path / "a.tif", **other)[0] == 0


def test_a_journal_that_any_picture_went_on_with_would_mix_two(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a planted key that is always the same."""
    monkeypatch.setattr(pictures, "work_of", lambda *_: "same")
    interrupted(tmp_path / "a.tif", 4)
    assert rendered(tmp_path / "a.tif", samples=3)[0] == 4
    assert not np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture(samples=3))


@pytest.mark.skipif(sys.platform == "win32", reason="no locks")
def test_two_programs_do_not_write_into_one_file(tmp_path: Path) -> None:
    def second(done: int, _: int) -> None:
        if done == 2:
            with pytest.raises(RenderError, match="another program"):
                minirt.render_to(tmp_path / "a.tif", BALL, *SIZE)

    minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, on_progress=second)
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture())


KILLED = """
import sys, minirt
def tell(done, bands):
    print(done, flush=True)
minirt.render_to("a.tif", minirt.load("ball.rt"), 600, 400, samples=64, on_progress=tell)
"""


def test_a_killed_program_is_gone_on_with(tmp_path: Path) -> None:
    BALL.save(tmp_path / "ball.rt")
    with started([sys.executable, "-c", KILLED], cwd=tmp_path, env=environment(), stdout=-1) as program:
        while next_line(program) != "3":
            pass
        program.kill()
    done: list[int] = []
    minirt.render_to(
        tmp_path / "a.tif",
        minirt.load(tmp_path / "ball.rt"),
        *SIZE,
        samples=64,
        on_progress=lambda number, _: done.append(number),
    )
    assert 3 <= done[0] < BANDS
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture(samples=64))


MEMORY = """
import minirt
from pathlib import Path
scene = minirt.load("ball.rt")
minirt.render(scene, 16, 16)
{}
print(Path("/proc/self/status").read_text().partition("VmHWM:")[2].split()[0])
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_a_large_picture_needs_the_memory_of_a_few_bands(tmp_path: Path) -> None:
    """Less than its pixels take; a planted program that keeps the picture needs more."""
    BALL.save(tmp_path / "ball.rt")
    size = "16000, 2400"
    streamed, kept = (
        int(run([sys.executable, "-c", MEMORY.format(code)], cwd=tmp_path, env=environment()).stdout) * 1024
        for code in (f"minirt.render_to('a.tif', scene, {size})", f"minirt.render(scene, {size}, linear=False)")
    )
    assert streamed < 4 * 16000 * 2400 < kept


@pytest.mark.parametrize(
    ("path", "how", "message"),
    [
        ("a.png", {}, "render_to writes TIFF, try a.tif"),
        ("no/a.tif", {}, "cannot write"),
        ("a.tif", {"bits": 12}, "TIFF has 8 or 16 bits"),
        ("a.tif", {"error": 0.1}, "samples='auto'"),
        ("a.tif", {"samples": 0}, "at least 1 sample"),
        ("a.tif", {"precision": "half"}, "double or single"),
    ],
)
def test_wrong_arguments_are_refused(path: str, how: dict[str, Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(RenderError, match=message):
        minirt.render_to(tmp_path / path, BALL, *SIZE, **how)
    assert not (tmp_path / "a.tif").exists()


def test_sizes_are_checked(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match="at least 1x1 pixels"):
        minirt.render_to(tmp_path / "a.tif", BALL, 0, 5)
    with pytest.raises(RenderError, match="at most 2,147,483,647 pixels"):
        minirt.render_to(tmp_path / "a.tif", BALL, 2**31, 5)
