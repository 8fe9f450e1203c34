"""Expected duration of each step of a report, for the remaining time that the progress bar shows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from minirt.helpers.system import runs
from minirt.rendering import Renderer
from minirt.report.measurements import povray
from minirt.report.measurements.ablation import PAIRS
from minirt.report.measurements.plan import Plan
from minirt.report.measurements.reference import passes
from minirt.report.measurements.run_times import RUNS
from minirt.report.measurements.settings import AUTO, Setting
from minirt.report.measurements.variants import Variant
from minirt.scene import Scene

Step = tuple[str, float]  # name and expected seconds

REFERENCE = "the reference"
ONE_SAMPLE = 0.02  # a usual RMSE of a picture with one sample per pixel
CONVERGENCE = 0.75  # a usual order of convergence
POVRAY = 5e-7  # seconds for a sample
COMPILING = 15.0  # seconds for a kernel
FORMULA = 0.02  # seconds for a shape in a regime, mostly of exact arithmetic
PERCEIVED = 2e-6  # seconds for a pixel of the perceived difference


def frame_seconds(scene: Scene, width: int, height: int) -> float:
    """Measure how long a picture with one sample per pixel takes, once its kernel is compiled."""
    renderer, pixels = Renderer(), np.zeros((height, width, 4), np.uint8)
    return min(runs(lambda: renderer.render(scene, pixels), 2, 0.0)).wall


def reference_steps(plan: Plan, frame: float) -> list[Step]:
    """Return the steps of the reference, `frame` being the seconds of a picture with one sample per pixel."""
    count = passes(plan.samples)
    return [(REFERENCE, frame * plan.samples / count)] * count


def setting_steps(settings: Iterable[Setting], plan: Plan, frame: float, pixels: int) -> Iterator[Step]:
    """Yield a step for each setting."""
    for setting in settings:
        samples = setting.value
        if setting.knob is AUTO:
            samples = min(max(1.0, (ONE_SAMPLE / setting.value) ** (1 / CONVERGENCE)), plan.samples)
        picture, budget = frame * samples, plan.budget
        again = max(RUNS * picture, budget.seconds) if picture < budget.longest else 0.0
        yield setting.name, picture + again + PERCEIVED * pixels


def povray_steps(plan: Plan, pixels: int) -> Iterator[Step]:
    """Yield a step for each setting of POV-Ray."""
    for setting in povray.SETTINGS if plan.others else ():
        samples = np.nan_to_num(setting.samples, nan=4.0)
        yield f"{setting.knob} {setting.label}", povray.RUNS * POVRAY * samples * pixels


def variant_steps(variants: Iterable[Variant], frame: float) -> Iterator[Step]:
    """Yield a step for each variant of the scene."""
    for variant in variants:
        yield f"{variant.name} {variant.change}", 4 * PAIRS * frame + (0.0 if variant.packing else COMPILING)


def formula_steps(names: Iterable[str], plan: Plan) -> Iterator[Step]:
    """Yield a step for each shape type in each regime."""
    yield from ((name, FORMULA * plan.shapes) for name in names)
