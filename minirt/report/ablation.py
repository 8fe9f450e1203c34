"""Ablation: what each absent feature or kind of shape would cost, what unseen ones cost, and what each list saves."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from math import nan
from statistics import median
from time import perf_counter
from typing import Annotated, NamedTuple

import numpy as np

from minirt.errors import RenderError
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY, load
from minirt.rendering.kernels import calls_for
from minirt.rendering.packing.features import DEPTH
from minirt.rendering.renderer import Renderer
from minirt.report.bench import Run, take_turns, timed
from minirt.report.metrics import Interval, of_median
from minirt.report.pictures import LEFT_OUT, Step
from minirt.report.variants import Variant
from minirt.scene import Scene

LEAST_PAIRS, PAIRS = 5, 15  # of frames, of the scene as it is and of the variant, in turn: at least, and at most


class Part(NamedTuple):
    """Frame time and compile time with one part of the renderer added to, or taken from, what a scene uses."""

    sort: str  # "scene", "list", "unseen", "feature" or "kind"
    name: Annotated[str, "part"]  # such as "mirrors and glass", "tori", "tiles"
    change: Annotated[str, "change"]  # "as it is", "added" or "without"
    # Processor time of a thread for a picture with one sample per pixel, median.
    frame_ms: Annotated[float, "frame, ms", ".2f"] = nan
    percent: Annotated[float, "frame, %", "+.1f"] = nan  # change of processor time: median of ratios of frames in turn
    percent_low: Annotated[float, "from", "+.1f"] = nan  # 95 % confidence interval
    percent_high: Annotated[float, "to", "+.1f"] = nan
    compile_s: Annotated[float, "compiling, s", ".1f"] = nan  # processor time; NaN for a list, which needs no kernel
    compile_percent: Annotated[float, "compiling, %", "+.0f"] = nan
    # Seconds of rendering until a kernel without the part has saved its compile time; NaN: in doubt.
    pays_after_s: Annotated[float, "pays after, s", ".0f"] = nan
    same: Annotated[bool, "same picture"] = True  # as that of the scene as it is, bit for bit
    remark: Annotated[str, "remark"] = ""  # why it failed


class Ablation:
    """Measures variants of a scene against the scene as it is."""

    def __init__(self, scene: Scene, width: int, height: int, threads: int, seconds: float) -> None:
        """`seconds` that the frames of a variant take, at most, unless `LEAST_PAIRS` take longer."""
        self.scene, self.threads, self.seconds = scene, threads, seconds
        self.pixels = np.zeros((height, width, 4), np.uint8)
        self.draw = frame(Renderer(threads), scene, self.pixels)
        self.compile_s = nan

    def parts(self, variants: Sequence[Variant], step: Step) -> Iterator[Part]:
        """Yield the scene as it is, and each variant; `step` is called with the name of each before it is measured."""
        self.draw()
        runs = [run for (run,) in take_turns([self.draw], LEAST_PAIRS, PAIRS, self.seconds)]
        if not all(variant.without for variant in variants):  # variants without a list need no kernel of their own
            step("compiling the scene as it is")
            self.compile_s = compile_seconds(self.scene)
        yield Part("scene", "the scene", "as it is", self.milliseconds(runs), compile_s=self.compile_s)
        for variant in variants:
            step(f"{variant.name} {variant.change}")
            try:
                yield self.part(variant)
            except RenderError as error:
                yield Part(variant.sort, variant.name, variant.change, remark=f"failed: {error}")

    def part(self, variant: Variant) -> Part:
        """Measure a variant, in turn with the scene as it is. RenderError if that fails."""
        renderer, pixels = Renderer(self.threads, without=variant.without), np.zeros_like(self.pixels)
        compile_s = nan if variant.without else compile_seconds(variant.scene)
        draw = frame(renderer, variant.scene, pixels)
        is_slow = draw().cpu / self.threads > LEFT_OUT * self.seconds  # many shapes may take minutes without culling
        least = 1 if is_slow else LEAST_PAIRS
        turns = take_turns([self.draw, draw], least, PAIRS, self.seconds)
        changes = [change(base, other) for base, other in turns]
        low, high = of_median(changes)
        return Part(
            variant.sort,
            variant.name,
            variant.change,
            frame_ms=self.milliseconds([other for _, other in turns]),
            percent=median(changes),
            percent_low=low,
            percent_high=high,
            compile_s=compile_s,
            compile_percent=(compile_s / self.compile_s - 1) * 100,
            pays_after_s=self.pays_after(variant.change, median(changes), (low, high), compile_s),
            same=np.array_equal(pixels, self.pixels),
        )

    def milliseconds(self, runs: Sequence[Run]) -> float:
        """Return the median processor time of a thread."""
        return median(run.cpu for run in runs) / self.threads * 1e3

    def pays_after(self, change: str, percent: float, interval: Interval, compile_s: float) -> float:
        """Return after how many seconds of rendering a kernel without a part has saved its own compile time.

        `percent` is the change of the frame time by the variant. NaN where its interval holds 0.
        """
        low, high = interval
        if change == "added":
            return self.compile_s * (1 + 100 / percent) if low > 0 else nan
        return -100 * compile_s / percent if high < 0 else nan


def frame(renderer: Renderer, scene: Scene, pixels: np.ndarray) -> Callable[[], Run]:
    """Prepare a renderer, and return a function that draws with one sample per pixel and returns the time of that."""
    renderer.specialise(scene)
    return partial(timed, partial(renderer.render, scene, pixels))


def change(base: Run, other: Run) -> float:
    """Return the change of processor time in per cent, of wall time where the processor's clock is too coarse."""
    return ((other.cpu / base.cpu if base.cpu else other.wall / base.wall) - 1) * 100


def compile_seconds(scene: Scene) -> float:
    """Compile the specialised kernel that draws a scene, even if it is there, and keep it in memory; return the
    processor time of the compiler."""
    identity = LIBRARY.identity(calls_for(scene, "double", DEPTH, 1)[-1])
    start, before = perf_counter(), os.times()
    (code,) = CompileProcess().compile([identity])
    after = os.times()
    with LIBRARY.lock:
        LIBRARY.keep(identity, load(code))
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return seconds or perf_counter() - start  # Windows does not tell the time of child processes
