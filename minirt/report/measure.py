"""Generate a report: measure a scene and write the results into a folder, also when the user interrupts it."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from math import ceil, log2
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from minirt.errors import RenderError
from minirt.helpers.progress import State, progress
from minirt.helpers.system import runs
from minirt.rendering import Renderer
from minirt.rendering.notes import kernel_notes
from minirt.rendering.queries.stiffness import coincident, stiff_shapes
from minirt.rendering.threads import usable_cores
from minirt.report import povray
from minirt.report.ablation import PAIRS, Ablation, Part
from minirt.report.document import PAGE, summary, write_files
from minirt.report.findings import EIGHT_BITS, Findings, orders, subject
from minirt.report.metrics import Picture
from minirt.report.page import require_matplotlib
from minirt.report.pictures import (
    RUNS,
    Budget,
    Reference,
    Row,
    SettingRenderer,
    measure_disturbed_again,
    measure_settings,
    passes,
    reference,
)
from minirt.report.precision import KindCertificates, SingleError, hit_certificates, single_errors
from minirt.report.settings import AUTO, COUNTS, Setting, settings
from minirt.report.variants import Variant, with_more, without_lists, without_unseen
from minirt.scene import Scene

SEED = 20240607
NOTHING = "Interrupted before anything was measured; no report was written."
REFERENCE = "the reference"  # name of its steps
# Expected durations, from which the progress bar tells the remaining time.
ONE_SAMPLE, CONVERGENCE = 0.02, 0.75  # a usual RMSE of a picture with one sample per pixel, and order of convergence
POVRAY = 5e-7  # seconds for a sample
COMPILING = 15.0  # seconds for a kernel
PERCEIVED = 2e-6  # seconds for a pixel of the perceived difference


class Plan(NamedTuple):
    """The extent of the measurements."""

    samples: int  # samples per pixel of the reference
    most: int  # samples per pixel of the compared pictures, at most
    least_error: float  # asked of automatic sampling
    width: int  # pixels, at most
    seconds: float  # time for the reference, at most
    budget: Budget
    others: bool  # whether other programs are measured, too


FULL = Plan(1024, 64, 0.0005, 16384, 300.0, Budget(0.3, 5.0, tries=3), others=True)
QUICK = Plan(1024, 16, 0.002, 320, 5.0, Budget(0.0, 0.1, tries=3), others=False)


class Measurement:
    """Measurement of a scene, which keeps each figure as soon as it is known, so that an interrupt loses none."""

    def __init__(self, scene: Scene, name: str, plan: Plan, threads: int | None) -> None:
        self.scene, self.name, self.plan = scene, name, plan
        self.threads = threads or usable_cores()
        self.width = self.height = 0
        self.reference: Reference | None = None
        self.rows: list[Row] = []
        self.pictures: dict[str, Picture] = {}  # of the settings, by their names
        self.single: list[SingleError] = []
        self.certificates: list[KindCertificates] = []
        self.parts: list[Part] = []
        self.not_measured: list[str] = []
        self.what = ""  # name of the step that runs
        self.seconds: dict[str, float] = {}  # expected for a step
        self.expected = self.done = 0.0  # seconds of all steps, and of those that have begun before the current one

    def step(self, what: str) -> None:
        """Note that a step begins."""
        self.done += self.seconds.get(self.what, 0.0)
        self.what = what

    def state(self) -> State:
        """Return how much is done."""
        return State(self.what, self.done / self.expected if self.expected else None)

    def run(self, size: tuple[int, int], files: Path, ablation: bool) -> None:
        """Measure everything; `files` is a folder for temporary files."""
        scene, plan, step = self.scene, self.plan, self.step
        step("compiling")
        self.width, self.height = width, height = fitting_size(scene, size, plan)
        wanted, variants = list(settings(scene, plan.most, plan.least_error)), list(without_lists(scene))
        if ablation:
            variants += [*without_unseen(scene, width, height), *with_more(scene, files)]
        steps = list(self.steps(wanted, variants))
        self.seconds, self.expected = dict(steps), sum(seconds for _, seconds in steps)
        self.reference = reference(scene, width, height, plan.samples, SEED, lambda: step(REFERENCE))
        stage = SettingRenderer(scene, width, height, self.threads)
        for row, picture in measure_settings(stage, wanted, self.reference, plan.budget, step):
            self.keep(row, picture)
        if plan.others:
            self.measure_others(self.reference, files)
        self.single.extend(single_errors(scene, width, height, self.threads))
        self.certificates.extend(hit_certificates(scene, width, height, SEED))
        self.parts.extend(Ablation(scene, width, height, self.threads, plan.budget).parts(variants, step))
        self.rows = measure_disturbed_again(stage, wanted, self.rows, plan.budget, step)

    def steps(self, wanted: list[Setting], variants: list[Variant]) -> Iterator[tuple[str, float]]:
        """Yield the steps of the work and the seconds that each is expected to take, from a measured frame."""
        plan, pixels = self.plan, self.width * self.height
        renderer, frame = Renderer(), np.zeros((self.height, self.width, 4), np.uint8)
        once = min(runs(lambda: renderer.render(self.scene, frame), 2, 0.0)).wall
        count = passes(plan.samples)
        yield from [(REFERENCE, once * plan.samples / count)] * count
        for setting in wanted:
            samples = setting.value
            if setting.knob is AUTO:
                samples = min(max(1.0, (ONE_SAMPLE / setting.value) ** (1 / CONVERGENCE)), plan.samples)
            again = max(RUNS * once * samples, plan.budget.seconds) if once * samples < plan.budget.longest else 0.0
            yield setting.name, once * samples + again + PERCEIVED * pixels
        for each in povray.SETTINGS if plan.others else ():
            yield f"{each.knob} {each.label}", povray.RUNS * POVRAY * np.nan_to_num(each.samples, nan=4.0) * pixels
        for variant in variants:
            yield f"{variant.name} {variant.change}", 4 * PAIRS * once + (0.0 if variant.packing else COMPILING)

    def keep(self, row: Row, picture: Picture | None) -> None:
        """Keep a row, and the picture that it tells about."""
        self.rows.append(row)
        if picture is not None:
            self.pictures[row.name] = picture

    def measure_others(self, right: Reference, files: Path) -> None:
        """Measure other programs, or note why they cannot be measured."""
        try:
            program = povray.PovRay(self.scene, self.width, self.height, self.threads, files)
            for row, picture in program.rows(right, self.plan.budget.longest, self.step):
                self.keep(row, picture)
        except RenderError as error:
            self.not_measured.append(str(error))

    def findings(self, interrupted: str = "") -> Findings | None:
        """Conclude from what was measured; None if no picture was."""
        if not (self.reference and self.rows):
            return None
        packing = Renderer().packing
        packing.pack(self.scene, self.width, self.height)
        shapes = packing.shape_arrays
        return Findings(
            subject(self.scene, self.name, self.width, self.height, self.threads, SEED),
            self.reference.samples,
            self.reference.error,
            EIGHT_BITS,
            self.rows,
            list(orders(self.rows, self.reference.error)),
            self.parts,
            self.single,
            self.certificates,
            [*stiff_shapes(self.scene, shapes, self.width, self.height), *coincident(self.scene, shapes)],
            [*kernel_notes(self.scene, generic=None, compiling=False), *packing.notes],
            identical_without_culling(self.pictures),
            self.not_measured,
            interrupted,
        )


def fitting_size(scene: Scene, size: tuple[int, int], plan: Plan) -> tuple[int, int]:
    """Return the requested size, halved until the reference fits the plan's time.

    Halving, unlike exact scaling, mostly gives the same size when the report is repeated.
    """
    renderer = Renderer()
    renderer.specialise(scene)
    width, height = scaled_size(size, min(1.0, plan.width / size[0]))
    pixels = np.zeros((height, width, 4), np.uint8)
    renderer.render(scene, pixels)
    once = min(runs(lambda: renderer.render(scene, pixels), 2, 0.0)).wall
    halvings = ceil(log2(once * plan.samples / plan.seconds) / 2)
    return scaled_size((width, height), 0.5 ** max(0, halvings))


def scaled_size(size: tuple[int, int], factor: float) -> tuple[int, int]:
    """Scale a size; at least one pixel remains."""
    return max(1, round(size[0] * factor)), max(1, round(size[1] * factor))


def identical_without_culling(pictures: dict[str, Picture]) -> list[int]:
    """The sample counts for which brute force gave the same picture, bit for bit."""
    return [
        samples
        for samples in COUNTS
        if (picture := pictures.get(f"brute force {samples}")) is not None
        and np.array_equal(picture, pictures.get(f"uniform {samples}", 0))
    ]


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
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RenderError(f"{os.fspath(folder)}: cannot be made: {error.strerror or error}") from None
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
