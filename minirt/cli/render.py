"""Rendering pictures and turntables to a file or to standard output, here or by workers."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from time import perf_counter
from typing import TYPE_CHECKING, Any

from minirt.cli.arguments import FAILED, OK, SAMPLES
from minirt.cli.files import check_output, format_name, is_film, needs_light
from minirt.cli.output import say, tell
from minirt.cluster.job import Job
from minirt.cluster.journal import Journal, delete, path_for
from minirt.cluster.pictures import picture_of, results, stream
from minirt.errors import RenderError
from minirt.formats.table import memory_of
from minirt.helpers import system
from minirt.helpers.progress import State, progress
from minirt.rendering.settings import LIGHT, RenderSettings
from minirt.scene import size_of

if TYPE_CHECKING:
    from minirt.cluster.executor import Workers
    from minirt.rendering.image import Image
    from minirt.rendering.outcome import Outcome
    from minirt.scene import Scene

LONG = 2**24  # rays: work of about a second of two processors, which an interrupt does not undo
GIVEN = ("error", "time", "threads", "precision", "depth", "dither", "region")  # options that are settings
BANDS = "bands of the picture"
PATIENCE = 10  # seconds for a scheduler to answer


def render_output(scene: Scene, options: argparse.Namespace) -> int:
    """Render a picture, or the pictures of a turntable, and write the output."""
    job = Job(scene, options.size or size_of(scene), settings_for(options))
    render = stream_picture if is_streamed(job, options) else render_film if options.turntable else render_picture
    with system.gc_paused(), workers(options) as executor:
        reached = render(job, options, executor)
    if reached:
        tell(reached)
        if reached.notice:
            tell(f"notice: {reached.notice}")
    return FAILED if options.strict and reached and not reached.is_reached else OK


@contextmanager
def workers(options: argparse.Namespace) -> Iterator[Any]:
    """Connect to the workers that the options name, None for this process; RenderError when that fails."""
    if not options.cluster:
        yield None
        return
    if options.cluster == "local":
        from minirt.cluster.executor import local_pool

        yield local_pool
        return
    import logging

    try:
        from distributed import Client
    except ImportError:
        raise RenderError(
            "--cluster with an address needs dask.distributed: install it (pip install 'minirt[cluster]'), or try "
            "--cluster local"
        ) from None
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    try:
        client = Client(options.cluster, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise RenderError(f"--cluster {options.cluster}: no scheduler answers: {error}") from None
    with client:
        if not client.nthreads():
            tell(f"notice: the cluster at {options.cluster} has no workers yet")
        yield client


@contextmanager
def kept_work(
    job: Job, options: argparse.Namespace, share: Share, count: int = 1, has_parts: bool = True
) -> Iterator[Journal | None]:
    """Show progress, and keep what the block puts into the journal of the output, until it ends without an error.

    Short work is not kept, and neither are samples that depend on those before. There are `count` pictures.
    """
    *_, width, height = job.region
    rays = 0 if job.settings.samples == "auto" else width * height * job.settings.samples * count
    if options.output == "-" or not (options.resume or rays >= LONG):
        if options.output != "-":
            delete(path_for(options.output))
        with progress(share.state):
            yield None
        return
    work = job.work(options.turntable, options.bits, options.quality, options.metadata)
    journal = Journal(options.output, work, options.resume, has_parts=has_parts)
    if options.resume and not journal.places:
        tell(f"notice: there is nothing to go on with, {options.output} is rendered from the beginning")
    try:
        with progress(share.state):
            yield journal
    except BaseException:
        journal.close()
        if journal.places:
            import shlex

            command = shlex.join([*(each for each in options.command if each != "--resume"), "--resume"])
            tell(f"{len(journal.places)} of {share.total} {share.what} are kept; miniRT {command} goes on")
        raise
    journal.remove()


class Share:
    """Share of some work that this program has done: bands or pictures, and rows of the one that is being rendered."""

    def __init__(self, job: Job, executor: Workers | None, what: str) -> None:
        self.settings, self.rows = job.settings, None if executor else job.region.height
        self.what, self.start = what, perf_counter()
        self.found: int | None = None
        self.done, self.total = 0, 0

    def note(self, done: int, total: int) -> None:
        """Note how much is done; the first time, what another program has done."""
        self.found = done if self.found is None else self.found
        self.done, self.total = done, total

    def state(self) -> State:
        """Return the share, of the time where that is all that is known, with its name."""
        if self.settings.samples == "auto" and self.total <= 1:
            time = self.settings.time
            return State("sampling", (perf_counter() - self.start) / time if time else None)
        found, what = self.found or 0, f"{self.done} of {self.total} {self.what}"
        rows = self.settings.renderer.rows_done(self.rows) if self.rows else 0.0
        return State(what, (self.done - found + rows) / max(1, self.total - found))


def render_picture(job: Job, options: argparse.Namespace, executor: Workers | None) -> Outcome | None:
    """Render a picture as the options ask and write the output; print measurements and notices to standard error."""
    from minirt.rendering.notices import measurements, notices_about

    is_measured = options.verbose and not executor
    if is_measured:
        start = perf_counter()
        job.settings.renderer.prepare(job.scene)
        tell(f"kernel ready after {perf_counter() - start:.2f} s")
    share = Share(job, executor, BANDS)
    with kept_work(job, options, share) as journal:
        made = picture_of(job, job.cut(bool(executor), journal is not None), executor, journal, share.note)
        seconds, image = perf_counter() - share.start, made.image(job.scene)
        write(image, options.output, job.scene, options)
    for each in measurements(*job[:3], seconds, made.not_finite) if is_measured else ():
        tell(each)
    for each in notices_about(*job[:3], image, is_here=not executor):
        tell(f"notice: {each}")
    return made.reached


def render_film(job: Job, options: argparse.Namespace, executor: Workers | None) -> Outcome | None:
    """Render the scene from all around it and write the film, or numbered pictures; return the worst outcome."""
    from minirt.movie import Film, numbered
    from minirt.viewer.app.replay import turntable

    wanted = options.frames or range(1, options.turntable + 1)
    views = islice(turntable(job.scene, options.turntable), wanted.start - 1, wanted.stop - 1)
    bands = [job._replace(scene=view, number=number) for number, view in zip(wanted, views, strict=True)]
    film = Film(options.output, quality=options.quality) if is_film(options) else None
    outcomes, share = [], Share(job, executor, "pictures of the film")
    with kept_work(job, options, share, len(wanted), has_parts=film is not None) as journal:
        if journal and not film:
            places = journal.places.items()
            journal.places = {number: each for number, each in places if numbered(options.output, number).is_file()}
        for band, made in results(bands, executor, journal, share.note, in_order=True):
            outcomes.append(made.reached)
            if film:
                film.add(made.image(band.scene))
            elif made.parts:
                write(made.image(band.scene), str(numbered(options.output, band.number)), band.scene, options)
        if film:
            film.save()
    return max(filter(None, outcomes), key=lambda each: each.error, default=None)


def stream_picture(job: Job, options: argparse.Namespace, executor: Workers | None) -> Outcome | None:
    """Render a picture of any size into a TIFF file, which goes on with what was interrupted."""
    share = Share(job, executor, BANDS)
    try:
        with progress(share.state):
            return stream(options.output, job, options.bits or 8, executor, share.note)
    except KeyboardInterrupt:
        tell(f"{share.done} of {share.total} {BANDS} are kept; the same command goes on")
        raise


def write(image: Image, output: str, scene: Scene, options: argparse.Namespace) -> None:
    """Write a picture to a file, or to standard output as PNG when `output` is `-`; PNG carries scene and settings."""
    texts = {}
    if options.metadata:
        from minirt.cli.options import settings_text
        from minirt.scene import dump, files

        way = files.way_to_scene("" if output == "-" else output, scene.file)
        texts = files.picture_texts(dump(scene), settings_text(options, *(options.size or size_of(scene))), way)
    how: dict[str, Any] = {"bits": options.bits, "quality": options.quality, "texts": texts}
    if output == "-":
        say(image.encode(**how))
    else:
        image.save(output, **how)


def settings_for(options: argparse.Namespace) -> RenderSettings:
    """Return the settings of a picture that goes to the output."""
    given = {name: getattr(options, name) for name in GIVEN}
    return RenderSettings(options.samples or SAMPLES, linear=needs_light(options, options.output), **given)


def is_streamed(job: Job, options: argparse.Namespace) -> bool:
    """Whether a picture is written as its bands come: by workers or beyond memory, as TIFF.

    RenderError where there is no memory for another, or where the output cannot hold it.
    """
    *_, width, height = job.region
    check_output(options.output, width, height)
    name = format_name(options.output)
    is_light_extra = (options.dither or options.verbose) and not job.settings.linear
    may_stream = name == "TIFF" and not options.time and not options.turntable
    try:
        system.check_picture(height, width, memory_of(name, options.bits) + LIGHT * is_light_extra)
    except system.TooLargeError:
        if not may_stream:
            raise
        return True
    return may_stream and bool(options.cluster)
