"""Renders scenes on all processors."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from contextlib import nullcontext
from functools import cached_property, partial
from importlib import import_module
from itertools import takewhile
from math import inf
from threading import Lock
from time import perf_counter
from typing import Any

import numpy as np

from minirt.errors import RenderError
from minirt.gc_pause import uncollected
from minirt.kernel.culling import binning
from minirt.kernel.frame import CANCELLED, PACKET_HEIGHT
from minirt.lanes import width
from minirt.rendering.culling.visibility import SMALL
from minirt.rendering.frame_arguments import ALL_PACKETS, NO_LINEAR, Frame, frame_arguments, memory_for, room_for_sums
from minirt.rendering.packing.features import DEPTH, features, material_features, primitive_count
from minirt.rendering.running.compile_process import CompileProcess
from minirt.rendering.running.cores import usable_cores
from minirt.rendering.running.thread_pool import ThreadPool
from minirt.rendering.sampling.adaptive import edge_packets
from minirt.rendering.sampling.auto import CLASSES, Auto, Task
from minirt.rendering.sampling.outcome import Outcome
from minirt.scene import Scene
from minirt.shapes import Shape

PRECISIONS = ("double", "single")
PATIENCE, TRIES = 0.05, 4  # seconds that somebody who clicks waits for a picture, and how often


class Renderer:
    """Keeps threads and packed shapes from picture to picture. Any thread may call it; pictures are made one by one."""

    def __init__(self, threads: int | None = None, precision: str = "double", depth: int | None = None) -> None:
        """As many threads as there are usable processors; "double" or "single" `precision`, or RenderError; light is
        mirrored or refracted `depth` times at most, where that is not given `DEPTH` times."""
        if precision not in PRECISIONS:
            raise RenderError(f"precision must be double or single, got '{precision}'")
        self.threads = threads or usable_cores()
        self.precision = precision
        self.depth = DEPTH if depth is None else depth
        self.next_row = np.zeros(1, np.int64)
        self.known: set[frozenset[Hashable]] = set()  # traits of scenes that there is a kernel for
        self.not_finite = 0  # rays of the last picture whose light was infinite or NaN, and is 0 in it
        self.cancels = 0
        self.busy = Lock()
        self.helper = CompileProcess()

    @cached_property
    def workers(self) -> ThreadPool:
        """The threads that render."""
        return ThreadPool(self.threads)

    @cached_property
    def packing(self) -> Any:
        """The arrays of the last scene."""
        return import_module("minirt.rendering.scene_packing").Packing(precision=self.precision, depth=self.depth)

    @cached_property
    def kernel(self) -> Any:
        """The compiled code, and the compiler where it is not there yet."""
        return import_module("minirt.kernel.compiler.jit")

    @property
    def about(self) -> list[str]:
        """How the last picture was made, and what it does without, in words."""
        with self.busy:
            return [f"{self.threads} threads, {self.precision} precision", *self.packing.notes]

    def is_ready(self, scene: Scene) -> bool:
        """Whether the kernel for the kinds of shapes of this scene is there."""
        return not scene.shapes or needs(scene) in self.known

    def prepare(self, scene: Scene) -> None:
        """Load the kernel for the kinds of shapes of this scene, or compile it, which takes seconds.

        Another process compiles, where what it makes can be kept. RenderError where that fails.
        """
        with nullcontext() if self.known else uncollected():
            self.load(scene)

    def load(self, scene: Scene) -> None:
        """`prepare`, as it is."""
        pixels = np.zeros((1, 1, 4), np.uint8)
        if scene.shapes and self.kernel.CACHE:
            packing = import_module("minirt.rendering.scene_packing").Packing(binning, self.precision, self.depth)
            arguments = frame_arguments(packing.pack(small(scene), 1, 1), pixels)
            if not self.kernel.is_compiled(arguments):
                self.helper.compile(arguments)
        self.render(scene, pixels)

    def stop(self) -> None:
        """From any thread: `prepare` need not go on."""
        self.helper.stop()

    def preview(self, scene: Scene, width: int, height: int) -> np.ndarray | None:
        """Without a kernel, a coarse picture of a scene; see `minirt.rendering.queries.preview`."""
        made: np.ndarray | None = import_module("minirt.rendering.queries.preview").preview(scene, width, height)
        return made

    def render(
        self,
        scene: Scene,
        pixels: np.ndarray,
        samples: int = 1,
        linear: np.ndarray | None = None,
        is_wanted: Callable[[], bool] = lambda: True,
    ) -> bool:
        """Render into `pixels`, C-contiguous uint8 (h, w, 4) in the order blue, green, red, alpha, and where it is
        given the light as it is into `linear`, float64 (h, w, 3).

        False where `cancel` ended it early. `is_wanted` is asked once, as soon as `cancel` can: who stops wanting the
        picture and then cancels is heard at any time.
        """
        with self.busy:
            return self.draw(scene, pixels, samples, NO_LINEAR if linear is None else linear, False, is_wanted)

    def refine(
        self,
        scene: Scene,
        pixels: np.ndarray,
        samples: int,
        is_wanted: Callable[[], bool] = lambda: True,
        linear: np.ndarray | None = None,
    ) -> bool:
        """Render again, with more samples, where neighbouring pixels of a picture of the scene differ. False,
        `is_wanted` and `linear` as for `render`; light stays as it is where no pixel differs."""
        with self.busy:
            return self.draw(scene, pixels, samples, NO_LINEAR if linear is None else linear, True, is_wanted)

    def draw(
        self,
        scene: Scene,
        pixels: np.ndarray,
        samples: int,
        linear: np.ndarray,
        edges: bool,
        is_wanted: Callable[[], bool],
    ) -> bool:
        """`render` or, of `edges` alone, `refine`."""
        if samples < 1:
            raise RenderError(f"a pixel needs at least 1 sample, got {samples}")
        height, across, _ = pixels.shape
        self.not_finite = 0
        if not scene.shapes or not pixels.size:
            self.draw_sky(scene, pixels, linear)
            return True
        self.next_row = counter = np.zeros(1, np.int64)
        if not is_wanted():
            return False
        traced = self.packing.pack(scene, across, height)
        given = frame_arguments(traced, pixels, samples, linear, counter)
        if edges:
            strips = edge_packets(pixels, width(traced.camera) // PACKET_HEIGHT)
            found = list(takewhile(lambda _: counter[0] < CANCELLED, strips))
            given = given._replace(wanted=np.concatenate(found) if found else ALL_PACKETS)
        self.run([given], self.threads)
        self.known.add(needs(scene))
        return bool(counter[0] < CANCELLED)

    def draw_sky(self, scene: Scene, pixels: np.ndarray, linear: np.ndarray) -> None:
        """The picture of a scene without shapes."""
        if scene.background and pixels.size:
            pixels[...], light = import_module("minirt.rendering.queries.preview").picture(scene, *pixels.shape[1::-1])
            linear[...] = light if len(linear) else linear
        else:
            pixels[...] = (0, 0, 0, 255)

    def reach(
        self,
        scene: Scene,
        pixels: np.ndarray,
        error: float = 0.0,
        seconds: float = inf,
        linear: np.ndarray | None = None,
    ) -> Outcome | None:
        """Render into `pixels` and `linear`, as `render` does, until the estimated error is as small or as many seconds
        have passed; see `minirt.rendering.sampling.auto`. None where `cancel` ended it early; then both are as before.
        """
        with self.busy:
            start, cancels = perf_counter(), self.cancels
            if not scene.shapes or not pixels.size:
                self.draw(scene, pixels, 1, NO_LINEAR, False, lambda: True)
                return Outcome(1.0, 1, 0.0, perf_counter() - start)
            traced = self.packing.pack(scene, pixels.shape[1], pixels.shape[0])
            given = frame_arguments(traced, pixels)
            self.not_finite = 0

            def draw(tasks: list[Task]) -> bool:
                self.next_row = counters = np.zeros(len(tasks), np.int64)
                if self.cancels != cancels:
                    return False
                self.run([given.of(task, counters[i:]) for i, task in enumerate(tasks)], -(-self.threads // CLASSES))
                return bool(counters.max() < CANCELLED)

            auto = Auto(draw, pixels.shape[0], pixels.shape[1], width(traced.camera) // PACKET_HEIGHT)
            reached = auto.reach(error, seconds - (perf_counter() - start))
            if reached:
                auto.halves.finish(pixels, NO_LINEAR if linear is None else linear)
                self.known.add(needs(scene))
            return reached and reached._replace(seconds=perf_counter() - start)

    def run(self, frames: list[Frame], threads: int) -> None:
        """Frames, each on so many threads, which share its rows; an error of any thread is raised.

        The caller's thread only waits, so that Ctrl+C reaches it.
        """
        draw = self.kernel.kernel_for(frames[0].scene)
        own = [
            frame._replace(memory=memory_for(frame.scene), sums=room_for_sums(frame.scene))
            for frame in frames
            for _ in range(threads)
        ]
        self.workers.run([partial(draw, *each) for each in own], self.cancel)
        self.not_finite += int(sum(each.memory[-1, 1] for each in own))

    def pick(self, scene: Scene, width: int, height: int, x: int, y: int) -> Shape | None:
        """What a pixel of a picture shows, see `minirt.rendering.queries.pick`. A picture that is being made gives way; where
        there is something else to wait for, such as the compiler, this is done without what is known of the scene."""
        find: Callable[..., Shape | None] = import_module("minirt.rendering.queries.pick").pick
        for _ in range(TRIES):
            if self.busy.acquire(timeout=PATIENCE):
                try:
                    return find(scene, width, height, x, y, self.packing.tables_of(scene.shapes))
                finally:
                    self.busy.release()
            self.cancel()
        return find(scene, width, height, x, y)

    def cancel(self) -> None:
        """From any thread: the picture that is being made ends soon, half-made."""
        self.cancels += 1  # for a picture between two frames
        self.next_row[:] = CANCELLED


def needs(scene: Scene) -> frozenset[Hashable]:
    """What there is a kernel of its own for: the kinds of shapes and the features of a scene, and for parallel light
    whether there are so many shapes that a tree is used."""
    found = features(scene)
    return found | {"bvh"} if "parallel" in found and primitive_count(scene) > SMALL else found


def small(scene: Scene) -> Scene:
    """A scene of few shapes that needs the same."""
    examples = {(type(shape), *material_features(shape)): shape for shape in scene.shapes}.values()
    shapes = [shape.some(np.arange(1)) for shape in examples]
    more = min(primitive_count(scene), SMALL + 1) - len(shapes)
    sky = (scene.background,) if scene.background else ()
    return Scene((scene.camera, *sky, *scene.lights, *shapes, *shapes[:1] * more), scene.file)
