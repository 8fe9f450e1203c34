"""Rendering pictures and turntables to a file or to standard output, here or by workers."""

from __future__ import annotations

import argparse
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from itertools import islice
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from minirt.cli.arguments import FAILED, OK, SAMPLES
from minirt.cli.files import check_output, format_name, is_film, needs_light
from minirt.cli.output import say_bytes, tell
from minirt.cluster.job import Band, Job, image_of
from minirt.cluster.journal import Journal, delete, path_for
from minirt.cluster.pictures import picture_of, results, stream
from minirt.errors import RenderError
from minirt.formats.table import memory_of
from minirt.helpers import system
from minirt.helpers.progress import State, progress
from minirt.rendering.packing.camera import Region
from minirt.rendering.settings import LIGHT, RenderSettings
from minirt.scene import size_of

if TYPE_CHECKING:
    from minirt.cluster.executor import Workers
    from minirt.rendering.image import Image
    from minirt.rendering.outcome import Outcome
    from minirt.scene import Scene

LONG = 2**24  # rays: work of about a second of two processors, which an interrupt does not undo
PATIENCE = 10  # seconds for a scheduler to answer


def render_output(scene: Scene, options: argparse.Namespace) -> int:
    """Render a picture, or the pictures of a turntable, and write the output."""
    job = Job(scene, options.size or size_of(scene), settings_for(options))
    render = stream_picture if is_streamed(job, options) else render_film if options.turntable else render_picture
    with system.gc_paused(), workers(options) as executor:
        outcome = render(job, options, executor)
    return FAILED if options.strict and outcome and not outcome.is_reached else OK


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
    job: Job, options: argparse.Namespace, share: Share, what: str, count: int = 1, has_parts: bool = True
) -> Iterator[Journal | None]:
    """Keep what the block puts into the journal of the output, until the block ends without an error.

    Short work is not kept, and neither are samples that depend on those before. `what` names the `count` pictures or
    the bands of one.
    """
    *_, width, height = job.region
    rays = 0 if job.settings.samples == "auto" else width * height * job.settings.samples * count
    if options.output == "-" or not (options.resume or rays >= LONG):
        if options.output != "-":
            delete(path_for(options.output))
        yield None
        return
    work = job.work(options.turntable, options.bits, options.quality, options.metadata)
    journal = Journal(options.output, work, options.resume, has_parts=has_parts)
    if options.resume and not journal.places:
        tell(f"notice: there is nothing to go on with, {options.output} is rendered from the beginning")
    try:
        yield journal
    except BaseException:
        journal.close()
        if journal.places:
            import shlex

            command = shlex.join([*(each for each in options.command if each != "--resume"), "--resume"])
            tell(f"{len(journal.places)} of {share.total} {what} are kept; miniRT {command} goes on")
        raise
    journal.remove()


class Share:
    """Share of some work that this program has done: bands or frames, and rows of the one that is being rendered."""

    def __init__(self, job: Job, executor: Workers | None) -> None:
        self.renderer, self.rows = job.settings.renderer, None if executor else job.region.height
        self.found: int | None = None
        self.done, self.total = 0, 0

    def note(self, done: int, total: int) -> None:
        """Note how much is done; the first time, what another program has done."""
        self.found = done if self.found is None else self.found
        self.done, self.total = done, total

    def state(self, what: str) -> State:
        """Return the share with its name."""
        found = self.found or 0
        rows = self.renderer.rows_done(self.rows) if self.rows else 0.0
        return State(what, (self.done - found + rows) / max(1, self.total - found))

    def of_bands(self) -> State:
        """Return the share with the number of bands."""
        return self.state(f"{self.done} of {self.total} bands")


def render_picture(job: Job, options: argparse.Namespace, executor: Workers | None) -> Outcome | None:
    """Render a picture as the options ask and write the output; print measurements and notices to standard error."""
    from minirt.rendering.notices import notices_about

    scene, size, settings = job
    start = perf_counter()
    if options.verbose and not executor:
        settings.renderer.prepare(scene)
        tell(f"kernel ready after {perf_counter() - start:.2f} s")
        start = perf_counter()
    share = Share(job, executor)

    def state() -> State:
        if executor:
            return share.of_bands()
        if settings.samples != "auto":
            return share.state(options.output)
        return State("sampling", (perf_counter() - start) / settings.time if settings.time else None)

    with kept_work(job, options, share, "bands of the picture") as journal:
        bands = job.cut(bool(executor), journal is not None)
        with progress(state):
            image, not_finite = picture_of(job, bands, executor, journal, share.note)
        tell_outcome(image.reached)
        seconds = perf_counter() - start
        notices = notices_about(scene, size, settings, image, options.verbose and not executor)
        if not executor:
            for each in notices.lost:
                tell(f"notice: {each}")
            if options.verbose:
                tell_measurements(job, seconds, not_finite)
                tell(notices.clipped)
        if notices.view:
            tell(f"notice: {notices.view}")
        write(image, options.output, scene, options)
    return image.reached


def render_film(job: Job, options: argparse.Namespace, executor: Workers | None) -> Outcome | None:
    """Render the scene from all around it and write the film, or numbered pictures; return the worst outcome."""
    from minirt.movie import numbered, save_movie
    from minirt.viewer.app.replay import turntable

    wanted = options.frames or range(1, options.turntable + 1)
    views = islice(turntable(job.scene, options.turntable), wanted.start - 1, wanted.stop - 1)
    bands = [Band(number, view, job.size, job.settings) for number, view in zip(wanted, views, strict=True)]
    file, outcomes, share = partial(numbered, Path(options.output)), [], Share(job, executor)

    def images(journal: Journal | None) -> Iterator[Image]:
        for band, made in results(bands, executor, journal, share.note, in_order=True):
            outcomes.append(made.reached)
            if made.parts:
                image = image_of(band, made)
                if not is_film(options):
                    write(image, str(file(band.number)), band.scene, options)
                yield image

    def state() -> State:
        return share.state(f"picture {min(wanted.start + share.done, wanted[-1])} of {options.turntable}")

    kept = kept_work(job, options, share, "pictures of the film", len(wanted), has_parts=is_film(options))
    with kept as journal, progress(state):
        if is_film(options):
            save_movie(images(journal), options.output, quality=options.quality)
        else:
            if journal:
                journal.places = {number: each for number, each in journal.places.items() if file(number).is_file()}
            deque(images(journal), 0)
    worst = max(filter(None, outcomes), key=lambda each: each.error, default=None)
    tell_outcome(worst)
    return worst


def stream_picture(job: Job, options: argparse.Namespace, executor: Workers | None) -> Outcome | None:
    """Render a picture of any size into a TIFF file, which goes on with what was interrupted."""
    share = Share(job, executor)
    try:
        with progress(share.of_bands):
            reached = stream(options.output, job, options.bits or 8, executor, share.note)
    except KeyboardInterrupt:
        tell(f"{share.done} of {share.total} bands are kept; the same command goes on")
        raise
    tell_outcome(reached)
    return reached


def tell_outcome(reached: Outcome | None) -> None:
    """Tell the error that a picture, or the worst of a film, has reached."""
    if reached:
        tell(reached)
        if reached.notice:
            tell(f"notice: {reached.notice}")


def tell_measurements(job: Job, seconds: float, not_finite: int) -> None:
    """Tell the time of a picture that was rendered here, and how its scene was packed."""
    (width, height), settings = job.size, job.settings
    renderer = settings.renderer
    place = f"region {','.join(map(str, settings.region))}, " if settings.region else ""
    sampling = "" if settings.samples == "auto" else f"{settings.samples} samples a pixel, "
    threads = f"{renderer.threads} threads, {renderer.precision} precision"
    tell(f"{width}x{height}, {place}{sampling}{threads}: {seconds * 1e3:.1f} ms")
    tell(f"rays whose light is not finite: {not_finite}")
    for note in renderer.notes:  # of the whole picture, since the light that is clipped was rendered
        tell(note)


def write(image: Image, output: str, scene: Scene, options: argparse.Namespace) -> None:
    """Write a picture to a file, or to standard output as PNG when `output` is `-`; PNG carries scene and settings."""
    texts = texts_for(output, scene, options) if options.metadata else {}
    if output == "-":
        say_bytes(image.encode(bits=options.bits, quality=options.quality, texts=texts))
        return
    image.save(output, bits=options.bits, quality=options.quality, texts=texts)


def texts_for(output: str, scene: Scene, options: argparse.Namespace) -> dict[str, str]:
    """Return the texts that a picture of the scene carries."""
    from minirt.cli.options import settings_text
    from minirt.scene import dump, files

    width, height = options.size or size_of(scene)
    way = files.way_to_scene("" if output == "-" else output, scene.file)
    return files.picture_texts(dump(scene), settings_text(options, width, height), way)


def settings_for(options: argparse.Namespace) -> RenderSettings:
    """Return the settings of a picture that goes to the output."""
    given = {name: getattr(options, name) for name in ("error", "time", "threads", "precision", "depth", "dither")}
    region, linear = options.region and Region(*options.region), needs_light(options, options.output)
    return RenderSettings(options.samples or SAMPLES, linear=linear, region=region, **given)


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
