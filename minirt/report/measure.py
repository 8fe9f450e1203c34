"""Measure a scene for its report, figure by figure, so that an interrupt keeps what was measured."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from minirt.rendering import Renderer
from minirt.rendering.notes import kernel_notes
from minirt.rendering.running.cores import usable_cores
from minirt.report.measurements import formula_errors, picture_errors
from minirt.report.measurements.ablation import Ablation, Part
from minirt.report.measurements.coincident import coincident
from minirt.report.measurements.convergence import orders
from minirt.report.measurements.durations import (
    formula_seconds,
    frame_seconds,
    reference_seconds,
    setting_seconds,
    variant_seconds,
)
from minirt.report.measurements.exact_hits import SOLIDS
from minirt.report.measurements.eye_rays import rays_from_the_eye
from minirt.report.measurements.findings import EIGHT_BITS, Findings, Subject, subject
from minirt.report.measurements.metrics import Picture
from minirt.report.measurements.picture_errors import SettingRenderer, measure_disturbed_again, measure_settings
from minirt.report.measurements.plan import RAYS, Plan, fitting_size
from minirt.report.measurements.reference import Reference, passes, reference
from minirt.report.measurements.regimes import regimes_of
from minirt.report.measurements.settings import COUNTS, settings
from minirt.report.measurements.single_errors import SingleError, single_errors
from minirt.report.measurements.stiffness import stiff_shapes
from minirt.report.measurements.variants import Variant
from minirt.report.progress import Progress
from minirt.scene import Scene
from minirt.shapes import ALL_KINDS, Kind

SEED = 20240607


@dataclass
class Measured:
    """What was measured so far."""

    subject: Subject | None = None
    reference: Reference | None = None
    rows: list[picture_errors.Row] = field(default_factory=list)
    pictures: dict[str, Picture] = field(default_factory=dict)  # of the settings, by their names
    single: list[SingleError] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)
    formulas: list[formula_errors.Row] = field(default_factory=list)


def measure(
    into: Measured,
    scene: Scene,
    name: str,
    plan: Plan,
    size: tuple[int, int],
    threads: int | None,
    variants: Sequence[Variant],
    shown: Progress,
) -> None:
    """Measure everything that a report says about a scene, and keep each figure as soon as it is known."""
    shown.step("compiling")
    width, height = fitting_size(scene, size, plan)
    frame = frame_seconds(scene, width, height)
    about = into.subject = subject(scene, name, width, height, threads or usable_cores(), SEED)
    wanted = {each.name: each for each in settings(scene, plan.most, plan.least_error)}
    kinds = kinds_of(scene)
    cost = {each.name: setting_seconds(each, plan, frame, width * height) for each in wanted.values()}
    a_pass, a_formula = reference_seconds(plan, frame), formula_seconds(plan)
    cost |= {f"{each.name} {each.change}": variant_seconds(each, frame) for each in variants}
    formulas = a_formula * formula_steps(kinds, scene)
    shown.expect(a_pass * passes(plan.samples) + sum(cost.values()) + formulas)

    def step(what: str) -> None:
        shown.step(what, cost.get(what, 0.0))

    into.reference = right = reference(
        scene, width, height, plan.samples, SEED, lambda: shown.step("the reference", a_pass)
    )
    stage = SettingRenderer(scene, width, height, about.threads)
    for row, picture in measure_settings(stage, list(wanted.values()), right, plan.budget, step):
        into.rows.append(row)
        if picture is not None:
            into.pictures[row.name] = picture
    into.single.extend(single_errors(scene, width, height, about.threads))
    into.parts.extend(Ablation(scene, width, height, about.threads, plan.budget).parts(variants, step))
    into.formulas.extend(formula_rows(kinds, plan, lambda what: shown.step(what, a_formula), scene))
    into.rows = measure_disturbed_again(stage, list(wanted.values()), into.rows, plan.budget, step)


def kinds_of(scene: Scene) -> list[Kind]:
    """Return the kinds of shapes that a scene has."""
    elements = set(map(type, scene.shapes))
    return [kind for kind in ALL_KINDS if kind.element in elements]


def formula_rows(
    kinds: Iterable[Kind], plan: Plan, step: Callable[[str], object], scene: Scene | None = None
) -> Iterator[formula_errors.Row]:
    """Measure the formulas of some shape types in all their regimes and, if a scene is given, from its eye."""
    for number, kind in enumerate(kinds):
        if kind.element not in SOLIDS:
            continue
        random = np.random.default_rng([SEED, number])
        poses = [(each.name, each.pose(kind, random, plan.shapes, RAYS)) for each in regimes_of(kind)]
        if scene:
            poses.append(("this scene", rays_from_the_eye(kind, scene, random, plan.shapes, RAYS)))
        for name, rays in poses:
            step(f"{kind.element.title}, {name}")
            yield from formula_errors.measure_formulas(kind, name, rays)


def formula_steps(kinds: Iterable[Kind], scene: Scene | None = None) -> int:
    """Return the number of steps of `formula_rows`."""
    return sum(len(regimes_of(kind)) + bool(scene) for kind in kinds if kind.element in SOLIDS)


def kinds_not_measured(kinds: Iterable[Kind]) -> list[str]:
    """Remarks on the shape types that have no exact reference to measure against."""
    return [f"formula of the {kind.element.title}: none in 60 digits" for kind in kinds if kind.element not in SOLIDS]


def identical_without_culling(pictures: dict[str, Picture]) -> list[int]:
    """The sample counts for which brute force gave the same picture, bit for bit."""
    return [
        samples
        for samples in COUNTS
        if (picture := pictures.get(f"brute force {samples}")) is not None
        and np.array_equal(picture, pictures.get(f"uniform {samples}", 0))
    ]


def findings_of(measured: Measured, scene: Scene, about: Subject, right: Reference) -> Findings:
    """Conclude from what was measured."""
    packing = Renderer().packing
    packing.pack(scene, about.width, about.height)
    shapes = packing.shape_arrays
    return Findings(
        about,
        right.samples,
        right.error,
        EIGHT_BITS,
        measured.rows,
        list(orders(measured.rows, right.error)),
        measured.parts,
        measured.single,
        measured.formulas,
        [*stiff_shapes(scene, shapes, about.width, about.height), *coincident(scene, shapes)],
        [*kernel_notes(scene, wide=None, compiling=False), *packing.notes],
        identical_without_culling(measured.pictures),
        kinds_not_measured(kinds_of(scene)),
    )
