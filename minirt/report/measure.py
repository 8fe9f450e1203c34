"""Measure a scene for its report."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from minirt.errors import RenderError
from minirt.rendering import Renderer
from minirt.rendering.notes import kernel_notes
from minirt.rendering.threads import usable_cores
from minirt.report.formulas import SEED, formula_names, formula_rows, kinds_not_measured, kinds_of
from minirt.report.measurements import durations, formula_errors, picture_errors
from minirt.report.measurements.ablation import Ablation, Part
from minirt.report.measurements.coincident import coincident
from minirt.report.measurements.convergence import orders
from minirt.report.measurements.findings import EIGHT_BITS, Findings, subject
from minirt.report.measurements.hit_certificates import KindCertificates, hit_certificates
from minirt.report.measurements.metrics import Picture
from minirt.report.measurements.picture_errors import SettingRenderer, measure_disturbed_again, measure_settings
from minirt.report.measurements.plan import Plan, fitting_size
from minirt.report.measurements.povray import PovRay
from minirt.report.measurements.reference import Reference, reference
from minirt.report.measurements.settings import COUNTS, Setting, settings
from minirt.report.measurements.single_errors import SingleError, single_errors
from minirt.report.measurements.stiffness import stiff_shapes
from minirt.report.measurements.unseen import without_unseen
from minirt.report.measurements.variants import Variant, with_more, without_lists
from minirt.report.progress import Progress
from minirt.scene import Scene


class Measurement:
    """Measurement of a scene, which keeps each figure as soon as it is known, so that an interrupt loses none."""

    def __init__(self, scene: Scene, name: str, plan: Plan, threads: int | None, shown: Progress) -> None:
        self.scene, self.name, self.plan, self.shown = scene, name, plan, shown
        self.threads = threads or usable_cores()
        self.width = self.height = 0
        self.reference: Reference | None = None
        self.rows: list[picture_errors.Row] = []
        self.pictures: dict[str, Picture] = {}  # of the settings, by their names
        self.single: list[SingleError] = []
        self.certificates: list[KindCertificates] = []
        self.parts: list[Part] = []
        self.formulas: list[formula_errors.Row] = []
        self.not_measured = kinds_not_measured(kinds_of(scene))

    def run(self, size: tuple[int, int], files: Path, ablation: bool) -> None:
        """Measure everything; `files` is a folder for temporary files."""
        scene, plan, step = self.scene, self.plan, self.shown.step
        step("compiling")
        self.width, self.height = fitting_size(scene, size, plan)
        wanted = list(settings(scene, plan.most, plan.least_error))
        variants = list(without_lists(scene))
        if ablation:
            variants += [*without_unseen(scene, self.width, self.height), *with_more(scene, files)]
        self.shown.expect(self.steps(wanted, variants))
        self.reference = reference(
            scene, self.width, self.height, plan.samples, SEED, lambda: step(durations.REFERENCE)
        )
        stage = SettingRenderer(scene, self.width, self.height, self.threads)
        for row, picture in measure_settings(stage, wanted, self.reference, plan.budget, step):
            self.keep(row, picture)
        if plan.others:
            self.measure_others(self.reference, files)
        self.single.extend(single_errors(scene, self.width, self.height, self.threads))
        self.certificates.extend(hit_certificates(scene, self.width, self.height, SEED))
        self.parts.extend(Ablation(scene, self.width, self.height, self.threads, plan.budget).parts(variants, step))
        self.formulas.extend(formula_rows(kinds_of(scene), plan, step, scene))
        self.rows = measure_disturbed_again(stage, wanted, self.rows, plan.budget, step)

    def steps(self, wanted: list[Setting], variants: list[Variant]) -> list[durations.Step]:
        """Return the steps of the work, with their expected durations."""
        plan, pixels = self.plan, self.width * self.height
        frame = durations.frame_seconds(self.scene, self.width, self.height)
        return [
            *durations.reference_steps(plan, frame),
            *durations.setting_steps(wanted, plan, frame, pixels),
            *durations.povray_steps(plan, pixels),
            *durations.variant_steps(variants, frame),
            *durations.formula_steps(formula_names(kinds_of(self.scene), self.scene), plan),
        ]

    def keep(self, row: picture_errors.Row, picture: Picture | None) -> None:
        """Keep a row, and the picture that it tells about."""
        self.rows.append(row)
        if picture is not None:
            self.pictures[row.name] = picture

    def measure_others(self, right: Reference, files: Path) -> None:
        """Measure other programs, or note why they cannot be measured."""
        try:
            program = PovRay(self.scene, self.width, self.height, self.threads, files)
            for row, picture in program.rows(right, self.plan.budget.longest, self.shown.step):
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
            self.formulas,
            self.certificates,
            [*stiff_shapes(self.scene, shapes, self.width, self.height), *coincident(self.scene, shapes)],
            [*kernel_notes(self.scene, generic=None, compiling=False), *packing.notes],
            identical_without_culling(self.pictures),
            self.not_measured,
            interrupted,
        )


def identical_without_culling(pictures: dict[str, Picture]) -> list[int]:
    """The sample counts for which brute force gave the same picture, bit for bit."""
    return [
        samples
        for samples in COUNTS
        if (picture := pictures.get(f"brute force {samples}")) is not None
        and np.array_equal(picture, pictures.get(f"uniform {samples}", 0))
    ]
