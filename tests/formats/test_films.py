"""Films have all pictures, in their colours, at their times: Pillow and PyAV read them back."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from math import dist
from pathlib import Path
from typing import Any
from weakref import WeakSet

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.errors import RenderError
from minirt.formats.table import is_installed
from minirt.movie import save_movie
from minirt.rendering.image import Image
from minirt.viewer.app.replay import FPS as ANIMATION_FPS
from minirt.viewer.app.replay import TICKS, record
from minirt.viewer.editing.motion import turntable
from minirt.viewer.editing.projection import projection_of, scene_centre
from tests.processes import in_child
from tests.viewer.fake import FakeRenderer, scene

needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
pytestmark = pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning")  # what Python 3.12 says of a fork

LOOPS = ("a.gif", "a.webp", "a.apng")
WITH_AV = pytest.mark.skipif(not is_installed("MP4"), reason="no PyAV")
VIDEOS = [pytest.param(each, marks=WITH_AV) for each in ("a.mp4", "a.webm")]
COLOURS = [(250, 0, 0), (0, 250, 0), (0, 0, 250), (200, 180, 20)]


def film(height: int = 36, width: int = 64) -> list[Image]:
    """Pictures of a ball that goes from left to right over a grey slope, each in another colour."""
    y, x = np.mgrid[:height, :width]
    pictures = []
    for number, colour in enumerate(COLOURS):
        array = np.repeat((2 * x + 40).astype(np.uint8)[..., None], 3, axis=2)
        array[(x - 8 - 14 * number) ** 2 + (y - height // 2) ** 2 < 49] = colour
        pictures.append(Image(array))
    return pictures


@pytest.mark.parametrize(("name", "allowed"), [("a.webp", 9), ("a.apng", 0), ("a.gif", 5)])
def test_a_loop_has_all_pictures_and_repeats(tmp_path: Path, name: str, allowed: int) -> None:
    (path,) = save_movie(film(), tmp_path / name, fps=10)
    with pillow.open(path) as movie:
        assert (movie.n_frames, movie.size, movie.info["loop"]) == (4, (64, 36), 0)
        for number, picture in enumerate(film()):
            movie.seek(number)
            movie.load()
            assert movie.info["duration"] == 100
            assert np.abs(np.asarray(movie.convert("RGB")).astype(int) - picture.array).mean() <= allowed


@pytest.mark.parametrize(("name", "codec"), [("a.mp4", "h264"), ("a.webm", "vp9"), ("a.M4V", "h264")])
@pytest.mark.parametrize("size", [(36, 64), (35, 63)])
def test_a_video_has_all_pictures_in_their_colours(
    tmp_path: Path, name: str, codec: str, size: tuple[int, int]
) -> None:
    av = pytest.importorskip("av")
    save_movie(film(*size), tmp_path / name, fps=10)
    with av.open(str(tmp_path / name)) as container:
        (stream,) = container.streams
        assert (stream.codec_context.name.removeprefix("lib"), stream.average_rate) == (codec, 10)
        frames = [(frame.time, read(frame)) for frame in container.decode(video=0)]
    assert [time for time, _ in frames] == pytest.approx([0, 0.1, 0.2, 0.3], abs=2e-3)
    for (_, found), picture in zip(frames, film(*size), strict=True):
        assert found.shape[:2] == (36, 64)  # even
        cut = found[: size[0], : size[1]].astype(int)
        assert np.abs(cut - picture.array).mean() < 6  # colours have half the resolution


def read(frame: object) -> np.ndarray:
    """The pixels of a frame, converted by the matrix that the file names."""
    array: np.ndarray = frame.reformat(format="rgb24").to_ndarray()  # type: ignore[attr-defined]
    return array


def studio_levels(colour: tuple[int, int, int], red: float, blue: float) -> np.ndarray:
    """Brightness and the two differences of colour of a film, from the weights of red and blue (ITU-R BT.709, 3)."""
    r, g, b = np.array(colour) / 255
    y = red * r + (1 - red - blue) * g + blue * b
    return np.array([16 + 219 * y, 128 + 112 * (b - y) / (1 - blue), 128 + 112 * (r - y) / (1 - red)])


def test_a_green_area_keeps_its_green(tmp_path: Path) -> None:
    """The weights of another standard (BT.601) would be off by 17 levels."""
    av = pytest.importorskip("av")
    colour = (40, 200, 60)
    pictures = [Image(np.full((32, 32, 3), colour, np.uint8))]
    for name in ("a.mp4", "a.webm"):
        save_movie(pictures, tmp_path / name, quality=100)
        with av.open(str(tmp_path / name)) as container:
            context = container.streams[0].codec_context
            assert (int(context.colorspace), int(context.color_range)) == (1, 1)  # BT.709, studio levels
            (frame,) = container.decode(video=0)
            planes = frame.to_ndarray()  # 32 rows of brightness, then 8 of each difference
        levels = planes[[0, 32, 40], 0].astype(int)
        assert np.abs(levels - studio_levels(colour, 0.2126, 0.0722)).max() <= 2
        assert np.abs(levels - studio_levels(colour, 0.299, 0.114)).max() > 10


@pytest.mark.parametrize("name", ["a.webp", *VIDEOS])
def test_quality_changes_the_size(tmp_path: Path, name: str) -> None:
    sizes = []
    for quality in (5, 95):
        save_movie(film(180, 320), tmp_path / name, quality=quality)
        sizes.append((tmp_path / name).stat().st_size)
    assert sizes[0] < 0.7 * sizes[1]


@pytest.mark.parametrize(("name", "allowed"), [("a.webp", 6), ("a.apng", 0), ("a.gif", 5)])
def test_loops_hold_pictures_that_stay_or_change_little(tmp_path: Path, name: str, allowed: int) -> None:
    first = film()[0].array
    changed = [first, first, first.copy(), first.copy(), np.flip(first, axis=1).copy()]
    changed[2][35, 63] = (255, 255, 255)  # the last pixel
    changed[3][17:20, 31:36] = (10, 250, 30)
    save_movie(map(Image, changed), tmp_path / name, fps=10)
    with pillow.open(tmp_path / name) as movie:
        durations = []
        for number, picture in enumerate(changed[1:]):
            movie.seek(number)
            movie.load()
            durations.append(movie.info["duration"])
            found = np.asarray(movie.convert("RGB")).astype(int)
            assert np.abs(found - picture).mean() <= allowed
            assert np.abs(found[17:20, 31:36] - picture[17:20, 31:36]).mean() <= 10 * allowed
        assert durations == [200, 100, 100, 100]  # ms: the first picture stays


@pytest.mark.parametrize(("name", "fps", "longest"), [("a.gif", 0.002, 655_350), ("a.apng", 0.02, 65_535)])
def test_a_picture_stays_at_most_as_long_as_a_format_can_say(
    tmp_path: Path, name: str, fps: float, longest: int
) -> None:
    save_movie([film()[0]] * 3 + film()[1:2], tmp_path / name, fps=fps)
    with pillow.open(tmp_path / name) as movie:
        movie.load()
        assert (movie.n_frames, movie.info["duration"]) == (2, longest)


def most_alive(path: Path, save: Callable[[Iterator[Image]], object]) -> int:
    """The most pictures of a film that are in memory at once while it is saved."""
    alive: WeakSet[Image] = WeakSet()
    counts = []

    def pictures() -> Iterator[Image]:
        for number in range(12):
            made = Image(film()[number % 4].array)
            alive.add(made)
            counts.append(len(alive))
            yield made
            del made

    save(pictures())
    assert path.exists()
    return max(counts)


@pytest.mark.parametrize("name", VIDEOS)
def test_two_pictures_of_a_video_are_in_memory_at_once(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    assert most_alive(path, lambda pictures: save_movie(pictures, path)) <= 2
    assert most_alive(path, lambda pictures: save_movie(list(pictures), path)) == 12  # which would be noticed


@needs_fork
@pytest.mark.each_python
@pytest.mark.parametrize("name", VIDEOS)
def test_a_forked_child_writes_the_film_that_its_parent_has_written(tmp_path: Path, name: str) -> None:
    """At this size FFmpeg converts colours in several threads, none of which a child has."""
    pictures, paths = film(360, 640), [tmp_path / f"before-{name}", tmp_path / f"after-{name}"]
    save_movie(pictures, paths[0])
    assert in_child(lambda: save_movie(pictures, paths[1])) == 0
    av = pytest.importorskip("av")
    counts = []
    for path in paths:  # the bytes of films differ at times
        with av.open(str(path)) as container:
            counts.append(sum(1 for _ in container.decode(video=0)))
    assert counts == [len(pictures)] * 2


@pytest.mark.parametrize(
    ("pictures", "message"),
    [
        ([*film(), *film(20, 30)], "the pictures of a film have one size, got 30x20 and 64x36"),
        ([], "a movie needs a picture"),
    ],
    ids=["two sizes", "none"],
)
@pytest.mark.parametrize("name", [*LOOPS, *VIDEOS])
def test_what_is_no_film_is_refused(tmp_path: Path, name: str, pictures: list[Image], message: str) -> None:
    with pytest.raises(RenderError, match=message):
        save_movie(pictures, tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["a.gif", "a.png"])
def test_arrays_are_pictures_of_a_film(tmp_path: Path, name: str) -> None:
    pictures = film()
    of_images = save_movie(pictures, tmp_path / f"images-{name}")
    of_arrays = save_movie([each.array for each in pictures], tmp_path / f"arrays-{name}")
    assert [each.read_bytes() for each in of_arrays] == [each.read_bytes() for each in of_images]


@pytest.mark.parametrize(
    ("picture", "found"),
    [
        (np.zeros((4, 4, 3)), r"an array \(4, 4, 3\) of float64"),
        (np.zeros((4, 4), np.uint8), r"an array \(4, 4\) of uint8"),
        (np.zeros((0, 4, 3), np.uint8), r"an array \(0, 4, 3\) of uint8"),
        ("a.png", "'a.png'"),
    ],
)
def test_a_film_says_what_it_takes(tmp_path: Path, picture: Any, found: str) -> None:
    message = rf"^a film takes pictures of minirt.render, or arrays \(h, w, 3\) of uint8 from 0 to 255, got {found}$"
    for name in ("a.gif", "a.png"):
        with pytest.raises(RenderError, match=message):
            save_movie([picture], tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_other_formats_give_numbered_files(tmp_path: Path) -> None:
    written = save_movie(film(), tmp_path / "a b.png")
    assert [path.name for path in written] == [f"a b-000{n}.png" for n in (1, 2, 3, 4)]
    assert np.array_equal(np.asarray(pillow.open(written[1])), film()[1].array)


def test_a_turntable_circles_the_scene_once() -> None:
    start = scene()
    middle = scene_centre(start)
    views = list(turntable(start, 8))
    assert views[0] is start
    cameras = [view.camera for view in views]
    assert len({camera.position for camera in cameras}) == 8
    for camera in cameras:
        assert dist(camera.position, middle) == pytest.approx(dist(start.camera.position, middle))
        assert camera.position[1] == start.camera.position[1]
        assert projection_of(camera, 64, 48).pixel(middle) == pytest.approx(
            projection_of(start.camera, 64, 48).pixel(middle)
        )
    opposite = cameras[4].position
    assert [opposite[0] + 0, opposite[2] + 10] == pytest.approx([2 * middle[0], 2 * middle[2]])
    assert dist(cameras[7].position, cameras[0].position) == pytest.approx(
        dist(cameras[1].position, cameras[0].position)
    )


def test_an_animation_has_frames_for_its_whole_duration() -> None:
    lines = ["wait 1", "move 20,20", "hold d 0.5"]
    frames: list[Image] = []
    record(scene(), lines, frames.append, renderer=FakeRenderer(), size=(64, 48), path="scene.rt")
    assert abs(len(frames) - 1.5 * ANIMATION_FPS) <= 2
    assert TICKS % ANIMATION_FPS == 0
    assert np.array_equal(frames[0].array, frames[3].array)
    assert (frames[-3].array[20:40, 20:32] == 255).all(axis=2).any()  # the pointer
    assert not np.array_equal(frames[-3].array, frames[-2].array)  # the camera moves
