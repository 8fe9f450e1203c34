"""Error and run time of pictures under all settings, against a reference of many samples at other positions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from math import nan
from statistics import median
from time import perf_counter
from typing import NamedTuple

import numpy as np

from minirt.errors import RenderError
from minirt.helpers.system import Run, is_disturbed, runs
from minirt.lanes import width as lanes_of
from minirt.rendering import Renderer
from minirt.rendering.frame import frame_arguments, sample_positions
from minirt.rendering.packing.camera import aperture_places, has_apertures, packet_rays, with_apertures
from minirt.report.metrics import (
    Perceived,
    Picture,
    changed,
    clamped,
    flip,
    of_median,
    of_rmse,
    perceived,
    psnr,
    rmse,
    to_8_bits,
)
from minirt.report.settings import Drawn, Setting
from minirt.scene import Scene

OURS = "miniRT"
PASS = 32  # samples per pixel of one call of the kernel for the reference
RUNS = 7  # of a round
FEW = 3  # of a round, of work so slow that `RUNS` of them would take longer than a picture may
ENOUGH = 5  # undisturbed runs, for a median with a confidence interval
TOO_SLOW = "takes too long for more than the first run"
DISTURBED_BY_OTHERS = "other programs needed the processors"


class Budget(NamedTuple):
    """Time that measuring a setting may take."""

    seconds: float  # least total of the runs of a setting
    longest: float  # seconds for a picture; a slower setting is left out
    tries: int  # rounds of runs at most, until enough of them are undisturbed


class Times(NamedTuple):
    """Runs to take the time from, and a remark if that time is not reliable."""

    runs: list[Run]
    remark: str = ""


def measure_times(work: Callable[[], object], first: Run, threads: int, budget: Budget) -> Times:
    """Return the undisturbed runs of some work after the warm-up run `first`; all runs if too few are undisturbed."""
    if first.wall > budget.longest:
        return Times([first], TOO_SLOW)
    least = RUNS if RUNS * first.wall <= budget.longest else FEW
    found: list[Run] = []
    for _ in range(budget.tries):
        found += runs(work, least, budget.seconds)
        undisturbed = [run for run in found if not is_disturbed(run, threads)]
        if len(undisturbed) >= min(ENOUGH, least):
            return Times(undisturbed)
        if sum(run.wall for run in found) > budget.longest:
            break
    return Times(found, DISTURBED_BY_OTHERS)


class Reference(NamedTuple):
    """A picture in float64, its samples per pixel and its estimated error."""

    picture: Picture
    samples: int
    error: float  # estimated RMSE of the reference itself


def reference(
    scene: Scene, width: int, height: int, samples: int, seed: int, step: Callable[[], object] = lambda: None
) -> Reference:
    """Render the reference picture as the mean of two halves; `step` is called `passes(samples)` times.

    Each half has the usual lattice of samples, shifted by a random phase. The errors of the halves are independent, so
    the RMSE of their mean is half of the RMSE between them.
    """
    renderer, random = Renderer(), np.random.default_rng(seed)
    pixels, linear = np.zeros((height, width, 4), np.uint8), np.zeros((height, width, 3))
    halves = []
    for half in range(2):
        places, total = (sample_positions(samples // 2) + random.random(2)) % 1.0, np.zeros((height, width, 3))
        for start in range(0, len(places), PASS):
            some = places[start : start + PASS]
            traced = renderer.packing.pack(scene, width, height)
            rays = packet_rays(traced.camera, some)
            if has_apertures(traced):
                discs = aperture_places(len(places), 1, lanes_of(traced.camera), 2 * seed + half)
                rays = with_apertures(rays, discs[start : start + PASS], traced.lens)
            arguments = frame_arguments(traced, pixels, linear=linear)._replace(rays=rays)
            renderer.runner.next_row = arguments.next_row  # so that it can be cancelled
            renderer.runner.run([arguments], renderer.threads)
            total += linear * len(some)
            step()
        halves.append(clamped(total / len(places)))
    return Reference((halves[0] + halves[1]) / 2, samples, rmse(*halves) / 2)


def passes(samples: int) -> int:
    """Return the number of steps that rendering a reference takes."""
    return 2 * -(-(samples // 2) // PASS)


class Row(NamedTuple):
    """Error and run time of one setting."""

    knob: str
    label: str  # of the point in the diagram: "16" samples, or the error that was asked for
    program: str = OURS  # that drew the picture
    samples: float = nan  # per pixel: "adaptive" takes so many at most, "auto" on average; NaN where nobody tells
    rmse: float = nan  # of colours, 1 from black to white
    rmse_low: float = nan  # 95 % confidence interval: bootstrap over blocks of pixels, and the error of the reference
    rmse_high: float = nan
    rmse_8_bits: float = nan  # of the picture rounded to 8 bits per channel, as files have it
    psnr: float = nan  # decibels
    flip: float = nan  # mean over the pixels
    changed: float = nan  # pixels that differ in 8 bits
    not_finite: float = nan  # rays whose light was infinite or NaN, and is 0 in the picture
    asked: float = nan  # error that was asked for, of automatic sampling
    estimated: float = nan  # error that automatic sampling estimates itself
    wall_ms: float = nan  # median of the undisturbed runs
    wall_low_ms: float = nan  # 95 % confidence interval: bootstrap over the runs
    wall_high_ms: float = nan
    cpu_ms: float = nan
    runs: int = 0  # that were undisturbed
    sort_ms: float = nan  # packing and culling, once per scene
    compile_s: float = nan  # compiling the kernel, or loading it from the cache
    valid: bool = False  # False: failed, or other programs disturbed all tries: never recommended
    remark: str = ""

    @property
    def name(self) -> str:
        """Name of the setting, such as `uniform 16`."""
        return f"{self.knob} {self.label}"


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

    def draw(self, setting: Setting, linear: Picture | None = None) -> Drawn:
        """Draw the picture of a setting."""
        renderer, *_ = self.renderer(setting)
        return setting.knob.picture(renderer, self.scene, self.pixels, setting.value, linear)


def measure_settings(
    stage: SettingRenderer, settings: list[Setting], reference: Reference, budget: Budget, step: Callable[[str], object]
) -> Iterator[tuple[Row, Picture | None]]:
    """Yield a row and a picture for each setting; None in place of a picture if it failed.

    `step` is called with the name of each setting before it is measured.
    """
    right = perceived(reference.picture)
    cost: dict[str, float] = {}  # seconds for a unit of work
    for setting in settings:
        step(setting.name)
        knob, work = setting.knob.name, setting.knob.work(setting.value)
        expected = cost.get(knob, 0.0) * work
        if expected > budget.longest:
            yield Row(knob, setting.label, remark=f"left out: takes about {expected:.2g} s"), None
            continue
        try:
            row, picture = measure_setting(stage, setting, reference, right, budget)
        except RenderError as error:
            yield Row(knob, setting.label, remark=f"failed: {error}"), None
            continue
        cost[knob] = row.wall_ms / 1e3 / work
        yield row, picture


def measure_setting(
    stage: SettingRenderer, setting: Setting, reference: Reference, right: Perceived, budget: Budget
) -> tuple[Row, Picture]:
    """Measure one setting; return its row and its picture."""
    _, compile_s, sort_ms = stage.renderer(setting)
    light, drawn = np.zeros((*stage.pixels.shape[:2], 3)), list[Drawn]()
    (first,) = runs(lambda: drawn.append(stage.draw(setting, light)), 1, 0.0)
    row = Row(setting.knob.name, setting.label, sort_ms=sort_ms, compile_s=compile_s)._replace(**drawn[0]._asdict())
    picture = clamped(light)
    times = measure_times(partial(stage.draw, setting), first, stage.threads, budget)
    return with_times(with_errors(row, picture, reference, right), times), picture


def measure_disturbed_again(
    stage: SettingRenderer, settings: list[Setting], rows: list[Row], budget: Budget, step: Callable[[str], object]
) -> list[Row]:
    """Time those rows again that other programs disturbed, after all others; return all rows."""
    by_name = {setting.name: setting for setting in settings}
    measured = []
    for row in rows:
        if row.remark == DISTURBED_BY_OTHERS and row.name in by_name:
            step(f"{row.name} again")
            setting = by_name[row.name]
            (first,) = runs(partial(stage.draw, setting), 1, 0.0)
            again = measure_times(partial(stage.draw, setting), first, stage.threads, budget)
            measured.append(with_times(row, again))
        else:
            measured.append(row)
    return measured


def with_errors(row: Row, picture: Picture, reference: Reference, right: Perceived) -> Row:
    """Return a row with the errors of its picture; `right` is the reference as it is perceived."""
    error, rounded = rmse(picture, reference.picture), to_8_bits(picture) / 255
    low, high = of_rmse(picture, reference.picture, reference.error)
    return row._replace(
        rmse=error,
        rmse_low=low,
        rmse_high=high,
        rmse_8_bits=rmse(rounded, reference.picture),
        psnr=psnr(error),
        flip=float(flip(perceived(picture), right).mean()),
        changed=changed(picture, reference.picture),
    )


def with_times(row: Row, times: Times) -> Row:
    """Return a row with its times."""
    walls = [run.wall * 1e3 for run in times.runs]
    low, high = of_median(walls)
    return row._replace(
        wall_ms=median(walls),
        wall_low_ms=low,
        wall_high_ms=high,
        cpu_ms=median(run.cpu * 1e3 for run in times.runs),
        runs=len(walls),
        valid=not times.remark,
        remark=times.remark,
    )
