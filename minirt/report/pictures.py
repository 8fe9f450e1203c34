"""Error and run time of pictures under all settings, against a reference of many samples at other positions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from math import inf, nan
from statistics import median
from typing import Annotated, NamedTuple

import numpy as np

from minirt.errors import RenderError
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.lanes import width as lanes_of
from minirt.rendering.frame import frame_arguments, sample_positions
from minirt.rendering.kernels import ray_query
from minirt.rendering.packing.camera import (
    STEPS,
    aperture_places,
    by_pixel,
    has_apertures,
    packet_places,
    packet_rays,
    with_apertures,
)
from minirt.rendering.renderer import Renderer
from minirt.report import metrics
from minirt.report.bench import Run, is_disturbed, take_turns, timed
from minirt.report.crops import Crops, representative
from minirt.report.metrics import Picture, rmse
from minirt.report.page import DETAIL
from minirt.report.settings import Drawn, Knob, Setting
from minirt.scene import Scene

PASS = 32  # samples per pixel of one call of the kernel for the reference
PILOT = 1, 4  # samples per pixel of two pictures whose difference tells where errors are
FEW, MANY = 3, 40  # rounds of runs
LEFT_OUT = 10.0  # a setting that is expected to take as many times the longest time is left out
ONE_RUN = "one run"

Step = Callable[[str], object]  # is called with the name of a step before it begins


class ReferencePicture(NamedTuple):
    """A picture in float64, and its estimated error."""

    picture: Picture  # of the crops in which errors are measured
    error: float  # estimated RMSE of the reference itself
    crops: Crops


def crops_for(scene: Scene, width: int, height: int, most: int) -> Crops:
    """Choose crops of a picture, of at most so many pixels together: the same ones in every run."""
    if width * height <= most:
        return Crops(height, width)
    renderer, pixels = Renderer(), np.zeros((height, width, 4), np.uint8)
    few, more = (np.zeros((height, width, 3)) for _ in PILOT)
    for samples, light in zip(PILOT, (few, more), strict=True):
        renderer.render(scene, pixels, samples, light)
    return representative(((few.clip(0, 1) - more.clip(0, 1)) ** 2).sum(axis=-1), most)


def reference(scene: Scene, crops: Crops, samples: int, seed: int, step: Step = str) -> ReferencePicture:
    """Render the reference picture as the mean of two halves; `step` is called before each.

    Each half has the usual lattice of samples, shifted by a random phase. The errors of the halves are independent, so
    the RMSE of their mean is half of the RMSE between them.
    """
    renderer, random = Renderer(), np.random.default_rng(seed)
    pixels = np.zeros((crops.height, crops.width, 4), np.uint8)
    linear, halves = np.zeros((crops.height, crops.width, 3)), []
    for half in range(2):
        places, total = (sample_positions(samples // 2) + random.random(2)) % 1.0, np.zeros(())
        step(f"the reference, half {half + 1} of 2")
        for start in range(0, len(places), PASS):
            some = places[start : start + PASS]
            traced = renderer.packing.pack(scene, crops.width, crops.height)
            lanes = lanes_of(traced.camera)
            rays = packet_rays(traced.camera[STEPS], by_pixel(packet_places(lanes, some), len(some)))
            if has_apertures(traced):
                discs = aperture_places(len(places), 1, lanes, 2 * seed + half)[start : start + PASS]
                rays = with_apertures(rays, by_pixel(discs, len(some)), traced.lens)
            counter = renderer.runner.reset_counter()  # so that it can be cancelled
            frame = frame_arguments(traced, pixels, linear=linear, counter=counter)._replace(rays=rays)
            if crops.chosen is not None:
                frame = frame._replace(plan=crops.plan(lanes // PACKET_HEIGHT, len(some)))
            renderer.runner.run(frame)
            total = total + crops.of(linear) * len(some)
        halves.append(np.clip(total / len(places), 0.0, 1.0))
    return ReferencePicture((halves[0] + halves[1]) / 2, rmse(*halves) / 2, crops)


class Row(NamedTuple):
    """Error and run time of one setting."""

    knob: Annotated[str, "setting"]
    label: Annotated[str, "point"]  # in the diagram: "16" samples, or the error that was asked for
    options: str = ""  # of the command line that draw so
    samples: Annotated[float, "samples", ".3g"] = nan  # per pixel: "adaptive" takes so many at most, "auto" on average
    rmse: Annotated[float, "RMSE", ".5f"] = nan  # of colours, 1 from black to white
    # 95 % confidence interval: bootstrap over blocks of pixels, and the error of the reference.
    rmse_low: Annotated[float, "from", ".5f", DETAIL] = nan
    rmse_high: Annotated[float, "to", ".5f", DETAIL] = nan
    rmse_8_bits: float = nan  # rounded to 8 bits per channel, as files have it
    error_median: Annotated[float, "median", ".1g"] = nan  # of the errors of pixels, over their channels
    error_95: Annotated[float, "95 %", ".2g"] = nan  # of the pixels have at most this error
    error_largest: Annotated[float, "largest", ".3f"] = nan
    psnr: Annotated[float, "PSNR, dB", ".1f", DETAIL] = nan
    flip: Annotated[float, "FLIP", ".4f"] = nan  # mean over the pixels
    changed: float = nan  # pixels that differ in 8 bits
    not_finite: Annotated[float, "rays not finite", ".0f"] = nan  # whose light is 0 in the picture
    asked: float = nan  # error that was asked for, of automatic sampling
    estimated: Annotated[float, "estimate", ".5f", DETAIL] = nan  # error by the estimate of automatic sampling
    ms: Annotated[float, "ms", ".2f"] = nan  # median of the runs, by the clock that the report uses
    ms_low: Annotated[float, "from", ".2f", DETAIL] = nan  # 95 % confidence interval: bootstrap over the runs
    ms_high: Annotated[float, "to", ".2f", DETAIL] = nan
    efficiency: float = nan  # 1/(MSE s)
    wall_ms: float = nan
    cpu_ms: float = nan  # processor time per thread
    runs: int = 0
    sort_ms: float = nan  # packing and culling, once per scene
    compile_s: float = nan  # to compile the kernel or to load it
    remark: Annotated[str, "remark"] = ""

    @property
    def name(self) -> str:
        """Name of the setting, such as `uniform 16`."""
        return f"{self.knob} {self.label}"

    def with_errors(self, picture: Picture, right: ReferencePicture) -> Row:
        """Return the row with the errors of its picture."""
        error, rounded = rmse(picture, right.picture), metrics.to_8_bits(picture) / 255
        low, high = metrics.of_rmse(picture, right.picture, right.error)
        middle, most, largest = metrics.quantiles(picture, right.picture)
        return self._replace(
            rmse=error,
            rmse_low=low,
            rmse_high=high,
            rmse_8_bits=rmse(rounded, right.picture),
            error_median=middle,
            error_95=most,
            error_largest=largest,
            psnr=metrics.psnr(error),
            flip=metrics.flip(picture, right.picture),
            changed=metrics.changed(picture, right.picture),
        )

    def with_times(self, runs: Sequence[Run], threads: int, by_processor: bool) -> Row:
        """Return the row with the times of its runs: processor time of a thread, or wall time."""
        walls, cpus = [run.wall * 1e3 for run in runs], [run.cpu / threads * 1e3 for run in runs]
        low, high = metrics.of_median(times := cpus if by_processor else walls)
        remark = self.remark or ("" if len(runs) > 1 else ONE_RUN)
        row = self._replace(ms=median(times), ms_low=low, ms_high=high, runs=len(runs), remark=remark)
        efficiency = 1e3 / (self.rmse**2 * row.ms) if self.rmse and row.ms else nan
        return row._replace(wall_ms=median(walls), cpu_ms=median(cpus), efficiency=efficiency)


def mostly_disturbed(runs: Sequence[Run], threads: int) -> bool:
    """Whether other programs needed the processors in half of some runs or more."""
    return 2 * sum(is_disturbed(run, threads) for run in runs) >= len(runs)


class SettingRenderer:
    """Renders one scene in one size under all settings; keeps a prepared renderer for each knob."""

    def __init__(self, scene: Scene, width: int, height: int, threads: int, longest: float) -> None:
        """`longest`: processor time of a thread in seconds; a setting that takes longer is run only once."""
        self.scene, self.threads, self.longest = scene, threads, longest
        self.pixels = np.zeros((height, width, 4), np.uint8)
        self.renderers: dict[str, Renderer] = {}
        self.ready: dict[str, Future[Drawn]] = {}
        self.compilers, self.queries = ThreadPoolExecutor(1), CompileProcess()
        self.cost: dict[str, float] = {}  # least seconds of a thread for a unit of work with a knob: of no slow moment
        self.drawn: list[Setting] = []
        self.times: dict[str, list[Run]] = {}  # of the settings that were drawn, by their names

    def renderer(self, knob: Knob) -> Renderer:
        """Return the renderer of a knob, which `prepare` makes ready."""
        return self.renderers.setdefault(knob.name, Renderer(self.threads, **knob.renderer))

    def prepare(self, knob: Knob) -> Future[Drawn]:
        """Compile the kernel of a knob and pack its scene, beside what this thread does. The result has the times of
        both by fields of `Row`: RenderError if that fails."""

        def work() -> Drawn:
            first, further = (timed(partial(self.renderer(knob).specialise, self.scene, n)) for n in (1, 2))
            height, width, _ = self.pixels.shape
            sorting = timed(lambda: self.renderer(knob).packing.pack(self.scene, width, height))
            return {"compile_s": first.wall + further.wall, "sort_ms": sorting.wall * 1e3}

        if knob.name not in self.ready:
            self.ready[knob.name] = self.compilers.submit(work)
        return self.ready[knob.name]

    def prepare_queries(self) -> None:
        """Compile the kernel of single rays, which certificates need, beside what this thread does."""
        self.compilers.submit(LIBRARY.compile, [LIBRARY.identity(ray_query())], self.queries)

    def missing_kernels(self, wanted: list[Setting]) -> int:
        """Count the kernels that must be compiled for some settings and for `prepare_queries`."""
        kernels = [self.renderer(setting.knob).kernels for setting in wanted]
        needed = {each for some in kernels for count in (1, 2) for each in some.specialised(self.scene, count)}
        return sum(not LIBRARY.has(each) for each in needed | {LIBRARY.identity(ray_query())})

    def frame_seconds(self) -> float:
        """Return the processor time of a thread for a frame by any kernel, which is compiled if there is none."""
        renderer = Renderer(self.threads)
        renderer.prepare(self.scene)
        return timed(lambda: renderer.render(self.scene, self.pixels)).cpu / self.threads

    def stop(self) -> None:
        """Stop compiling."""
        self.compilers.shutdown(wait=False, cancel_futures=True)
        self.queries.stop()
        for renderer in self.renderers.values():
            renderer.stop()

    def draw(self, setting: Setting, linear: Picture | None = None) -> Drawn:
        return setting.knob.draw(self.renderer(setting.knob), self.scene, self.pixels, setting.value, linear)

    def measured(self, setting: Setting, right: ReferencePicture) -> tuple[Row, Picture | None]:
        """Return the row and the picture of a setting, still without times; None in place of a picture if it failed or
        would take too long."""
        row, work = Row(setting.knob.name, f"{setting.value:g}", setting.options), setting.knob.work(setting.value)
        expected = self.cost.get(row.knob, 0.0) * work
        if expected > LEFT_OUT * self.longest:
            return row._replace(remark=f"left out: {expected:.2g} s"), None
        light, drawn = np.zeros((*self.pixels.shape[:2], 3)), list[Drawn]()
        try:
            prepared = self.prepare(setting.knob).result()
            first = timed(lambda: drawn.append(self.draw(setting, light)))
        except RenderError as error:
            return row._replace(remark=f"failed: {error}"), None
        seconds = first.cpu / self.threads
        self.cost[row.knob] = min(self.cost.get(row.knob, inf), seconds / work)
        self.times[row.name] = [first]
        self.drawn.append(setting)
        picture = np.clip(right.crops.of(light), 0.0, 1.0)
        return row._replace(**prepared, **drawn[0]).with_errors(picture, right), picture

    def take_times(self, seconds: float) -> None:
        """Run the settings that do not take long in turn until that takes so many seconds, at least a few times."""
        short = [each for each in self.drawn if self.cost[each.knob.name] * each.knob.work(each.value) <= self.longest]
        works = [partial(timed, partial(self.draw, setting)) for setting in short]
        for setting, runs in zip(short, zip(*take_turns(works, FEW, MANY, seconds), strict=True), strict=False):
            self.times[setting.name] = list(runs)
