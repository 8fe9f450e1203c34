"""Streams a picture of any size into a BigTIFF file, band by band, and goes on where an earlier run was killed."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Literal

from minirt.cluster.bands import whole
from minirt.cluster.output import Output
from minirt.cluster.still import Still, size_for
from minirt.cluster.task import Region, Settings, Task
from minirt.cluster.workers import WorkerPool, Workers
from minirt.errors import RenderError
from minirt.formats.table import check_bits, check_size, format_of
from minirt.helpers import file_io
from minirt.rendering.outcome import Outcome
from minirt.scene import Scene
from minirt.scene.scene import check_scene


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
    region: Region | None = None,
    on_progress: Callable[[int, int], object] = lambda done, bands: None,
) -> Outcome | None:
    """Render a picture of any size into a TIFF file, with a few bands of rows in memory at a time.

    `executor` is an executor of `concurrent.futures`, a function that makes one, or a client of dask.distributed;
    without one this process renders. The pixels are those of `minirt.render`, whoever renders a band. The file is
    complete or absent: until then `NAME.part` grows, and `NAME.journal` lists what is in it. The same call after an
    interruption goes on with the missing bands.

    With `samples` "auto" each band is rendered until its estimated error is at most `error`; then that of the whole
    picture is, too, since its square is the mean of theirs. The result is the whole picture's. `on_progress` gets the
    number of bands that are done, and of all. RenderError when rendering or writing fails.
    """
    check_scene(scene, "render_to")
    name = format_of(path)
    if name != "TIFF":
        raise RenderError(f"{os.fspath(path)}: render_to writes TIFF, try {Path(path).stem}.tif")
    check_bits(name, bits)
    settings = Settings(*size_for(scene, width, height), samples, error, None, precision, depth, dither)
    check_size(path, name, settings.width, settings.height)
    still = Still(scene, settings, region, f"strips-{bits}")
    try:
        file_io.probe(path)
        with Output(Path(path), key_of(still.task), still.bands) as output:
            on_progress(len(output.bands), len(still.bands))
            for band, made in still.made(WorkerPool(executor, threads), output.bands.keys()):
                output.add(band, made)
                on_progress(len(output.bands), len(still.bands))
            output.finish(*still.region[2:], bits)
    except OSError as reason:
        raise RenderError(f"{os.fspath(path)}: cannot write: {reason.strerror or reason}") from None
    return whole([(rows, output.bands[number].outcome) for number, (*_, rows) in enumerate(still.bands)])


def key_of(task: Task) -> str:
    """Return what tells a picture from others: a hash of its scene, settings and version."""
    return hashlib.sha256(repr(task._replace(files=())).encode()).hexdigest()
