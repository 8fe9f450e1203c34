"""Generate a report: run all measurements and write the results into a folder, also when the user interrupts them."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from minirt.errors import RenderError
from minirt.report.formulas import formula_names, formula_rows
from minirt.report.interruption import sigterm_interrupts
from minirt.report.measure import Measurement
from minirt.report.measurements import formula_errors
from minirt.report.measurements.durations import formula_steps
from minirt.report.measurements.plan import FULL, QUICK
from minirt.report.output.document import summary
from minirt.report.output.files import FORMULAS, PAGE, formula_files, report_files, write_files
from minirt.report.progress import progress
from minirt.report.temporary_folder import temporary_folder
from minirt.scene import Scene
from minirt.shapes import KINDS

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
    own. Ctrl+C and SIGTERM end the measurements: what was measured until then is written, standard error says so, and
    KeyboardInterrupt is raised. RenderError if the scene has no shapes or a file cannot be written.
    """
    if not scene.shapes:
        raise RenderError(f"{name}: a scene without shapes has no errors to report")
    make_folder(folder)
    with sigterm_interrupts(), temporary_folder() as files, progress() as shown:
        measurement = Measurement(scene, name, QUICK if quick else FULL, threads, shown)
        try:
            measurement.run(size, files, ablation)
        except KeyboardInterrupt:
            shown.clear()
            tell(write_report(measurement, folder, interrupted(shown.what)) or NOTHING)
            raise
        return write_report(measurement, folder)


def write_report(measurement: Measurement, folder: str | os.PathLike[str], interrupted: str = "") -> str:
    """Write the files of a report, and return its summary; nothing if no picture was measured."""
    found = measurement.findings(interrupted)
    if not (found and measurement.reference):
        return ""
    write_files(folder, report_files(found, measurement.pictures, measurement.reference.picture))
    return f"{summary(found)}\nThe report is in {Path(folder, PAGE)}"


def report_formulas(folder: str | os.PathLike[str], quick: bool) -> None:
    """Write the accuracy and cost of the intersection formulas of all shape types into a folder.

    Ctrl+C and SIGTERM act as in `report`.
    """
    make_folder(folder)
    plan, rows = QUICK if quick else FULL, list[formula_errors.Row]()
    with sigterm_interrupts(), progress() as shown:
        shown.expect(formula_steps(formula_names(KINDS), plan))
        try:
            rows.extend(formula_rows(KINDS, plan, shown.step))
        except KeyboardInterrupt:
            shown.clear()
            tell(write_formulas(rows, folder, interrupted(shown.what)) or NOTHING)
            raise
        write_formulas(rows, folder)


def write_formulas(rows: list[formula_errors.Row], folder: str | os.PathLike[str], interrupted: str = "") -> str:
    """Write the files about formulas, and return where they are; nothing if no formula was measured."""
    if not rows:
        return ""
    write_files(folder, formula_files(rows, interrupted))
    return f"{interrupted}\nThe report is in {Path(folder, FORMULAS)}"


def interrupted(step: str) -> str:
    """Say what an interrupt during a step leaves out."""
    return f"Interrupted while measuring {step}: this and all that would have followed is missing."


def tell(words: str) -> None:
    """Tell the user on standard error, as standard output is for complete reports."""
    print(words, file=sys.stderr, flush=True)


def make_folder(folder: str | os.PathLike[str]) -> None:
    """Create the folder before the measurements begin, so that a wrong path fails at once. RenderError."""
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RenderError(f"{os.fspath(folder)}: cannot be made: {error.strerror or error}") from None
