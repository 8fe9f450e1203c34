"""Generate a report: measure a scene and write the results into a folder, also when the user interrupts it."""

from __future__ import annotations

import os
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import NamedTuple

from minirt.errors import RenderError, counted
from minirt.helpers import file_io
from minirt.helpers.progress import WorkState, in_words, progress
from minirt.helpers.signals import held_signals
from minirt.rendering.notes import kernel_notes
from minirt.rendering.packing.features import WORDS, features
from minirt.rendering.queries.stiffness import coincident, stiff_shapes
from minirt.rendering.renderer import Renderer
from minirt.rendering.threads import usable_cores
from minirt.report.ablation import LEAST_PAIRS, PAIRS, Ablation
from minirt.report.against import read
from minirt.report.diagram import require_packages
from minirt.report.document import PAGE, summary, write_files
from minirt.report.findings import Findings, subject
from minirt.report.metrics import Picture, changed
from minirt.report.pictures import FEW, LEFT_OUT, ReferencePicture, SettingRenderer, Step, crops_for, reference
from minirt.report.precision import hit_certificates
from minirt.report.settings import settings
from minirt.report.variants import with_more, without_lists, without_unseen
from minirt.scene import Scene
from minirt.shapes import ALL_KINDS

SEED = 20240607
NOTHING = "Interrupted before anything was measured; no report was written."
COMPILING, CERTIFYING = 15.0, 3.0  # seconds that a kernel, and the certificates of hits, are expected to take
JUDGING = 2e-6  # seconds for the errors of a pixel


class Plan(NamedTuple):
    """The extent of the measurements."""

    samples: int  # samples per pixel of the reference
    most: int  # samples per pixel of the compared pictures, at most
    least_error: float  # asked of automatic sampling
    pixels: int  # in which errors are measured, at most; crops that represent larger pictures
    seconds: float  # for the run times of all settings together
    longest: float  # seconds of processor time of a thread, see `SettingRenderer`; less where all would take too long
    total: float = inf  # seconds that all may take, unless that left no more than one run of two samples


FULL = Plan(1024, 64, 0.0005, 2**20, 60.0, 2.0)
QUICK = Plan(256, 32, 0.001, 2**17, 6.0, 0.4, 30.0)


class Measurement:
    """Measurement of a scene, which keeps each figure as soon as it is known, so that an interrupt loses none."""

    def __init__(self, scene: Scene, name: str, size: tuple[int, int], plan: Plan, threads: int | None) -> None:
        self.scene, self.name, self.size, self.plan = scene, name, size, plan
        self.threads = threads or usable_cores()
        self.wanted = list(settings(scene, plan.most, plan.least_error))
        self.variants = list(without_lists(scene))
        self.stage = SettingRenderer(scene, *size, self.threads, plan.longest)
        self.reference: ReferencePicture | None = None
        self.found: Findings | None = None  # once there is a reference
        self.pictures: dict[str, Picture] = {}  # of the settings, by their names
        self.what, self.start, self.seconds = "compiling", perf_counter(), inf  # the step that runs; expected in all

    def step(self, what: str) -> None:
        """Note that a step begins."""
        self.what = what

    def state(self) -> WorkState:
        """Return how much of the expected time has passed."""
        return WorkState(self.what, min((perf_counter() - self.start) / self.seconds, 0.99))

    def announcement(self) -> str:
        """Compile a kernel that can draw the scene if there is none, and tell what begins and how long it takes."""
        missing = self.stage.missing_kernels(self.wanted)
        once = self.stage.frame_seconds()
        while self.expected(once) > self.plan.total and self.stage.longest > 2 * once:
            self.stage.longest /= 1.25
        self.start, self.seconds = perf_counter(), self.expected(once)
        time = f"about {in_words(self.seconds)} where nothing else runs"
        if missing:
            time += f", and up to {in_words(missing * COMPILING)} to compile {counted(missing, 'kernel')}"
        size = f"{self.size[0]}x{self.size[1]} pixels with {counted(self.threads, 'thread')}"
        return f"Measuring {self.name} at {size}: {time}"

    def expected(self, once: float) -> float:
        """Return the seconds that all is expected to take; `once` is the time of a frame."""
        plan, longest = self.plan, self.stage.longest
        pixels = self.size[0] * self.size[1]
        judged = min(pixels, plan.pixels)
        works = [once * setting.knob.work(setting.value) for setting in self.wanted]
        drawn = sum(work + JUDGING * judged for work in works if work <= LEFT_OUT * longest)
        turns = max(plan.seconds, FEW * sum(work for work in works if work <= longest))
        part = max(2 * LEAST_PAIRS * once, min(2 * PAIRS * once, plan.seconds / len(works)))
        parts = sum(part + (0.0 if each.without else COMPILING) for each in self.variants)
        return once * judged / pixels * plan.samples + drawn + turns + CERTIFYING + parts

    def run(self, other: Findings | None) -> None:
        """Measure everything, and compare it with another report later."""
        try:
            self.measure(other)
        finally:
            self.stage.stop()

    def measure(self, other: Findings | None) -> None:
        """Measure all settings, while the kernels of later ones are compiled, and then hits and parts: `found` and
        `pictures` are filled. `other` is the report to compare with."""
        scene, plan, stage = self.scene, self.plan, self.stage
        first, *_ = [stage.prepare(setting.knob) for setting in self.wanted]
        stage.prepare_queries()
        first.result()
        crops = crops_for(scene, *self.size, plan.pixels)
        right = self.reference = reference(scene, crops, plan.samples, SEED, self.step)
        about = subject(scene, self.name, right, self.threads, SEED)
        self.found = found = Findings(about, plan.samples, right.error, times=stage.times, other=other)
        self.add_notes(found)
        for setting in self.wanted:
            self.step(setting.name)
            row, picture = stage.measured(setting, right)
            found.pictures.append(row)
            if picture is not None:
                self.pictures[row.name] = picture
        self.step("run times")
        stage.take_times(plan.seconds)
        one, uniform = (self.pictures.get(f"{knob} 1") for knob in ("single", "uniform"))
        if one is not None and uniform is not None:
            found.single = changed(one, uniform)
        self.step("certificates of hits")
        found.certificates.extend(hit_certificates(scene, *self.size, SEED))
        parts = Ablation(scene, *self.size, self.threads, plan.seconds / len(self.wanted))
        found.ablation.extend(parts.parts(self.variants, self.step))

    def add_notes(self, found: Findings) -> None:
        """Add what packing tells of the scene: what is left out, and where it is stiff."""
        packing = Renderer().packing
        packing.pack(self.scene, *self.size)
        shapes = packing.shape_arrays
        used = features(self.scene)
        kinds, others = {kind.element for kind in ALL_KINDS} - used, WORDS.keys() - used
        found.absent = f"{counted(len(kinds), 'kind')} of shapes and {counted(len(others), 'feature')}"
        found.notes += [*kernel_notes(self.scene, generic=None, compiling=False), *packing.notes]
        found.stiff += [*stiff_shapes(self.scene, shapes, *self.size), *coincident(self.scene, shapes)]


def report(
    scene: Scene,
    name: str,
    folder: str | os.PathLike[str],
    size: tuple[int, int],
    threads: int | None,
    quick: bool,
    ablation: bool = False,
    against: str | os.PathLike[str] | None = None,
    tell: Step = str,
) -> str:
    """Write the report of a scene into a folder, which is created if needed, and return a summary of it.

    With `quick` pictures have fewer samples and errors are measured in fewer pixels. `ablation` adds what each
    absent feature and kind of shape would cost, each of which needs a kernel of its own. `against` is the `report.json`
    of a report to compare with, and `tell` gets a sentence about what begins, and how long it takes. KeyboardInterrupt
    ends the measurements: what was measured until then is written, a note of it says so, and it is raised again.
    RenderError if the scene has no shapes, a package is missing or a file cannot be written; FileError if `against` is
    no report.
    """
    if not scene.shapes:
        raise RenderError(f"{name}: a scene without shapes has no errors to report")
    require_packages()
    other = read(against) if against else None
    is_new = not file_io.found(folder)
    with file_io.told_errors(folder, "cannot be made"):
        Path(folder).mkdir(parents=True, exist_ok=True)
    measurement = Measurement(scene, name, size, QUICK if quick else FULL, threads)
    try:
        with TemporaryDirectory(prefix="minirt-report-") as files:
            if ablation:
                measurement.variants += [*without_unseen(scene, *size), *with_more(scene, Path(files))]
            with progress(lambda: WorkState("compiling")):
                announcement = measurement.announcement()
            tell(announcement)
            with progress(measurement.state):
                measurement.run(other)
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
    found.settle_times()
    write_files(folder, found, measurement.pictures, measurement.reference.picture)
    return f"{summary(found)}\nThe report is in {Path(folder, PAGE)}"
