"""Generate a report: measure a scene and write the results into a folder, also when the user interrupts it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from math import ceil, log2, nan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from minirt.errors import RenderError, counted
from minirt.helpers import file_io
from minirt.helpers.progress import State, progress
from minirt.helpers.signals import held_signals
from minirt.rendering import Renderer
from minirt.rendering.notes import kernel_notes
from minirt.rendering.packing.features import WORDS, features
from minirt.rendering.queries.stiffness import coincident, stiff_shapes
from minirt.rendering.threads import usable_cores
from minirt.report import povray
from minirt.report.ablation import PAIRS, Ablation
from minirt.report.bench import runs
from minirt.report.diagram import require_matplotlib
from minirt.report.document import PAGE, summary, write_files
from minirt.report.findings import Findings, subject
from minirt.report.metrics import Picture, changed
from minirt.report.pictures import RUNS, Budget, Reference, Row, SettingRenderer, reference, reference_steps
from minirt.report.precision import hit_certificates
from minirt.report.settings import COUNTS, Setting, settings
from minirt.report.variants import Variant, with_more, without_lists, without_unseen
from minirt.scene import Scene
from minirt.shapes import ALL_KINDS

SEED = 20240607
CULLING = ("brute force", "uniform")  # knobs whose pictures must be the same
NOTHING = "Interrupted before anything was measured; no report was written."
COMPILING = 15.0  # seconds that a kernel is expected to take, from which the progress bar tells the remaining time


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
QUICK = Plan(1024, 32, 0.002, 320, 5.0, Budget(0.0, 0.3, tries=3), others=False)


class Measurement:
    """Measurement of a scene, which keeps each figure as soon as it is known, so that an interrupt loses none."""

    def __init__(self, scene: Scene, name: str, plan: Plan, threads: int | None) -> None:
        self.scene, self.name, self.plan = scene, name, plan
        self.threads = threads or usable_cores()
        self.reference: Reference | None = None
        self.found: Findings | None = None  # once there is a reference
        self.pictures: dict[str, Picture] = {}  # of the settings, by their names
        self.what = ""  # name of the step that runs
        self.seconds: dict[str, float] = {}  # expected for a step
        self.done = 0.0  # seconds of the steps that have begun before the current one

    def step(self, what: str) -> None:
        """Note that a step begins."""
        self.done += self.seconds.get(self.what, 0.0)
        self.what = what

    def state(self) -> State:
        """Return how much is done."""
        return State(self.what, self.done / sum(self.seconds.values()) if self.seconds else None)

    def run(self, size: tuple[int, int], files: Path, ablation: bool) -> None:
        """Measure everything; `files` is a folder for temporary files."""
        scene, plan, step = self.scene, self.plan, self.step
        step("compiling")
        width, height, once = fitting_size(scene, size, plan)
        wanted, variants = list(settings(scene, plan.most, plan.least_error)), list(without_lists(scene))
        if ablation:
            variants += [*without_unseen(scene, width, height), *with_more(scene, files)]
        self.seconds = dict(expected(plan, wanted, variants, once))
        right = self.reference = reference(scene, width, height, plan.samples, SEED, step)
        about = subject(scene, self.name, width, height, self.threads, SEED)
        self.found = found = Findings(about, plan.samples, right.error)
        self.add_notes(found, width, height)
        stage = SettingRenderer(scene, width, height, self.threads, plan.budget)
        for setting in wanted:
            step(setting.name)
            self.keep(found, *stage.measured(setting, right))
        brute, culled = ([self.pictures.get(f"{knob} {count}", nan) for count in COUNTS] for knob in CULLING)
        found.same += [count for count, a, b in zip(COUNTS, brute, culled, strict=True) if np.array_equal(a, b)]
        one, other = (self.pictures.get(f"{knob} 1") for knob in ("single", "uniform"))
        if one is not None and other is not None:
            found.single = changed(one, other)
        if plan.others:
            try:
                program = povray.PovRay(scene, width, height, self.threads, files)
                for row, picture in program.rows(right, plan.budget, step):
                    self.keep(found, row, picture)
            except RenderError as error:
                found.not_measured.append(str(error))
        found.certificates.extend(hit_certificates(scene, width, height, SEED))
        found.ablation.extend(Ablation(scene, width, height, self.threads, plan.budget).parts(variants, step))
        stage.measure_disturbed_again(wanted, found.pictures, step)

    def keep(self, found: Findings, row: Row, picture: Picture | None) -> None:
        """Keep a row, and the picture that it tells about."""
        found.pictures.append(row)
        if picture is not None:
            self.pictures[row.name] = picture

    def add_notes(self, found: Findings, width: int, height: int) -> None:
        """Add what packing tells of the scene: what is left out, and where it is stiff."""
        packing = Renderer().packing
        packing.pack(self.scene, width, height)
        shapes = packing.shape_arrays
        used = features(self.scene)
        kinds, others = {kind.element for kind in ALL_KINDS} - used, WORDS.keys() - used
        found.absent = f"{counted(len(kinds), 'kind')} of shapes and {counted(len(others), 'feature')}"
        found.notes += [*kernel_notes(self.scene, generic=None, compiling=False), *packing.notes]
        found.stiff += [*stiff_shapes(self.scene, shapes, width, height), *coincident(self.scene, shapes)]


def expected(plan: Plan, wanted: list[Setting], variants: list[Variant], once: float) -> Iterator[tuple[str, float]]:
    """Yield the steps of the work and the seconds that each is expected to take; `once` is the time of a frame."""
    steps = reference_steps(plan.samples)
    yield from ((step, once * plan.samples / len(steps)) for step in steps)
    for setting in wanted:
        first = once * min(setting.knob.work(setting.value), plan.samples)
        yield setting.name, first + (max(RUNS * first, plan.budget.seconds) if first < plan.budget.longest else 0.0)
    for row, _ in povray.SETTINGS if plan.others else ():
        yield row.name, RUNS * once * np.nan_to_num(row.samples, nan=4.0)
    for variant in variants:
        yield f"{variant.name} {variant.change}", 4 * PAIRS * once + (0.0 if variant.without else COMPILING)


def fitting_size(scene: Scene, size: tuple[int, int], plan: Plan) -> tuple[int, int, float]:
    """Return the requested size, halved until the reference fits the plan's time, and the seconds of a frame in it.

    Halving, unlike exact scaling, mostly gives the same size when the report is repeated.
    """
    renderer = Renderer()
    renderer.specialise(scene)
    width, height = (max(1, round(side * min(1.0, plan.width / size[0]))) for side in size)
    pixels = np.zeros((height, width, 4), np.uint8)
    renderer.render(scene, pixels)
    once = min(runs(lambda: renderer.render(scene, pixels), 2, 0.0)).wall
    halvings = max(0, ceil(log2(once * plan.samples / plan.seconds) / 2))
    width, height = (max(1, round(side * 0.5**halvings)) for side in (width, height))
    return width, height, once * 0.25**halvings


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
    own. KeyboardInterrupt ends the measurements: what was measured until then is written, a note of it says so, and
    it is raised again. RenderError if the scene has no shapes, matplotlib is missing or a file cannot be written.
    """
    if not scene.shapes:
        raise RenderError(f"{name}: a scene without shapes has no errors to report")
    require_matplotlib()
    is_new = not file_io.found(folder)
    with file_io.told_errors(folder, "cannot be made"):
        Path(folder).mkdir(parents=True, exist_ok=True)
    measurement = Measurement(scene, name, QUICK if quick else FULL, threads)
    try:
        with TemporaryDirectory(prefix="minirt-report-") as files, progress(measurement.state):
            measurement.run(size, Path(files), ablation)
    except KeyboardInterrupt as interrupt:
        missing = f"Interrupted while measuring {measurement.what}: this and all that would have followed is missing."
        written = write_report(measurement, folder, missing)
        if is_new and not written:
            Path(folder).rmdir()
        interrupt.add_note(written or NOTHING)
        raise
    with held_signals():
        return write_report(measurement, folder)


def write_report(measurement: Measurement, folder: str | os.PathLike[str], interrupted: str = "") -> str:
    """Write the files of a report, and return its summary; nothing if no picture was measured."""
    found = measurement.found
    if not (found and found.pictures and measurement.reference):
        return ""
    found.interrupted = interrupted
    write_files(folder, found, measurement.pictures, measurement.reference.picture)
    return f"{summary(found)}\nThe report is in {Path(folder, PAGE)}"
