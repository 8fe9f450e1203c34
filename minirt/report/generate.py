"""Generate a report: run all measurements of a scene and write the results into a folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from minirt import atomic_write
from minirt.errors import RenderError
from minirt.rendering import Renderer
from minirt.rendering.notes import kernel_notes
from minirt.rendering.running.cores import usable_cores
from minirt.report.measurements import formula_errors
from minirt.report.measurements.ablation import Ablation
from minirt.report.measurements.coincident import coincident
from minirt.report.measurements.convergence import orders
from minirt.report.measurements.exact_hits import SOLIDS
from minirt.report.measurements.eye_rays import rays_from_the_eye
from minirt.report.measurements.findings import EIGHT_BITS, Findings, Subject, choices, subject
from minirt.report.measurements.metrics import Picture
from minirt.report.measurements.picture_errors import Row, SettingRenderer, measure_disturbed_again, measure_settings
from minirt.report.measurements.plan import FULL, QUICK, RAYS, Plan, fitting_size
from minirt.report.measurements.povray import PovRay
from minirt.report.measurements.reference import Reference, passes, reference
from minirt.report.measurements.regimes import regimes_of
from minirt.report.measurements.settings import COUNTS, settings
from minirt.report.measurements.single_errors import single_errors
from minirt.report.measurements.stiffness import stiff_shapes
from minirt.report.measurements.variants import with_more, without_lists
from minirt.report.output.document import document, formula_section, summary
from minirt.report.output.error_image import error_image
from minirt.report.output.tables import as_csv, as_json
from minirt.report.progress import progress
from minirt.scene import Scene
from minirt.shapes import ALL_KINDS, KINDS, Kind

SEED = 20240607
REPORT = "report.md"
NO_DIAGRAM = "no diagram: matplotlib is not installed, which `pip install minirt[report]` does"
ReportFiles = dict[str, bytes]  # file name -> content


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
    own. RenderError if the scene has no shapes or a file cannot be written.
    """
    if not scene.shapes:
        raise RenderError(f"{name}: a scene without shapes has no errors to report")
    make_folder(folder)
    plan, kinds = QUICK if quick else FULL, [kind for kind in ALL_KINDS if kind.element in set(map(type, scene.shapes))]
    wanted = list(settings(scene, plan.most, plan.least_error))
    steps = passes(plan.samples) + len(wanted) + sum(len(regimes_of(kind)) + 1 for kind in kinds)
    with progress(steps + 1) as shown, TemporaryDirectory() as files:
        shown.step("compiling")
        width, height = fitting_size(scene, size, plan)
        about = subject(scene, name, width, height, threads or usable_cores(), SEED)
        right = reference(scene, width, height, plan.samples, SEED, lambda: shown.step("reference"))
        stage = SettingRenderer(scene, width, height, about.threads)
        found = list(measure_settings(stage, wanted, right, plan.budget, shown.step))
        others, reason = other_programs(scene, right, about, plan, Path(files), shown.step)
        single = list(single_errors(scene, width, height, about.threads))
        variants = [*without_lists(scene), *(with_more(scene, Path(files)) if ablation else ())]
        parts = list(Ablation(scene, width, height, about.threads, plan.budget).parts(variants, shown.step))
        rows = list(formula_rows(kinds, plan, shown.step, scene))
        pictures = {row.name: picture for row, picture in found if picture is not None}
        measured = measure_disturbed_again(stage, wanted, [row for row, _ in found], plan.budget, shown.step)
        measured += [row for row, _ in others]
        pictures |= {row.name: picture for row, picture in others if picture is not None}
    packing = Renderer().packing
    packing.pack(scene, width, height)
    stiff = [*stiff_shapes(scene, packing.shape_arrays, width, height), *coincident(scene, packing.shape_arrays)]
    findings = Findings(
        about,
        right.samples,
        right.error,
        EIGHT_BITS,
        measured,
        list(orders(measured, right.error)),
        parts,
        single,
        rows,
        stiff,
        [*kernel_notes(scene, wide=None, compiling=False), *packing.notes],
        identical_without_culling(pictures),
        kinds_not_measured(kinds) + reason + ([] if find_spec("matplotlib") else [NO_DIAGRAM]),
    )
    write_files(folder, report_files(findings, pictures, right))
    return summary(findings) + f"\nThe report is in {Path(folder, REPORT)}"


def report_formulas(folder: str | os.PathLike[str], quick: bool) -> None:
    """Write the accuracy and cost of the intersection formulas of all shape types into a folder."""
    make_folder(folder)
    plan = QUICK if quick else FULL
    with progress(sum(map(len, map(regimes_of, KINDS)))) as shown:
        rows = list(formula_rows(KINDS, plan, shown.step))
    text = "# Formulas of all shapes\n" + "\n".join(formula_section(rows)) + "\n"
    made = {"kernels.csv": as_csv(rows), "kernels.json": as_json(rows), "kernels.md": text}
    write_files(folder, {name: each.encode() for name, each in made.items()})


def other_programs(
    scene: Scene, right: Reference, about: Subject, plan: Plan, folder: Path, step: Callable[[str], object]
) -> tuple[list[tuple[Row, Picture | None]], list[str]]:
    """Measure other programs on a scene; return their rows and pictures, or the reason why there are none."""
    if not plan.others:
        return [], []
    try:
        program = PovRay(scene, about.width, about.height, about.threads, folder)
        return list(program.rows(right, plan.budget.longest, step)), []
    except RenderError as error:
        return [], [str(error)]


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


def report_files(found: Findings, pictures: dict[str, Picture], right: Reference) -> ReportFiles:
    """Build all files of the report of a scene."""
    has_diagram = NO_DIAGRAM not in found.not_measured
    made = {
        REPORT: document(found, has_diagram).encode(),
        "report.json": as_json(found._asdict() | {"choices": choices(found.pictures, found.reference_error)}).encode(),
        "pictures.csv": as_csv(found.pictures).encode(),
        "orders.csv": as_csv(found.orders).encode(),
        "ablation.csv": as_csv(found.ablation).encode(),
        "single.csv": as_csv(found.single).encode(),
        "kernels.csv": as_csv(found.kernels).encode(),
    }
    for name, picture in pictures.items():
        made[f"error-{name.replace(' ', '-')}.png"] = error_image(picture, right.picture).encode()
    if has_diagram:
        from minirt.report.output.diagram import diagram

        made["diagram.png"] = diagram(found.pictures, found.reference_error, found.subject.scene)
    return made


def make_folder(folder: str | os.PathLike[str]) -> None:
    """Create the folder before the measurements begin, so that a wrong path fails at once. RenderError."""
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RenderError(f"{os.fspath(folder)}: cannot be made: {error.strerror or error}") from None


def write_files(folder: str | os.PathLike[str], made: ReportFiles) -> None:
    """Write files into a folder, each as a whole or not at all. RenderError."""
    for name, data in made.items():
        path = Path(folder) / name
        try:
            atomic_write.write(path, data)
        except OSError as error:
            raise RenderError(f"{path}: cannot write: {error.strerror or error}") from None
