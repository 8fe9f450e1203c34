"""Rendering by several processes of this machine, or by the workers of a dask cluster."""

from __future__ import annotations

import argparse
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from minirt.cli.arguments import FAILED, OK, SAMPLES
from minirt.cli.output import tell
from minirt.cli.picture import write
from minirt.cli.target import check_region, needs_light
from minirt.errors import RenderError
from minirt.helpers.progress import State, progress

if TYPE_CHECKING:
    from minirt.rendering.outcome import Outcome
    from minirt.scene import Scene

LOCAL = "local"
MOST_PROCESSES = 8  # on this machine; each has its share of the processors
PATIENCE = 10  # seconds for a scheduler to answer


@contextmanager
def workers(options: argparse.Namespace) -> Iterator[Any]:
    """Connect to the workers that the options name, None for this process; RenderError when that fails."""
    if not options.cluster:
        yield None
        return
    if options.cluster == LOCAL:
        yield pool
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


def pool() -> Executor:
    """Return a pool of processes that leave Ctrl+C to this one, and end with it."""
    from multiprocessing import get_context

    from minirt.rendering.threads import usable_cores

    return ProcessPoolExecutor(min(usable_cores(), MOST_PROCESSES), get_context("spawn"), serve)


def serve() -> None:
    """Prepare a process of the pool: it ignores Ctrl+C, which a terminal sends to all, and ends when its parent dies.

    Otherwise the processes of a killed program would wait for tasks for ever.
    """
    from threading import Thread

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=end_with_parent, daemon=True).start()


def end_with_parent() -> None:
    """Wait until the parent of this process has died, and end it at once."""
    from multiprocessing import parent_process

    if parent := parent_process():
        parent.join()
        os._exit(FAILED)


def render_bands(scene: Scene, options: argparse.Namespace) -> int:
    """Render the scene in bands and write the picture: a TIFF file as they come, any other from memory."""
    import minirt
    from minirt.cluster.in_memory import render_in_bands
    from minirt.cluster.task import Settings
    from minirt.formats.table import format_of

    width, height = options.size or minirt.size_of(scene)
    check_region(options, options.output, width, height)
    done, bands = 0, 0

    def on_progress(*numbers: int) -> None:
        nonlocal done, bands
        done, bands = numbers

    def state() -> State:
        return State(
            f"{done} of {bands} bands" if bands else options.cluster or "bands", done / bands if bands else None
        )

    how: dict[str, Any] = {"precision": options.precision, "depth": options.depth, "dither": options.dither}
    how |= {"samples": options.samples or SAMPLES, "error": options.error}
    where: dict[str, Any] = {"threads": options.threads, "region": options.region, "on_progress": on_progress}
    is_tiff = options.output != "-" and format_of(options.output) == "TIFF"
    with kept_bands(lambda: f"{done} of {bands}", is_tiff), progress(state), workers(options) as executor:
        if is_tiff:
            how |= {"bits": options.bits or 8}
            reached = minirt.render_to(options.output, scene, width, height, executor=executor, **how, **where)
        else:
            linear = needs_light(options, options.output)
            settings = Settings(width, height, **how)
            try:
                image = render_in_bands(scene, settings, executor, linear=linear, **where)
                write(image, options.output, scene, options)
            except MemoryError:
                message = f"{width}x{height} pixels do not fit into memory, a .tif file needs no more than a few bands"
                raise RenderError(f"{options.output}: {message}") from None
            reached = image.reached
    return status(reached, options)


@contextmanager
def kept_bands(share: Callable[[], str], is_kept: bool) -> Iterator[None]:
    """Say after an interrupt how many bands are kept."""
    try:
        yield
    except KeyboardInterrupt:
        if is_kept:
            tell(f"{share()} bands are kept; the same command goes on")
        raise


def status(reached: Outcome | None, options: argparse.Namespace) -> int:
    """Tell the error that a picture, or the worst of a film, has reached, and return the exit status."""
    if reached:
        tell(reached)
        if reached.notice:
            tell(f"notice: {reached.notice}")
    return FAILED if options.strict and reached and not reached.is_reached else OK
