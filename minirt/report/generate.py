"""Generate a report: run all measurements and write the results into a folder, also when the user interrupts them."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from minirt.errors import RenderError
from minirt.helpers.progress import progress
from minirt.report.chart import require_matplotlib
from minirt.report.document import PAGE, summary, write_files
from minirt.report.measure import FULL, QUICK, Measurement
from minirt.scene import Scene

NOTHING = "Interrupted before anything was measured; no report was written."


def report(
    scene: Scene,
    name: str,
    folder: str | os.PathLike[str],
    size: tuple[int, int],
    threads: int | None,
    quick: bool,
    ablation: bool = False,
) -> str:
    """Write the report of a scene into a folder, which is created if needed, and return a summary of it.

    With `ablation` it tells what each absent feature and kind of shape would cost, each of which needs a kernel of its
    own. KeyboardInterrupt ends the measurements: what was measured until then is written, standard error says so, and
    it is raised again. RenderError if the scene has no shapes, matplotlib is missing or a file cannot be written.
    """
    if not scene.shapes:
        raise RenderError(f"{name}: a scene without shapes has no errors to report")
    require_matplotlib()
    make_folder(folder)
    measurement = Measurement(scene, name, QUICK if quick else FULL, threads)
    try:
        with TemporaryDirectory(prefix="minirt-report-") as files, progress(measurement.state):
            measurement.run(size, Path(files), ablation)
    except KeyboardInterrupt:
        missing = f"Interrupted while measuring {measurement.what}: this and all that would have followed is missing."
        print(write_report(measurement, folder, missing) or NOTHING, file=sys.stderr, flush=True)
        raise
    return write_report(measurement, folder)


def write_report(measurement: Measurement, folder: str | os.PathLike[str], interrupted: str = "") -> str:
    """Write the files of a report, and return its summary; nothing if no picture was measured."""
    found = measurement.findings(interrupted)
    if not (found and measurement.reference):
        return ""
    write_files(folder, found, measurement.pictures, measurement.reference.picture)
    return f"{summary(found)}\nThe report is in {Path(folder, PAGE)}"


def make_folder(folder: str | os.PathLike[str]) -> None:
    """Create the folder before the measurements begin, so that a wrong path fails at once. RenderError."""
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RenderError(f"{os.fspath(folder)}: cannot be made: {error.strerror or error}") from None
