"""Rendering pictures and turntables to a file or to standard output, here or by workers."""

from __future__ import annotations

import argparse
import struct
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from minirt.cli.arguments import FAILED, OK, SAMPLES
from minirt.cli.files import check_output, format_name, is_film, needs_light
from minirt.cli.output import say_bytes, tell
from minirt.cluster.job import Job
from minirt.cluster.journal import Journal, delete, path_for
from minirt.cluster.pictures import frames, picture_of, render_to
from minirt.errors import RenderError
from minirt.formats.table import memory_of
from minirt.helpers import system
from minirt.helpers.progress import State, progress
from minirt.rendering.settings import LIGHT, RenderSettings
from minirt.scene import size_of

if TYPE_CHECKING:
    from minirt.rendering.image import Image
    from minirt.rendering.outcome import Outcome
    from minirt.scene import Scene

LONG = 2**24  # rays: work of about a second of two processors, which an interrupt does not undo
PATIENCE = 10  # seconds for a scheduler to answer
SIZE = struct.Struct("<q")  # of a numbered picture that is written


def render_output(scene: Scene, options: argparse.Namespace) -> int:
    """Render a picture, or the pictures of a turntable, and write the output."""
    job = Job(scene, options.size or size_of(scene), settings_for(options, options.output))
    with system.gc_paused(), workers(options) as executor:
        if options.turntable:
            outcome = render_film(job, options, executor)
        elif is_streamed(job, options):
            outcome = stream(job, options, executor)
        else:
            outcome = render_picture(job, options, options.output, executor)
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


def is_long(job: Job, options: argparse.Namespace, count: int = 1) -> bool:
    """Whether `count` pictures are so much work that it is kept when it is interrupted. Samples that depend on those
    before cannot be gone on with."""
    *_, width, height = job.region
    samples = job.settings.samples
    rays = 0 if samples == "auto" else width * height * samples * count
    return options.output not in (None, "-") and bool(options.resume or rays >= LONG)


@contextmanager
def kept_work(options: argparse.Namespace, work: str | None, what: str) -> Iterator[Journal | None]:
    """Keep what the block puts into the journal of the output, until the block ends without an error.

    `work` tells it from other work, None is work that is not kept. `what` names the records, such as `5 bands`.
    """
    if work is None:
        if options.output not in (None, "-"):
            delete(path_for(options.output))
        yield None
        return
    journal = Journal(options.output, work, options.resume)
    if options.resume and not journal.places:
        tell(f"notice: there is nothing to go on with, {options.output} is rendered from the beginning")
    try:
        yield journal
    except BaseException:
        journal.close()
        if journal.places:
            import shlex

            command = shlex.join([*(each for each in options.command if each != "--resume"), "--resume"])
            tell(f"{len(journal.places)} of {what} are kept; miniRT {command} goes on")
        raise
    journal.remove()


class Share:
    """Share of some work that this program has done: bands or frames, and rows of the one that is being rendered."""

    def __init__(self, settings: RenderSettings, total: int, rows: int | None) -> None:
        """`rows` of each band, None where workers render them."""
        self.settings, self.rows = settings, rows
        self.found: int | None = None
        self.done, self.total = 0, total

    def note(self, done: int, total: int) -> None:
        """Note how much is done; the first time, what another program has done."""
        self.found = done if self.found is None else self.found
        self.done, self.total = done, total

    def __call__(self) -> float:
        """Return the share."""
        found = self.found or 0
        rows = self.settings.renderer.rows_done(self.rows) if self.rows else 0.0
        return (self.done - found + rows) / max(1, self.total - found)


def render_picture(job: Job, options: argparse.Namespace, output: str, executor: Any = None) -> Outcome | None:
    """Render a picture as the options ask and write the output; print measurements and notices to standard error."""
    from minirt.rendering.notices import notices_about

    scene, size, settings = job
    check_job(job, options, output)
    start = perf_counter()
    if options.verbose and not executor:
        settings.renderer.prepare(scene)
        tell(f"kernel ready after {perf_counter() - start:.2f} s")
        start = perf_counter()
    is_kept = is_long(job, options)
    bands = job.cut(bool(executor), is_kept)
    share = Share(settings, len(bands), None if executor else job.region.height)

    def state() -> State:
        if executor:
            return State(f"{share.done} of {share.total} bands", share())
        if settings.samples != "auto":
            return State(output, share())
        return State("sampling", (perf_counter() - start) / settings.time if settings.time else None)

    work = work_for(job, options) if is_kept else None
    with kept_work(options, work, f"{len(bands)} bands of the picture") as journal:
        with progress(state):
            image, not_finite = picture_of(bands, executor, journal, share.note)
        tell_outcome(image.reached)
        seconds = perf_counter() - start
        notices = notices_about(scene, size, settings, image, options.verbose and not executor)
        if not executor:
            for each in notices.lost:
                tell(f"notice: {each}")
            if options.verbose:
                tell_measurements(options, size, settings, seconds, not_finite)
                tell(notices.clipped)
        if notices.view:
            tell(f"notice: {notices.view}")
        write(image, output, scene, options)
    return image.reached


def work_for(job: Job, options: argparse.Namespace) -> str:
    """Return what tells the work from others: a hash of all that the output depends on."""
    return job.work(options.turntable, options.bits, options.quality, options.metadata)


def tell_outcome(reached: Outcome | None) -> None:
    """Tell the error that a picture, or the worst of a film, has reached."""
    if reached:
        tell(reached)
        if reached.notice:
            tell(f"notice: {reached.notice}")


def tell_measurements(
    options: argparse.Namespace, size: tuple[int, int], settings: RenderSettings, seconds: float, not_finite: int
) -> None:
    """Tell the time of a picture that was rendered here, and how its scene was packed."""
    renderer = settings.renderer
    place = f"region {options.region}, " if options.region else ""
    sampling = "" if settings.samples == "auto" else f"{settings.samples} samples a pixel, "
    threads = f"{renderer.threads} threads, {renderer.precision} precision"
    tell(f"{size[0]}x{size[1]}, {place}{sampling}{threads}: {seconds * 1e3:.1f} ms")
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


def stream(job: Job, options: argparse.Namespace, executor: Any) -> Outcome | None:
    """Render a picture of any size into a TIFF file, which goes on with what was interrupted."""
    scene, size, settings = job
    share = Share(settings, 0, None if executor else job.region.height)
    how = {name: getattr(settings, name) for name in ("samples", "error", "threads", "precision", "depth", "dither")}
    how |= {"bits": options.bits or 8, "region": options.region}
    try:
        with progress(lambda: State(f"{share.done} of {share.total} bands", share() if share.total else None)):
            reached = render_to(options.output, scene, *size, executor=executor, on_progress=share.note, **how)
    except KeyboardInterrupt:
        tell(f"{share.done} of {share.total} bands are kept; the same command goes on")
        raise
    tell_outcome(reached)
    return reached


def render_film(job: Job, options: argparse.Namespace, executor: Any) -> Outcome | None:
    """Render the scene from all around it and write the film; return the worst outcome of a frame."""
    check_job(job, options, options.output)
    wanted = options.frames or range(1, options.turntable + 1)
    work = work_for(job, options) if is_long(job, options, len(wanted)) else None
    with kept_work(options, work, f"{len(wanted)} pictures of the film") as journal:
        film = Film(job, options, wanted, executor, journal)
        with progress(film.state):
            if is_film(options):
                from minirt.movie import save_movie

                save_movie(film.images(), options.output, quality=options.quality)
            else:
                deque(film.images(), 0)
    worst = max(film.outcomes, key=lambda each: each.error, default=None)
    tell_outcome(worst)
    return worst


class Film:
    """The pictures of a turntable, each rendered, or kept by a program that was interrupted."""

    def __init__(
        self, job: Job, options: argparse.Namespace, wanted: range, executor: Any, journal: Journal | None
    ) -> None:
        from minirt.viewer.app.replay import turntable

        views = islice(turntable(job.scene, options.turntable), wanted.start - 1, wanted.stop - 1)
        self.views = dict(zip(wanted, views, strict=True))
        self.options = options
        self.journal = journal
        *_, width, height = job.region
        self.shape = height, width, 3
        self.kept = {number for number in wanted if self.is_kept(number)}
        missing = [view for number, view in self.views.items() if number not in self.kept]
        self.pictures = frames(missing, job.size, job.settings, executor)
        self.share = Share(job.settings, len(wanted), None if executor else height)
        self.share.note(len(self.kept), len(wanted))
        self.current = wanted.start
        self.outcomes: list[Outcome] = []

    def file(self, number: int) -> Path:
        """Return the path of a numbered picture."""
        from minirt.movie import numbered

        return numbered(Path(self.options.output), number)

    def is_kept(self, number: int) -> bool:
        """Whether an interrupted program has left a picture."""
        if not self.journal:
            return False
        if is_film(self.options):
            return self.journal.restore(number, self.shape) is not None
        size, file = self.journal.read(number), self.file(number)
        return size is not None and file.is_file() and SIZE.pack(file.stat().st_size) == size

    def state(self) -> State:
        """Return how far this program is."""
        return State(f"picture {self.current} of {self.options.turntable}", self.share())

    def images(self) -> Iterator[Image]:
        """Yield the pictures of a film of one file, or write numbered pictures; the journal keeps what was rendered."""
        from minirt.cluster.job import Made, image_of

        for number, view in self.views.items():
            self.current = number
            if number in self.kept:
                if self.journal and is_film(self.options) and (made := self.journal.restore(number, self.shape)):
                    yield image_of(made, view.camera.tone)
                continue
            start = perf_counter()
            image = next(self.pictures)
            self.outcomes += [image.reached] if image.reached else []
            if is_film(self.options):
                data: bytes | Made = Made((image.array,), image.reached)
            else:
                write(image, str(self.file(number)), view, self.options)
                data = SIZE.pack(self.file(number).stat().st_size)
            if self.journal:
                self.journal.offer(number, data, perf_counter() - start)
            yield image
            self.share.done += 1


def settings_for(options: argparse.Namespace, output: str) -> RenderSettings:
    """Return the settings of a picture that goes to an output."""
    names = "error", "time", "threads", "precision", "depth", "dither", "region"
    given = {name: getattr(options, name) for name in names}
    return RenderSettings(options.samples or SAMPLES, linear=needs_light(options, output), **given)


def is_streamed(job: Job, options: argparse.Namespace) -> bool:
    """Whether a picture is written as its bands come: by workers or beyond memory, as TIFF."""
    if format_name(options.output) != "TIFF" or options.time:
        return False
    try:
        check_job(job, options, options.output)
    except system.TooLargeError:
        return True
    return bool(options.cluster)


def check_job(job: Job, options: argparse.Namespace, output: str) -> None:
    """Check that there is memory to render and write a picture, and that the output can hold it; RenderError
    otherwise."""
    *_, width, height = job.region
    check_output(output, width, height)
    is_light_extra = (options.dither or options.verbose) and not job.settings.linear
    needed = memory_of(format_name(output), options.bits) + LIGHT * is_light_extra
    system.check_picture(height, width, needed)
