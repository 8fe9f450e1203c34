"""Streamed pictures and films are those of `minirt.render`, whoever renders their parts, and go on after a stop."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest
import tifffile

import minirt
from minirt import Scene
from minirt.cluster import executor
from minirt.cluster.job import Job, Made, render_sent_band, rows_of
from minirt.cluster.journal import HEAD
from minirt.errors import RenderError
from minirt.rendering.packing.camera import Region
from minirt.viewer.editing.motion import turntable
from tests.cli.program import environment
from tests.cluster.scenes import BALL, with_files
from tests.processes import run
from tests.waiting import HANG_LIMIT

SIZE = 600, 400
BANDS = len(rows_of(Region(0, 0, *SIZE), 1))


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


def test_tone_dithering_and_more_bits_are_those_of_the_picture(tmp_path: Path) -> None:
    scene = BALL.replace(BALL.camera, tone="srgb", exposure=0.5)
    minirt.render_to(tmp_path / "a.tif", scene, *SIZE, dither=True)
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), minirt.render(scene, *SIZE, dither=True).array)
    minirt.render_to(tmp_path / "b.tif", scene, *SIZE, bits=16)
    assert np.array_equal(tifffile.imread(tmp_path / "b.tif"), minirt.render(scene, *SIZE).deep)
    minirt.render_to(tmp_path / "c.tif", scene, *SIZE, bits=32)
    assert np.array_equal(tifffile.imread(tmp_path / "c.tif"), minirt.render(scene, *SIZE).linear.astype(np.float32))


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
        (damaged, 0),
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


@pytest.mark.skipif(sys.platform == "win32", reason="no locks")
def test_two_programs_do_not_write_into_one_file(tmp_path: Path) -> None:
    def second(done: int, _: int) -> None:
        if done == 2:
            with pytest.raises(RenderError, match="another program"):
                minirt.render_to(tmp_path / "a.tif", BALL, *SIZE)

    minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, on_progress=second)
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture())


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
    size = "16000, 3600"
    streamed, kept = (
        int(run([sys.executable, "-c", MEMORY.format(code)], cwd=tmp_path, env=environment()).stdout) * 1024
        for code in (f"minirt.render_to('a.tif', scene, {size})", f"minirt.render(scene, {size}, linear=False)")
    )
    assert streamed < 4 * 16000 * 3600 < kept


@pytest.mark.parametrize(
    ("path", "how", "message"),
    [
        ("a.png", {}, "render_to writes TIFF, try a.tif"),
        ("no/a.tif", {}, "cannot write"),
        ("a.tif", {"width": 0}, "must be a whole number of at least 1"),
        ("a.tif", {"width": 2**31}, "at most 2,147,483,647 pixels"),
        ("a.tif", {"bits": 12}, "TIFF has 8 or 16 or 32 bits"),
        ("a.tif", {"error": 0.1}, "samples='auto'"),
        ("a.tif", {"samples": 0}, "samples must be a whole number"),
        ("a.tif", {"precision": "half"}, "double or single"),
    ],
)
def test_wrong_arguments_are_refused(path: str, how: dict[str, Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(RenderError, match=message):
        minirt.render_to(tmp_path / path, BALL, **{"width": 600, "height": 400} | how)
    assert not (tmp_path / "a.tif").exists()


# Films and sweeps: pictures of many scenes in order, the same whoever renders them.


FRAME = 64, 48


def sweep(count: int) -> list[Scene]:
    return [BALL.replace(BALL.spheres[0], diameter=1 + n / 10) for n in range(count)]


def assert_same(found: Iterator[minirt.Image], scenes: list[Scene], **how: object) -> None:
    expected = [minirt.render(each, *FRAME, **how) for each in scenes]
    assert not np.array_equal(expected[0].array, expected[1].array)
    pictures = list(found)
    assert len(pictures) == len(expected)
    for one, other in zip(pictures, expected, strict=True):
        assert np.array_equal(one.array, other.array)
        assert one.tone == other.tone
        assert one.linear is None or np.array_equal(one.linear, other.linear)


@pytest.mark.parametrize("executor", [None, ThreadPoolExecutor(3)], ids=["here", "threads"])
def test_a_sweep_gives_a_picture_of_each_scene_in_order(executor: Executor | None) -> None:
    assert_same(minirt.render_all(sweep(9), *FRAME, executor=executor, samples=2), sweep(9), samples=2)


def test_processes_draw_a_turntable_with_files(tmp_path: Path) -> None:
    views = list(turntable(with_files(tmp_path / "home"), 12))
    with ProcessPoolExecutor(2) as pool:
        assert_same(minirt.render_all(views, *FRAME, executor=pool, linear=True), views)


def test_results_that_come_in_another_order_are_put_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first picture is ready after the second."""
    second = Event()

    def late(version: str, data: bytes, camera: minirt.Camera, band: Job) -> Made:
        assert band.number or second.wait(HANG_LIMIT)
        made = render_sent_band(version, data, camera, band)
        if band.number:
            second.set()
        return made

    monkeypatch.setattr(executor, "render_sent_band", late)
    views = list(turntable(BALL, 4))
    with ThreadPoolExecutor(2) as pool:
        assert_same(minirt.render_all(views, *FRAME, executor=pool), views)


def test_few_scenes_are_taken_ahead() -> None:
    taken = []

    def scenes() -> Iterator[Scene]:
        for each in sweep(50):
            taken.append(each)
            yield each

    with ThreadPoolExecutor(2) as pool:
        film = minirt.render_all(scenes(), *FRAME, executor=pool)
        next(film)
        assert len(taken) <= 2 * executor.OF_EACH
        film.close()


def test_scenes_that_differ_in_the_camera_alone_are_packed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    sent = []

    def noted(version: str, data: bytes, *others: Any) -> Made:
        sent.append(data)
        return render_sent_band(version, data, *others)

    monkeypatch.setattr(executor, "render_sent_band", noted)
    with ThreadPoolExecutor(1) as pool:
        assert len(list(minirt.render_all([*turntable(BALL, 2), *sweep(1)], *FRAME, executor=pool))) == 3
    assert sent[0] is sent[1]
    assert sent[2] is not sent[0]


def test_wrong_scenes_and_sizes_of_frames_are_refused() -> None:
    with pytest.raises(RenderError, match="must be a whole number of at least 1"):
        list(minirt.render_all(sweep(1), 0, 5))
    with pytest.raises(TypeError, match="takes a scene"):
        list(minirt.render_all(["demo.rt"], *FRAME))  # type: ignore[list-item]
    assert list(minirt.render_all([])) == []
