"""Expected duration of each step of a report, for the remaining time that the progress bar shows."""

from __future__ import annotations

import numpy as np

from minirt.rendering import Renderer
from minirt.report.measurements.ablation import PAIRS
from minirt.report.measurements.plan import Plan
from minirt.report.measurements.reference import passes
from minirt.report.measurements.run_times import RUNS
from minirt.report.measurements.settings import AUTO, Setting
from minirt.report.measurements.variants import Variant
from minirt.scene import Scene
from minirt.timing import runs

ONE_SAMPLE = 0.02  # a usual RMSE of a picture with one sample per pixel
CONVERGENCE = 0.75  # a usual order of convergence
COMPILING = 15.0  # seconds for a kernel
FORMULA = 0.02  # seconds for a shape in a regime, mostly of exact arithmetic
PERCEIVED = 2e-6  # seconds for a pixel of the perceived difference


def frame_seconds(scene: Scene, width: int, height: int) -> float:
    """Measure how long a picture with one sample per pixel takes, once its kernel is compiled."""
    renderer, pixels = Renderer(), np.zeros((height, width, 4), np.uint8)
    return min(runs(lambda: renderer.render(scene, pixels), 2, 0.0)).wall


def reference_seconds(plan: Plan, frame: float) -> float:
    """Return the expected duration of a step of the reference, `frame` being that of a picture with one sample."""
    return frame * plan.samples / passes(plan.samples)


def setting_seconds(setting: Setting, plan: Plan, frame: float, pixels: int) -> float:
    """Return the expected duration of the measurement of a setting."""
    samples = setting.value
    if setting.knob is AUTO:
        samples = min(max(1.0, (ONE_SAMPLE / setting.value) ** (1 / CONVERGENCE)), plan.samples)
    picture = frame * samples
    return picture + max(RUNS * picture, plan.budget.seconds) * (picture < plan.budget.longest) + PERCEIVED * pixels


def variant_seconds(variant: Variant, frame: float) -> float:
    """Return the expected duration of the measurement of a variant of the scene."""
    return 4 * PAIRS * frame + (0.0 if variant.packing else COMPILING)


def formula_seconds(plan: Plan) -> float:
    """Return the expected duration of the measurement of a shape type in a regime."""
    return FORMULA * plan.shapes
