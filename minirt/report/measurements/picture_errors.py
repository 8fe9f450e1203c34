"""Measure the error and the run time of pictures against a reference picture."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf, nan
from time import perf_counter
from typing import NamedTuple

import numpy as np

from minirt.errors import RenderError
from minirt.rendering import Renderer
from minirt.report.measurements import flip
from minirt.report.measurements.metrics import Picture, changed, clamped, psnr, rmse
from minirt.report.measurements.reference import Reference
from minirt.report.measurements.settings import Setting
from minirt.scene import Scene
from minirt.timing import Run, is_disturbed, runs

RUNS = 7


class Row(NamedTuple):
    """Error and run time of one setting."""

    knob: str
    samples: int
    rmse: float = nan  # of colours, 1 from black to white
    psnr: float = nan  # decibels
    flip: float = nan  # mean over the pixels
    changed: float = nan  # pixels that differ in 8 bits
    not_finite: float = nan  # rays whose light was infinite or NaN, and is 0 in the picture
    wall_ms: float = nan
    cpu_ms: float = nan
    sort_ms: float = nan  # packing and culling, once per scene
    compile_s: float = nan  # compiling the kernel, or loading it from the cache
    valid: bool = False  # False: failed, or other programs disturbed the time
    remark: str = ""


class Budget(NamedTuple):
    """Time that measuring a setting may take."""

    seconds: float  # least total of the runs of a setting
    longest: float  # seconds for a picture; a slower setting is left out
    tries: int  # rounds of runs at most, until one is undisturbed


class SettingRenderer:
    """Renders one scene in one size under all settings; keeps a prepared renderer for each knob."""

    def __init__(self, scene: Scene, width: int, height: int, threads: int) -> None:
        self.scene, self.threads = scene, threads
        self.pixels = np.zeros((height, width, 4), np.uint8)
        self.ready: dict[str, tuple[Renderer, float, float]] = {}

    def renderer(self, setting: Setting) -> tuple[Renderer, float, float]:
        """Return the renderer of a knob, its compile time in seconds and its packing time in milliseconds."""
        if setting.knob.name not in self.ready:
            renderer = setting.knob.renderer(self.threads)
            start = perf_counter()
            renderer.specialise(self.scene)
            compiled = perf_counter()
            height, width, _ = self.pixels.shape
            renderer.packing.pack(self.scene, width, height)
            self.ready[setting.knob.name] = renderer, compiled - start, (perf_counter() - compiled) * 1e3
        return self.ready[setting.knob.name]

    def light(self, setting: Setting) -> tuple[Picture, int]:
        """Return the picture of a setting, and how many of its rays brought light that is not finite."""
        linear = np.zeros((*self.pixels.shape[:2], 3))
        renderer, *_ = self.renderer(setting)
        return linear, setting.knob.picture(renderer, self.scene, self.pixels, setting.samples, linear)


def measure_settings(
    stage: SettingRenderer, settings: list[Setting], reference: Reference, budget: Budget, step: Callable[[str], object]
) -> Iterator[tuple[Row, Picture | None]]:
    """Yield a row and a picture for each setting; None in place of a picture if it failed.

    `step` is called with the name of each setting before it is measured.
    """
    right = flip.perceived(reference.picture)
    cost: dict[str, float] = {}  # seconds a sample
    for setting in settings:
        step(setting.name)
        knob, samples = setting.knob.name, setting.samples
        expected = cost.get(knob, 0.0) * samples
        if expected > budget.longest:
            yield Row(knob, samples, remark=f"left out: takes about {expected:.2g} s"), None
            continue
        try:
            row, picture = measure_setting(stage, setting, reference, right, budget)
        except RenderError as error:
            yield Row(knob, samples, remark=f"failed: {error}"), None
            continue
        cost[knob] = row.wall_ms / 1e3 / samples
        yield row, picture


def measure_setting(
    stage: SettingRenderer, setting: Setting, reference: Reference, right: flip.Perceived, budget: Budget
) -> tuple[Row, Picture]:
    """Measure one setting; return its row and its picture."""
    renderer, compile_s, sort_ms = stage.renderer(setting)
    lights: list[tuple[Picture, int]] = []
    (first,) = runs(lambda: lights.append(stage.light(setting)), 1, 0.0)
    picture = clamped(lights[0][0])
    best, remark = best_time(
        lambda: setting.knob.picture(renderer, stage.scene, stage.pixels, setting.samples, None),
        first,
        stage.threads,
        budget,
    )
    error = rmse(picture, reference.picture)
    row = Row(
        setting.knob.name,
        setting.samples,
        rmse=error,
        psnr=psnr(error),
        flip=float(flip.flip(flip.perceived(picture), right).mean()),
        changed=changed(picture, reference.picture),
        not_finite=lights[0][1],
        wall_ms=best.wall * 1e3,
        cpu_ms=best.cpu * 1e3,
        sort_ms=sort_ms,
        compile_s=compile_s,
        valid=not remark,
        remark=remark,
    )
    return row, picture


def best_time(work: Callable[[], object], first: Run, threads: int, budget: Budget) -> tuple[Run, str]:
    """Return the fastest run after the warm-up run `first`, and a remark if that time is not reliable."""
    if first.wall > budget.longest:
        return first, "takes too long for more than the first run"
    best = Run(inf, inf)
    for _ in range(budget.tries):
        best = min(best, *runs(work, RUNS, budget.seconds))
        if not is_disturbed(best, threads):
            return best, ""
    return best, "other programs needed the processors"
