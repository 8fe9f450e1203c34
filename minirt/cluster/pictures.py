"""Pictures of many bands and of many scenes, rendered here or by workers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from itertools import accumulate, chain
from operator import length_hint
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Literal

import numpy as np

from minirt.cluster.job import Band, Job, Made, image_of, render_band, rows_of, whole
from minirt.cluster.journal import Journal
from minirt.errors import RenderError
from minirt.formats import tiff
from minirt.formats.table import check_bits, check_size, format_of
from minirt.helpers import file_io
from minirt.rendering.image import Image
from minirt.rendering.outcome import Outcome
from minirt.rendering.packing.camera import Region
from minirt.rendering.settings import RenderSettings
from minirt.scene import Scene
from minirt.scene.scene import check_scene, size_for

if TYPE_CHECKING:
    from minirt.cluster.executor import Workers

Progress = Callable[[int, int], object]  # gets the number of bands that are done, and of all


def render_all(
    scenes: Iterable[Scene],
    width: int | None = None,
    height: int | None = None,
    *,
    executor: Workers | None = None,
    samples: int | Literal["auto"] = 1,
    error: float | None = None,
    time: float | None = None,
    threads: int | None = None,
    precision: Literal["double", "single"] = "double",
    depth: int | None = None,
    linear: bool = False,
    dither: bool = False,
    region: tuple[int, int, int, int] | None = None,
) -> Iterator[Image]:
    """Render scenes, such as the frames of a film or the steps of a sweep, and yield their pictures in order.

    A few scenes are taken ahead of the picture that is waited for. The executor is that of `render_to`, the other
    arguments are those of `render`, without a size that of the first scene; the pictures are those of `render`, whoever
    renders them. Scenes that differ from the one before in the camera alone send just that.
    """
    part = region and Region(*region)
    settings = RenderSettings(samples, error, time, threads, precision, depth, linear, dither, part)

    def bands() -> Iterator[Band]:
        size = None
        for number, scene in enumerate(scenes):
            check_scene(scene, "render_all")
            size = size or size_for(scene, width, height)
            yield Band(number, scene, size, settings)

    return (image_of(*each) for each in results(bands(), executor, in_order=True))


def render_to(
    path: str | os.PathLike[str],
    scene: Scene,
    width: int | None = None,
    height: int | None = None,
    *,
    executor: Workers | None = None,
    samples: int | Literal["auto"] = 1,
    error: float | None = None,
    threads: int | None = None,
    precision: Literal["double", "single"] = "double",
    depth: int | None = None,
    dither: bool = False,
    bits: Literal[8, 16] = 8,
    region: tuple[int, int, int, int] | None = None,
    on_progress: Progress = lambda done, bands: None,
) -> Outcome | None:
    """Render a picture of any size into a TIFF file, with a few bands of rows in memory at a time.

    `executor` is an executor of `concurrent.futures`, a function that makes one, or a client of dask.distributed;
    without one this process renders. The pixels are those of `minirt.render`, whoever renders a band. The file is
    complete or absent: until then a hidden `.NAME.journal` beside it has the bands that are done. The same call after
    an interruption goes on with those that are missing.

    With `samples` "auto" each band is rendered until its estimated error is at most `error`; then that of the whole
    picture is, too, since its square is the mean of theirs. The result is the whole picture's. `on_progress` gets the
    number of bands that are done, and of all. RenderError when rendering or writing fails.
    """
    check_scene(scene, "render_to")
    name = format_of(path)
    if name != "TIFF":
        raise RenderError(f"{os.fspath(path)}: render_to writes TIFF, try {Path(path).stem}.tif")
    check_bits(name, bits)
    part = region and Region(*region)
    settings = RenderSettings(samples, error, None, threads, precision, depth, bits == 16, dither, part)
    size = size_for(scene, width, height)
    check_size(path, name, *size)
    return stream(path, Job(scene, size, settings), bits, executor, on_progress)


def stream(
    path: str | os.PathLike[str], job: Job, bits: int, executor: Workers | None, on_progress: Progress
) -> Outcome | None:
    """Render a picture into a TIFF file, or go on with it; return its outcome. RenderError."""
    try:
        file_io.probe(path)
        return write_tiff(Path(os.path.realpath(path)), job, bits, executor, on_progress)  # a link stays
    except OSError as reason:
        raise RenderError(f"{os.fspath(path)}: cannot write: {reason.strerror or reason}") from None


def write_tiff(output: Path, job: Job, bits: int, executor: Workers | None, on_progress: Progress) -> Outcome | None:
    """Render a picture into a journal that begins as a TIFF file does, and make that the output. OSError."""
    _, _, width, height = job.region
    bands = job.bands(rows_of(job.region), bits)
    with closing(Journal(output, job.work(bits), resume=True, head=tiff.header())) as journal:
        sizes: dict[int, list[int]] = {}  # bytes of the strips of each band
        outcomes = []
        for band, made in results(bands, executor, journal, on_progress):
            sizes[band.number] = [len(each) for each in made.parts]
            outcomes.append((band.region, made.reached))
        starts: list[int] = []  # of the strips, which are at the end of their record
        for band in bands:
            start, length = journal.places[band.number]
            starts += list(accumulate(sizes[band.number], initial=start + length - sum(sizes[band.number])))[:-1]
        end = tiff.even(max(start + length for start, length in journal.places.values()))
        lengths = list(chain.from_iterable(sizes[band.number] for band in bands))
        tail = tiff.directory(width, height, bits, starts, lengths, end)
        journal.become_output(output, tiff.header(end), end, tail)
    return whole(outcomes)


def picture_of(
    job: Job,
    bands: Sequence[Band],
    executor: Workers | None = None,
    journal: Journal | None = None,
    on_progress: Progress = lambda done, bands: None,
) -> tuple[Image, int]:
    """Return the picture of bands that are rendered, or that a journal has, and its rays whose light is not finite."""
    made_of = results(bands, executor, journal, on_progress)
    if len(bands) == 1:
        ((band, made),) = made_of
        return image_of(band, made), made.not_finite
    left, top, width, height = job.region
    arrays = [np.empty((height, width, 3), np.uint8)] + [np.empty((height, width, 3))] * job.settings.linear
    outcomes, not_finite = [], 0
    for band, made in made_of:
        x, y, across, down = band.region
        for array, part in zip(arrays, made.parts, strict=True):
            array[y - top : y - top + down, x - left : x - left + across] = part
        outcomes.append((band.region, made.reached))
        not_finite += made.not_finite
    return image_of(Band(0, *job), Made(tuple(arrays), whole(outcomes))), not_finite


def results(
    bands: Iterable[Band],
    executor: Workers | None = None,
    journal: Journal | None = None,
    on_progress: Progress = lambda done, bands: None,
    in_order: bool = False,
) -> Iterator[tuple[Band, Made]]:
    """Yield bands and what is made of them, as it comes or in the order of the bands. RenderError.

    What the journal has is not rendered again; it keeps what is new once that was used.
    """
    kept = set(journal.places) if journal else set()
    restore = journal.restore if journal else lambda band: None
    done, total = sum(band.number in kept for band in bands) if journal else 0, length_hint(bands)
    on_progress(done, total)
    made_of: Iterable[tuple[Band, Made]] = ((band, restore(band) or render_band(band)) for band in bands)
    if executor is not None:
        from minirt.cluster.executor import Dispatcher

        made_of = Dispatcher(executor).results(bands, restore, in_order)
    start = perf_counter()
    for band, made in made_of:
        seconds = perf_counter() - start
        yield band, made
        if band.number not in kept:
            if journal:
                journal.keep(band.number, made, seconds)
            done += 1
            on_progress(done, total)
        start = perf_counter()
