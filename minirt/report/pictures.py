"""Error and run time of pictures under all settings, against a reference of many samples at other positions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import nan
from statistics import median
from typing import Annotated, Any, NamedTuple

import numpy as np

from minirt.errors import RenderError
from minirt.lanes import width as lanes_of
from minirt.rendering import Renderer
from minirt.rendering.frame import frame_arguments, sample_positions
from minirt.rendering.packing.camera import aperture_places, has_apertures, packet_rays, with_apertures
from minirt.report import metrics
from minirt.report.bench import Run, is_disturbed, runs
from minirt.report.metrics import Picture, rmse
from minirt.report.settings import Drawn, Knob, Setting
from minirt.scene import Scene

OURS = "miniRT"
PASS = 32  # samples per pixel of one call of the kernel for the reference
RUNS = 7  # of a round
FEW = 3  # of a round, of work so slow that `RUNS` of them would take longer than a picture may
ENOUGH = 5  # undisturbed runs, for a median with a confidence interval
TOO_SLOW = "takes too long for more than the first run"
DISTURBED_BY_OTHERS = "other programs needed the processors"

Step = Callable[[str], object]  # is called with the name of a step before it begins
Works = Sequence[Callable[[], Run]]


class Budget(NamedTuple):
    """Time that measuring a setting may take."""

    seconds: float  # least total of the runs of a setting
    longest: float  # seconds for a picture; a slower setting is left out
    tries: int  # rounds of runs at most, until enough of them are undisturbed


class Times(NamedTuple):
    """Runs to take the time from, of each of some works in turn, and a remark if that time is not reliable."""

    runs: list[tuple[Run, ...]]
    remark: str = ""


def timed(work: Callable[[], object]) -> Run:
    """Time one run of some work."""
    return runs(work, 1, 0.0)[0]


def measure_times(works: Works, first: Run, threads: int, budget: Budget, many: int = RUNS) -> Times:
    """Return the undisturbed runs of works that take turns; all runs if too few are undisturbed.

    `first` is a warm-up run of the last of the works. Every second time the works run in the opposite order.
    """
    if first.wall > budget.longest:
        return Times([(*(work() for work in works[:-1]), first)], TOO_SLOW)
    least = many if many * first.wall <= budget.longest else FEW
    found: list[tuple[Run, ...]] = []
    seconds = 0.0
    for number in range(1, budget.tries + 1):
        while len(found) < number * least or seconds < number * budget.seconds:
            step = -1 if len(found) % 2 else 1
            found.append(tuple([work() for work in works[::step]][::step]))
            seconds += sum(run.wall for run in found[-1])
        undisturbed = [each for each in found if not any(is_disturbed(run, threads) for run in each)]
        if len(undisturbed) >= min(ENOUGH, least):
            return Times(undisturbed)
        if seconds > budget.longest:
            break
    return Times(found, DISTURBED_BY_OTHERS)


class Reference(NamedTuple):
    """A picture in float64, and its estimated error."""

    picture: Picture
    error: float  # estimated RMSE of the reference itself
    perceived: Picture  # the picture as the eye perceives it


def reference(scene: Scene, width: int, height: int, samples: int, seed: int, step: Step = str) -> Reference:
    """Render the reference picture as the mean of two halves; `step` is called before each of `reference_steps`.

    Each half has the usual lattice of samples, shifted by a random phase. The errors of the halves are independent, so
    the RMSE of their mean is half of the RMSE between them.
    """
    renderer, random, steps = Renderer(), np.random.default_rng(seed), iter(reference_steps(samples))
    pixels, linear = np.zeros((height, width, 4), np.uint8), np.zeros((height, width, 3))
    halves = []
    for half in range(2):
        places, total = (sample_positions(samples // 2) + random.random(2)) % 1.0, np.zeros((height, width, 3))
        for start in range(0, len(places), PASS):
            step(next(steps))
            some = places[start : start + PASS]
            traced = renderer.packing.pack(scene, width, height)
            rays = packet_rays(traced.camera[6:12], some)
            if has_apertures(traced):
                discs = aperture_places(len(places), 1, lanes_of(traced.camera), 2 * seed + half)
                rays = with_apertures(rays, discs[start : start + PASS], traced.lens)
            counter = renderer.runner.reset_counter()  # so that it can be cancelled
            arguments = frame_arguments(traced, pixels, linear=linear, counter=counter)
            renderer.runner.run(arguments._replace(rays=rays))
            total += linear * len(some)
        halves.append(np.clip(total / len(places), 0.0, 1.0))
    mean = (halves[0] + halves[1]) / 2
    return Reference(mean, rmse(*halves) / 2, metrics.perceived(mean))


def reference_steps(samples: int) -> list[str]:
    """Return the names of the calls of the kernel for a reference."""
    count = 2 * -(-(samples // 2) // PASS)
    return [f"the reference, {number} of {count}" for number in range(1, count + 1)]


class Row(NamedTuple):
    """Error and run time of one setting."""

    knob: Annotated[str, "setting"]
    label: Annotated[str, "point"]  # in the diagram: "16" samples, or the error that was asked for
    program: str = OURS  # that drew the picture
    options: str = ""  # of the command line that draw so
    samples: Annotated[float, "samples", ".3g"] = nan  # per pixel: "adaptive" takes so many at most, "auto" on average
    rmse: Annotated[float, "RMSE", ".5f"] = nan  # of colours, 1 from black to white
    rmse_low: Annotated[float, "from", ".5f"] = nan  # 95 % confidence interval: bootstrap over blocks of pixels, and
    rmse_high: Annotated[float, "to", ".5f"] = nan  # the error of the reference
    rmse_8_bits: float = nan  # rounded to 8 bits per channel, as files have it
    psnr: Annotated[float, "PSNR, dB", ".1f"] = nan
    flip: Annotated[float, "FLIP", ".4f"] = nan  # mean over the pixels
    changed: float = nan  # pixels that differ in 8 bits
    not_finite: Annotated[float, "rays not finite", ".0f"] = nan  # whose light is 0 in the picture
    asked: float = nan  # error that was asked for, of automatic sampling
    estimated: Annotated[float, "own estimate", ".5f"] = nan  # error by the estimate of automatic sampling
    wall_ms: Annotated[float, "ms", ".2f"] = nan  # median of the undisturbed runs
    wall_low_ms: Annotated[float, "from", ".2f"] = nan  # 95 % confidence interval: bootstrap over the runs
    wall_high_ms: Annotated[float, "to", ".2f"] = nan
    efficiency: Annotated[float, "efficiency, 1/(MSE s)", ",.0f"] = nan
    cpu_ms: float = nan
    runs: int = 0  # that were undisturbed
    sort_ms: float = nan  # packing and culling, once per scene
    compile_s: float = nan  # to compile the kernel or to load it
    valid: bool = False  # False: failed, or other programs disturbed all tries: never recommended
    remark: Annotated[str, "remark"] = ""

    @property
    def name(self) -> str:
        """Name of the setting, such as `uniform 16`."""
        return f"{self.knob} {self.label}"

    def with_errors(self, picture: Picture, right: Reference) -> Row:
        """Return the row with the errors of its picture."""
        error, rounded = rmse(picture, right.picture), metrics.to_8_bits(picture) / 255
        low, high = metrics.of_rmse(picture, right.picture, right.error)
        return self._replace(
            rmse=error,
            rmse_low=low,
            rmse_high=high,
            rmse_8_bits=rmse(rounded, right.picture),
            psnr=metrics.psnr(error),
            flip=float(metrics.flip(metrics.perceived(picture), right.perceived).mean()),
            changed=metrics.changed(picture, right.picture),
        )

    def with_times(self, times: Times) -> Row:
        """Return the row with its times."""
        walls = [run.wall * 1e3 for (run,) in times.runs]
        low, high = metrics.of_median(walls)
        wall = median(walls)
        return self._replace(
            wall_ms=wall,
            wall_low_ms=low,
            wall_high_ms=high,
            efficiency=1e3 / (self.rmse**2 * wall) if self.rmse else nan,
            cpu_ms=median(run.cpu * 1e3 for (run,) in times.runs),
            runs=len(walls),
            valid=not times.remark,
            remark=times.remark,
        )


class SettingRenderer:
    """Renders one scene in one size under all settings; keeps a prepared renderer for each knob."""

    def __init__(self, scene: Scene, width: int, height: int, threads: int, budget: Budget) -> None:
        self.scene, self.threads, self.budget = scene, threads, budget
        self.pixels = np.zeros((height, width, 4), np.uint8)
        self.ready: dict[str, tuple[Renderer, dict[str, Any]]] = {}
        self.cost: dict[str, float] = {}  # seconds for a unit of work with a knob

    def renderer(self, knob: Knob) -> tuple[Renderer, dict[str, Any]]:
        """Return the renderer of a knob, and how long its compilation and its packing took, by fields of `Row`."""
        if knob.name not in self.ready:
            renderer = Renderer(self.threads, **knob.renderer)
            compiling = timed(lambda: renderer.specialise(self.scene))
            height, width, _ = self.pixels.shape
            sorting = timed(lambda: renderer.packing.pack(self.scene, width, height))
            self.ready[knob.name] = renderer, {"compile_s": compiling.wall, "sort_ms": sorting.wall * 1e3}
        return self.ready[knob.name]

    def draw(self, setting: Setting, linear: Picture | None = None) -> Drawn:
        renderer, _ = self.renderer(setting.knob)
        return setting.knob.draw(renderer, self.scene, self.pixels, setting.value, linear)

    def times(self, setting: Setting, first: Run | None = None) -> Times:
        """Time a setting after a warm-up run."""
        draw = partial(timed, partial(self.draw, setting))
        return measure_times([draw], first or draw(), self.threads, self.budget)

    def measured(self, setting: Setting, right: Reference) -> tuple[Row, Picture | None]:
        """Return the row and the picture of a setting; None in place of a picture if it failed or takes too long."""
        row = Row(setting.knob.name, f"{setting.value:g}", options=setting.options)
        work = setting.knob.work(setting.value)
        expected = self.cost.get(row.knob, 0.0) * work
        if expected > self.budget.longest:
            return row._replace(remark=f"left out: takes about {expected:.2g} s"), None
        light, drawn = np.zeros_like(right.picture), list[Drawn]()
        try:
            _, prepared = self.renderer(setting.knob)
            first = timed(lambda: drawn.append(self.draw(setting, light)))
            times = self.times(setting, first)
        except RenderError as error:
            return row._replace(remark=f"failed: {error}"), None
        picture = np.clip(light, 0.0, 1.0)
        row = row._replace(**prepared, **drawn[0]).with_errors(picture, right).with_times(times)
        self.cost[row.knob] = row.wall_ms / 1e3 / work
        return row, picture

    def measure_disturbed_again(self, wanted: list[Setting], rows: list[Row], step: Step) -> None:
        """Time those rows again that other programs disturbed."""
        by_name = {setting.name: setting for setting in wanted}
        for number, row in enumerate(rows):
            if row.remark == DISTURBED_BY_OTHERS and row.name in by_name:
                step(f"{row.name} again")
                rows[number] = row.with_times(self.times(by_name[row.name]))
