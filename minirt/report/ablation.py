"""Ablation: what each absent feature or kind of shape would cost, what unseen ones cost, and what each list saves."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from math import nan
from statistics import median
from time import perf_counter
from typing import NamedTuple

import numpy as np

from minirt.errors import RenderError
from minirt.helpers.system import Run, is_disturbed, runs
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY, load
from minirt.rendering import Renderer
from minirt.rendering.needed_kernels import calls_for
from minirt.rendering.packing.features import DEPTH
from minirt.report.metrics import of_median
from minirt.report.pictures import DISTURBED_BY_OTHERS, ENOUGH, Budget
from minirt.report.settings import ChangedPacking
from minirt.report.variants import Variant
from minirt.scene import Scene

PAIRS = 15  # of frames, of the scene as it is and of the variant, in turn


class Part(NamedTuple):
    """Frame time and compile time with one part of the renderer added to, or taken from, what a scene uses."""

    sort: str  # "scene", "list", "unseen", "feature" or "kind"
    name: str  # such as "mirrors and glass", "tori", "tiles"
    change: str  # "as it is", "added" or "without"
    frame_ms: float = nan  # of a picture with one sample per pixel, median
    percent: float = nan  # change of the processor time of a frame: median of the ratios of frames in turn
    percent_low: float = nan  # 95 % confidence interval
    percent_high: float = nan
    compile_s: float = nan  # processor time of the compiler; NaN for a list, which needs no kernel of its own
    compile_percent: float = nan
    pays_after_s: float = nan  # of rendering, until a kernel without the part has saved its compile time; NaN: in doubt
    same: bool = True  # the picture is that of the scene as it is, bit for bit
    valid: bool = False  # False: failed, or other programs disturbed the times
    remark: str = ""


class Ablation:
    """Measures variants of a scene against the scene as it is."""

    def __init__(self, scene: Scene, width: int, height: int, threads: int, budget: Budget) -> None:
        self.scene, self.threads, self.budget = scene, threads, budget
        self.shape = height, width, 4
        self.base = Frame(Renderer(threads), scene, self.shape)
        self.compile_s = nan

    def parts(self, variants: Iterable[Variant], step: Callable[[str], object]) -> Iterator[Part]:
        """Yield the scene as it is, and each variant; `step` is called with the name of each before it is measured."""
        self.base.draw()
        found = runs(self.base.draw, ENOUGH, 0.0)
        calm = [run for run in found if not is_disturbed(run, self.threads)]
        remark = "" if calm else DISTURBED_BY_OTHERS
        frame_ms = median(run.wall for run in calm or found) * 1e3
        variants = list(variants)
        if not all(variant.packing for variant in variants):
            step("compiling the scene as it is")
            self.compile_s = compile_seconds(drawing_kernel(self.scene))
        yield Part(
            "scene", "the scene", "as it is", frame_ms, compile_s=self.compile_s, valid=bool(calm), remark=remark
        )
        for variant in variants:
            step(f"{variant.name} {variant.change}")
            try:
                yield self.part(variant)
            except RenderError as error:
                yield Part(variant.sort, variant.name, variant.change, remark=f"failed: {error}")

    def part(self, variant: Variant) -> Part:
        """Measure a variant: RenderError if it fails."""
        renderer = Renderer(self.threads)
        compile_s = nan
        if variant.packing:
            renderer.packing = ChangedPacking(*variant.packing)
        else:
            compile_s = compile_seconds(drawing_kernel(variant.scene))
        frame = Frame(renderer, variant.scene, self.shape)
        frame.draw()
        pairs, remark = self.pairs(frame)
        ratios = [ratio(base, other) for base, other in pairs]
        low, high = of_median(ratios)
        return Part(
            variant.sort,
            variant.name,
            variant.change,
            frame_ms=median(other.wall for _, other in pairs) * 1e3,
            percent=per_cent(median(ratios)),
            percent_low=per_cent(low),
            percent_high=per_cent(high),
            compile_s=compile_s,
            compile_percent=per_cent(compile_s / self.compile_s),
            pays_after_s=self.pays_after(variant.change, ratios, compile_s),
            same=np.array_equal(frame.pixels, self.base.pixels),
            valid=not remark,
            remark=remark,
        )

    def pays_after(self, change: str, ratios: list[float], compile_s: float) -> float:
        """Return after how many seconds of rendering a kernel without a part has saved its own compile time.

        `ratios` are frame times of the variant by those of the scene as it is. NaN where they do not tell for certain
        that the part costs time.
        """
        low, high = of_median(ratios)
        if change == "added":
            return self.compile_s * median(ratios) / (median(ratios) - 1) if low > 1 else nan
        return compile_s / (1 - median(ratios)) if high < 1 else nan

    def pairs(self, frame: Frame) -> tuple[list[tuple[Run, Run]], str]:
        """Time the scene as it is and a variant in turn; return the pairs that count, and a remark if they do not."""
        first = runs(frame.draw, 1, 0.0)[0]
        if first.wall > self.budget.longest:
            return [(runs(self.base.draw, 1, 0.0)[0], first)], "takes too long for more than one run"
        found: list[tuple[Run, Run]] = []
        for _ in range(self.budget.tries):
            start = perf_counter()
            for number in range(PAIRS):
                found.append(self.pair(frame, number % 2 == 1))
                if number >= ENOUGH and perf_counter() - start > self.budget.longest:
                    break
            calm = [pair for pair in found if not any(is_disturbed(run, self.threads) for run in pair)]
            if len(calm) >= ENOUGH:
                return calm, ""
        return found, DISTURBED_BY_OTHERS

    def pair(self, frame: Frame, swapped: bool) -> tuple[Run, Run]:
        """Time the scene as it is and a variant, one after the other; with `swapped` the variant first."""
        works = (frame.draw, self.base.draw) if swapped else (self.base.draw, frame.draw)
        one, other = (runs(work, 1, 0.0)[0] for work in works)
        return (other, one) if swapped else (one, other)


class Frame:
    """A picture that is drawn again and again."""

    def __init__(self, renderer: Renderer, scene: Scene, shape: tuple[int, int, int]) -> None:
        self.renderer, self.scene = renderer, scene
        self.pixels = np.zeros(shape, np.uint8)
        renderer.specialise(scene)

    def draw(self) -> None:
        """Draw it with one sample per pixel."""
        self.renderer.render(self.scene, self.pixels)


def ratio(base: Run, other: Run) -> float:
    """Return the ratio of processor times, or of wall times where the clock of the processor is too coarse."""
    return other.cpu / base.cpu if base.cpu else other.wall / base.wall


def per_cent(ratio: float) -> float:
    """Convert a ratio to a change in per cent."""
    return (ratio - 1) * 100


def drawing_kernel(scene: Scene) -> str:
    """Return the identity of the specialised kernel that draws a scene."""
    return LIBRARY.identity(calls_for(scene, "double", DEPTH)[-1])


def compile_seconds(identity: str) -> float:
    """Compile a kernel, even if it is there, keep it in memory, and return the processor time of the compiler."""
    start, before = perf_counter(), os.times()
    (code,) = CompileProcess().compile([identity])
    after = os.times()
    with LIBRARY.lock:
        LIBRARY.keep(identity, load(code))
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return seconds or perf_counter() - start  # Windows does not tell the time of child processes
