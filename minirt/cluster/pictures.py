"""Pictures of many bands and of many scenes, rendered here or by workers."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import closing
from itertools import chain
from operator import length_hint
from pathlib import Path
from time import perf_counter
from typing import Literal, Unpack

import numpy as np

from minirt.cluster.job import Job, Made, Workers, render_band, whole
from minirt.cluster.journal import Journal
from minirt.errors import RenderError
from minirt.formats import tiff
from minirt.formats.table import check_bits, check_size, format_of
from minirt.helpers import file_io
from minirt.rendering.image import Image
from minirt.rendering.outcome import Outcome
from minirt.rendering.settings import Keywords, RenderSettings, takes_settings
from minirt.scene.arguments import check_scene
from minirt.scene.scene import Scene
from minirt.scene.sizes import size_for

Progress = Callable[[int, int], object]  # gets the number of bands that are done, and of all


@takes_settings
def render_all(
    scenes: Iterable[Scene],
    width: int | None = None,
    height: int | None = None,
    *,
    executor: Workers | None = None,
    linear: bool = False,
    **settings: Unpack[Keywords],
) -> Iterator[Image]:
    """Render scenes, such as the frames of a film or the steps of a sweep, and yield their pictures in order.

    The executor is that of `render_to`, and the other arguments are those of `render`; without a size all pictures have
    that of the first scene. The pixels are those of `render`, whoever renders them. A few scenes are taken ahead of the
    picture that is waited for. Where a scene differs from the one before in the camera alone just the camera is sent.
    RenderError when rendering fails; TypeError where a scene is none.
    """
    how = RenderSettings(linear=linear, **settings)

    def bands() -> Iterator[Job]:
        size = None
        for number, scene in enumerate(scenes):
            check_scene(scene, "render_all")
            size = size or size_for(scene, width, height)
            yield Job(scene, size, how, number)

    return (image for _, image in results(bands(), executor, in_order=True))


@takes_settings
def render_to(
    path: str | os.PathLike[str],
    scene: Scene,
    width: int | None = None,
    height: int | None = None,
    *,
    executor: Workers | None = None,
    bits: Literal[8, 16, 32] = 8,
    on_progress: Progress = lambda done, bands: None,
    **settings: Unpack[Keywords],
) -> Outcome | None:
    """Render a picture of any size into a TIFF file, with a few bands of rows in memory at a time.

    `executor` is an executor of `concurrent.futures`, a function that makes one, or a client of dask.distributed;
    without one this process renders. The pixels are those of `minirt.render`, whoever renders a band. The file is
    complete or absent: until then a hidden `.NAME.journal` beside it has the bands that are done. The same call after
    an interruption goes on with those that are missing.

    With `samples` "auto" each band is rendered until its estimated error is at most `error`; the error of the whole
    picture is, too, since its square is the mean of the squares of the bands. `time` is in seconds for each band. The
    result is the outcome of the whole picture; without "auto" it is None. `on_progress` gets the number of bands that
    are done, and of all. RenderError when rendering or writing fails; TypeError where `scene` is no scene, such as the
    name of a file.
    """
    check_scene(scene, "render_to")
    name = format_of(path)
    if name != "TIFF":
        raise RenderError(f"{os.fspath(path)}: render_to writes TIFF, try {Path(path).stem}.tif")
    check_bits(name, bits)
    how = RenderSettings(linear=bits != 8, **settings)
    size = size_for(scene, width, height)
    check_size(path, name, *size)
    return stream(path, Job(scene, size, how), bits, executor, on_progress)


def stream(
    path: str | os.PathLike[str], job: Job, bits: int, executor: Workers | None, on_progress: Progress
) -> Outcome | None:
    """Render a picture into a TIFF file, or go on with it; return its outcome. RenderError."""
    bands, outcomes = job.bands(bits), []
    with file_io.told_errors(path):
        file_io.probe(path)
    with Journal(path, job.identity(bits), keeps_all=True) as journal, file_io.told_errors(path):
        for band, made in results(bands, executor, journal, on_progress):
            outcomes.append((band.region, made.reached))
        strips = chain.from_iterable(each.parts for each in map(journal.restore, bands) if each)
        file_io.write(path, lambda file: tiff.write(file, *job.region[2:], bits, strips))
    return whole(outcomes)


def picture_of(job: Job, executor: Workers | None, journal: Journal | None, on_progress: Progress) -> Image:
    """Render a picture: as a whole, or in bands where there are workers or a journal. The journal may have some bands
    already and gets the others; its file is left to the caller. RenderError."""
    if executor is None and journal is None:
        whole_picture: Image = render_band(job)
        return whole_picture
    _, top, width, height = job.region
    levels = np.empty((height, width, 3), np.uint8)
    light = np.empty((height, width, 3)) if job.settings.linear else None
    outcomes, not_finite = [], 0
    for band, image in results(job.bands(), executor, journal, on_progress):
        rows = slice(band.region.y - top, band.region.y - top + band.region.height)
        levels[rows] = image.array
        if light is not None:
            light[rows] = image.linear
        outcomes.append((band.region, image.reached))
        not_finite += image.not_finite
    return Image(levels, light, whole(outcomes), job.scene.camera.tone, not_finite)


def results(
    bands: Iterable[Job],
    executor: Workers | None = None,
    journal: Journal | None = None,
    on_progress: Progress = lambda done, bands: None,
    in_order: bool = False,
) -> Iterator[tuple[Job, Made]]:
    """Yield bands and what is made of them: the first that is made first, or `in_order`. RenderError.

    Bands that the journal has are not rendered again. The journal keeps a new band after it was used: when the caller
    asks for the next one. `bands` is a list where there is a journal, else any iterable. `on_progress` gets the numbers
    of bands that are done, and of all: 0 where that is not known.
    """
    kept = set(journal.places) if journal else set()
    restore = journal.restore if journal else lambda band: None
    done, total = sum(band.number in kept for band in bands) if journal else 0, length_hint(bands)
    on_progress(done, total)
    if journal:
        journal.total = total
    made_of: Generator[tuple[Job, Made], None, None] = ((band, restore(band) or render_band(band)) for band in bands)
    if executor is not None:
        from minirt.cluster.executor import Dispatcher

        made_of = Dispatcher(executor).results(bands, restore, in_order)
    start = perf_counter()
    with closing(made_of):  # an error ends the work now, and not when the generator is deleted
        for band, made in made_of:
            seconds = perf_counter() - start
            yield band, made
            if band.number not in kept:
                if journal:
                    journal.keep(band.number, made, seconds)
                done += 1
                on_progress(done, total)
            start = perf_counter()
