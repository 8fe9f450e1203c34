"""Rendering pictures and turntables to a file or to standard output, here or by workers."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from itertools import islice
from time import perf_counter
from typing import Any

from minirt.cli.arguments import FAILED, OK, SAMPLES, tell
from minirt.cli.files import check_output, format_name, is_film, needs_light, write
from minirt.cli.options import settings_text
from minirt.cluster.job import Job, Workers
from minirt.cluster.journal import BANDS, Journal, journal_path
from minirt.cluster.pictures import picture_of, results, stream
from minirt.errors import RenderError
from minirt.formats.table import memory_of
from minirt.helpers import file_io, system
from minirt.helpers.progress import WorkState, progress
from minirt.rendering.image import Image
from minirt.rendering.outcome import Outcome
from minirt.rendering.packing.camera import Region, cut_for
from minirt.rendering.settings import LIGHT, RenderSettings
from minirt.scene import Scene, dump, files, size_of

LONG = 2**24  # rays: work of about a second of two processors, which an interrupt does not undo
GIVEN = ("error", "time", "threads", "precision", "depth", "dither", "region")  # options that are settings
PATIENCE = 10  # seconds for a scheduler to answer


def render_output(scene: Scene, options: argparse.Namespace) -> int:
    """Render a picture, or the pictures of a turntable, and write the output. Return the exit status: FAILED where
    --strict is given and the error that was asked for is not reached."""
    size = options.size or size_of(scene)
    given: dict[str, Any] = {name: value for name in GIVEN if (value := getattr(options, name)) is not None}
    settings = RenderSettings(options.samples or SAMPLES, linear=needs_light(options, options.output), **given)
    region = cut_for(settings.region, *size).region  # RenderError for one that is not inside of the picture
    render = render_film if options.turntable else render_picture
    streamed = is_streamed(options, region)
    with system.gc_paused(), workers(options) as executor:
        share = Share(settings, region, options, is_here=not executor)
        job = Job(scene, size, settings)
        if streamed:
            with progress(share.state):
                outcome = stream(options.output, job, options.bits or 8, executor, share.note)
        else:
            outcome = render(job, options, executor, share)
    if outcome:
        tell(outcome)
        if outcome.notice:
            tell(f"notice: {outcome.notice}")
    return FAILED if options.strict and outcome and not outcome.is_reached else OK


@contextmanager
def workers(options: argparse.Namespace) -> Iterator[Any]:
    """Give the block the workers that --cluster names: None for this process, the function that makes a pool of local
    processes, or a client of dask that is connected until the block ends. RenderError when that fails."""
    if not options.cluster:
        yield None
        return
    if options.cluster == "local":
        from minirt.cluster.executor import local_pool

        yield local_pool  # it is called when there is work, see `Workers`
        return
    import logging

    from minirt.cluster.executor import DESERTED

    try:
        from distributed import Client
    except ImportError:
        raise RenderError(
            "--cluster with an address needs dask.distributed: install it (pip install 'minirt[cluster]'), or try "
            "--cluster local"
        ) from None
    # Until the program ends these libraries do not log: they would print tracebacks when a scheduler ends. Some of
    # their loggers have levels of their own, so that the level of the first would not do.
    for name in ["asyncio", *logging.root.manager.loggerDict]:
        if name.partition(".")[0] in ("asyncio", "distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    try:
        client = Client(options.cluster, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise RenderError(f"--cluster {options.cluster}: no scheduler answers: {error}") from None
    with client:
        if not client.nthreads():
            # The executor waits for workers when there is work.
            tell(f"notice: {options.cluster} has no workers yet, and is waited for {DESERTED:.0f} s")
        yield client


@contextmanager
def kept_work(job: Job, options: argparse.Namespace, share: Share, has_parts: bool = True) -> Iterator[Journal | None]:
    """Show the progress of the `share` while the block works, and give it the journal of the output, which is deleted
    when the block ends without an error.

    The block gets None in place of a journal for standard output and, without --resume, for less than LONG rays; those
    of "auto" samples count as none, since each depends on those before. `has_parts`: the journal holds what was
    rendered, and not only which pictures of the job are done.
    """
    journal = None
    with ExitStack() as stack:
        if options.output != "-" and (options.resume or share.rays >= LONG):
            work = job.identity(options.turntable, options.bits, options.quality, options.metadata)
            command = shlex.join(["miniRT", *(each for each in options.command if each != "--resume"), "--resume"])
            how = {"again": command, "what": share.what, "resume": options.resume, "has_parts": has_parts}
            journal = stack.enter_context(Journal(options.output, work, **how))
            if options.resume and not journal.places:
                tell(f"notice: there is nothing to go on with, {options.output} is rendered from the beginning")
        elif options.output != "-":  # a journal that is there is of work that nobody goes on with
            file_io.delete(journal_path(options.output))
        stack.enter_context(progress(share.state))
        yield journal


class Share:
    """Share of some work that this program has done: bands or pictures, and rows of the one that is being rendered."""

    def __init__(self, settings: RenderSettings, region: Region, options: argparse.Namespace, is_here: bool) -> None:
        self.settings, self.rows = settings, region.height if is_here else None
        pictures = len(options.frames or range(options.turntable or 1))
        self.rays = 0 if settings.samples == "auto" else region.width * region.height * settings.samples * pictures
        self.what, self.is_film = ("pictures of the film", True) if options.turntable else (BANDS, False)
        self.start = perf_counter()
        self.found: int | None = None
        self.done, self.total = 0, 1

    def note(self, done: int, total: int) -> None:
        """Note how much is done; the first time, what another program has done."""
        self.found = done if self.found is None else self.found
        self.done, self.total = done, total

    def state(self) -> WorkState:
        """Return the share, of the time where that is all that is known, with its name."""
        if self.settings.samples == "auto" and self.total <= 1:
            time = self.settings.time
            return WorkState("sampling", (perf_counter() - self.start) / time if time else None)
        found, what = self.found or 0, f"{self.done} of {self.total} {self.what}"
        bands = 1 if self.is_film else self.total  # of each picture, with about as many rows each
        rows = self.settings.renderer.rows_done(self.rows // bands) if self.rows else 0.0
        return WorkState(what, (self.done - found + rows) / max(1, self.total - found))


def render_picture(job: Job, options: argparse.Namespace, executor: Workers | None, share: Share) -> Outcome | None:
    """Render a picture as the options ask and write the output; print measurements and notices to standard error.

    Return how the goal of "auto" samples was met, None for a number of samples.
    """
    from minirt.rendering.notices import measurements, notices_about

    is_measured = options.verbose and not executor
    if is_measured:
        start = perf_counter()
        job.settings.renderer.prepare(job.scene, job.settings.samples)
        tell(f"kernel ready after {perf_counter() - start:.2f} s")
    with kept_work(job, options, share) as journal:
        how = encoding(job.scene, options.output, options)
        start = perf_counter()
        image = picture_of(job, executor, journal, share.note)
        seconds = perf_counter() - start
        write(image.encode(**how), options.output)
    in_single = not executor and job.settings.precision != "double"
    packing = job.settings.renderer.packing if in_single else None  # knows what single precision may spoil
    for each in notices_about(job.scene, image.array, job.size, packing, job.settings.samples):
        tell(f"notice: {each}")
    if is_measured:
        tell("\n".join(measurements(job.scene, job.size, job.settings, seconds, image.not_finite)))
    return image.reached


def render_film(job: Job, options: argparse.Namespace, executor: Workers | None, share: Share) -> Outcome | None:
    """Render the scene from all around it and write the film, or numbered pictures; return the outcome with the largest
    error, None for a number of samples."""
    from minirt.movie import Film, numbered
    from minirt.viewer.editing.motion import turntable

    wanted = options.frames or range(1, options.turntable + 1)
    views = islice(turntable(job.scene, options.turntable), wanted.start - 1, wanted.stop - 1)
    jobs = [job._replace(scene=view, number=number) for number, view in zip(wanted, views, strict=True)]
    film = Film(options.output, quality=options.quality) if is_film(options) else None
    outcomes = []
    # Numbered pictures are files already: the journal holds only their outcomes. It holds the pictures of a film.
    with kept_work(job, options, share, has_parts=film is not None) as journal:
        if journal and not film:  # a picture whose file is gone is rendered again
            places = journal.places.items()
            journal.places = {n: place for n, place in places if file_io.is_file(numbered(options.output, n))}
        for each, image in results(jobs, executor, journal, share.note, in_order=True):
            outcomes.append(image.reached)
            if film:
                film.add(image)
            elif isinstance(image, Image):  # else the journal has its outcome, and its file is there
                output = str(numbered(options.output, each.number))
                write(image.encode(**encoding(each.scene, output, options)), output)
        if film:
            film.save()
    return max(filter(None, outcomes), key=lambda each: each.error, default=None)


def encoding(scene: Scene, output: str, options: argparse.Namespace) -> dict[str, Any]:
    """Return how the picture of a scene is encoded: the arguments of `Image.encode`. PNG carries scene and settings."""
    name, texts = format_name(output), {}
    if options.metadata and name == "PNG":
        way = files.way_to_scene("" if output == "-" else output, scene.file)
        texts = files.picture_texts(dump(scene), settings_text(options, *(options.size or size_of(scene))), way)
    return {"name": name, "bits": options.bits, "quality": options.quality, "texts": texts}


def is_streamed(options: argparse.Namespace, region: Region) -> bool:
    """Whether a picture is written band by band: as TIFF, where workers render it or memory does not hold it.

    RenderError where memory does not hold a picture of another format, or where the output cannot hold the picture.
    """
    check_output(options.output, region.width, region.height)
    name = format_name(options.output)
    is_light_extra = (options.dither or options.verbose) and not needs_light(options, options.output)
    may_stream = name == "TIFF" and not options.time and not options.turntable
    try:
        bytes_per_pixel = memory_of(name, options.bits) + (LIGHT if is_light_extra else 0)
        system.check_picture(region.height, region.width, bytes_per_pixel)
    except system.TooLargeError:
        if not may_stream:
            raise
        return True
    return may_stream and bool(options.cluster)
