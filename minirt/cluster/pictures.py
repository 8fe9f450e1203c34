"""Pictures of many bands and of many scenes, rendered here or by workers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from itertools import accumulate
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Literal

import numpy as np

from minirt.cluster.job import Band, Job, Made, image_of, render_band, rows_of, whole
from minirt.cluster.journal import Journal, packed, record_of
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
    return frames(scenes, (width, height), settings, executor)


def frames(
    scenes: Iterable[Scene],
    size: tuple[int | None, int | None],
    settings: RenderSettings,
    executor: Workers | None = None,
) -> Iterator[Image]:
    """Yield the pictures of scenes in order."""
    tones: list[str] = []

    def bands() -> Iterator[Band]:
        first = None
        for number, scene in enumerate(scenes):
            check_scene(scene, "render_all")
            first = first or size_for(scene, *size)
            tones.append(scene.camera.tone)
            yield Band(number, scene, first, settings)

    for number, made in render_bands(bands(), executor, in_order=True):
        yield image_of(made, tones[number])


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
    try:
        file_io.probe(path)
        return stream(
            Path(os.path.realpath(path)), Job(scene, size, settings), bits, executor, on_progress
        )  # a link stays
    except OSError as reason:
        raise RenderError(f"{os.fspath(path)}: cannot write: {reason.strerror or reason}") from None


def stream(output: Path, job: Job, bits: int, executor: Workers | None, on_progress: Progress) -> Outcome | None:
    """Render a picture into a journal that begins as a TIFF file does, and make that the output. OSError."""
    region = job.region
    bands = job.bands(rows_of(region), bits)
    with closing(Journal(output, job.work(bits), resume=True, head=tiff.header())) as journal:
        kept = ((band.number, journal.read(band.number)) for band in bands)
        done = {number: record_of(data) for number, data in kept if data}
        on_progress(len(done), len(bands))
        for number, made in render_bands([each for each in bands if each.number not in done], executor):
            done[number] = record_of(journal.append(number, packed(made)))
            on_progress(len(done), len(bands))
        places, sizes = [], []
        for band in bands:
            record = done[band.number]
            starts = accumulate(record.sizes, initial=journal.places[band.number].start + record.start)
            places += list(starts)[:-1]
            sizes += record.sizes

        def ends(start: int) -> tuple[bytes, bytes]:
            directory = tiff.directory(region.width, region.height, bits, places, sizes, start)
            return tiff.header(start), directory

        journal.become_output(output, ends)
    return whole([(band.region, done[band.number].reached) for band in bands])


def picture_of(
    bands: Sequence[Band],
    executor: Workers | None = None,
    journal: Journal | None = None,
    on_progress: Progress = lambda done, bands: None,
) -> tuple[Image, int]:
    """Return the picture of bands that are rendered, or that a journal has, and its rays whose light is not finite."""
    scene, settings = bands[0].scene, bands[0].settings
    if len(bands) == 1 and not (executor or journal):
        made = render_band(bands[0])
        return image_of(made, scene.camera.tone), made.not_finite
    left, top = bands[0].region[:2]
    width = max(band.region.x + band.region.width for band in bands) - left
    height = max(band.region.y + band.region.height for band in bands) - top
    arrays = [np.empty((height, width, 3), np.uint8)] + [np.empty((height, width, 3))] * settings.linear
    done: dict[int, Made] = {}

    def place(number: int, made: Made) -> None:
        x, y, across, down = bands[number].region
        for array, part in zip(arrays, made.parts, strict=False):
            array[y - top : y - top + down, x - left : x - left + across] = part
        done[number] = made._replace(parts=())

    for band in bands:
        shapes = [(band.region.height, band.region.width, 3)] * len(arrays)
        if journal and (kept := journal.restore(band.number, *shapes)):
            place(band.number, kept)
    on_progress(len(done), len(bands))
    start = perf_counter()
    for number, made in render_bands([each for each in bands if each.number not in done], executor):
        if journal:
            journal.offer(number, made, perf_counter() - start)
        place(number, made)
        on_progress(len(done), len(bands))
        start = perf_counter()
    reached = whole([(band.region, done[band.number].reached) for band in bands])
    return image_of(Made(tuple(arrays), reached), scene.camera.tone), sum(each.not_finite for each in done.values())


def render_bands(bands: Iterable[Band], executor: Workers | None, in_order: bool = False) -> Iterator[tuple[int, Made]]:
    """Yield the numbers of bands and what was made of them, as they come or in the order of the bands. RenderError."""
    if executor is None:
        return ((band.number, render_band(band)) for band in bands)
    from minirt.cluster.executor import Dispatcher

    return Dispatcher(executor).results(bands, in_order)
