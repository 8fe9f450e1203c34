"""Renders scenes on all processors: the facade of this package, and renderers that all callers share."""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import partial
from math import inf
from threading import Lock
from time import perf_counter

import numpy as np

from minirt.errors import RenderError, check_whole, counted
from minirt.fields import Triple
from minirt.helpers.system import ForkSafeLock, check_memory, renewables
from minirt.kernel.machine_code.library import LIBRARY
from minirt.kernel.shading.whitted import MAX_DEPTH
from minirt.rendering.frame import NOT_FINITE
from minirt.rendering.frame_runner import FrameRunner
from minirt.rendering.kernels import Kernels
from minirt.rendering.notes import NO_GENERIC_KERNEL, kernel_notes
from minirt.rendering.outcome import Outcome
from minirt.rendering.packing.camera import Crop, Request
from minirt.rendering.packing.features import DEPTH
from minirt.rendering.scene_packing import Packing
from minirt.rendering.threads import usable_cores
from minirt.rendering.tone_mapping import ToneMapper
from minirt.scene import Scene
from minirt.shapes import Shape

SAMPLE = 2**10  # bytes of the places of a sample in the pixels of a packet

PRECISIONS = ("double", "single")
PATIENCE = 0.2  # seconds that a click waits for the picture being made to end


class Renderer:
    """Keeps threads and packed shapes from picture to picture. Any thread may call it; pictures are made one by one."""

    def __init__(
        self,
        threads: int | None = None,
        precision: str = "double",
        depth: int | None = None,
        dither: bool = False,
        without: Collection[str] = (),
    ) -> None:
        """Use as many threads as there are usable processors unless `threads` is given.

        `precision` is "double" or "single". Light is reflected or refracted at most `depth` times, `DEPTH` by default.
        `dither` replaces rounding to 8 bits by blue noise. `without` names what does not cull, see `Packing`.
        RenderError for a value that is none of these.
        """
        if precision not in PRECISIONS:
            raise RenderError(f"precision must be double or single, got '{precision}'")
        self.threads = usable_cores() if threads is None else check_whole("threads", threads, 1)
        self.precision = precision
        self.moves_in_single = precision == "double"  # in a window, see `minirt.viewer.display.precision`
        self.depth = DEPTH if depth is None else check_whole("depth", depth, 0, MAX_DEPTH)
        self.dither = dither
        self.without = without
        self.after_fork()
        renewables.add(self)

    def after_fork(self) -> None:
        """Begin without a picture, in a child process anew: locks, threads and processes are the parent's."""
        self.busy = Lock()
        self.kernels = Kernels(self.precision, self.depth)
        self.runner = FrameRunner(self.threads, self.kernels)
        run = self.runner.run_on_all
        self.packing = Packing(precision=self.precision, depth=self.depth, without=self.without, run=run)
        self.tone_mapper = ToneMapper(run, self.dither)

    @property
    def not_finite(self) -> int:
        """The number of rays of the last picture whose light was infinite or NaN, and is 0 in it."""
        return int(sum(memory[-1, NOT_FINITE] for memory, _ in self.runner.memories))

    @property
    def about(self) -> list[str]:
        """Sentences about how the last picture was rendered and what its kernel lacks."""
        with self.busy:
            return [f"{counted(self.threads, 'thread')}, {self.packing.computed_in}", *self.notes]

    @property
    def notes(self) -> list[str]:
        """Sentences about the kernel of the last picture, and about its tiles, light buffers and lights."""
        choice, last = self.runner.choice, self.packing.last
        if not choice or not last:
            return []
        missing = [] if LIBRARY.has(self.kernels.for_all_scenes[-1]) else [NO_GENERIC_KERNEL]
        sentences = kernel_notes(last.scene, choice.generic, self.kernels.background.busy, self.packing.samples)
        return [*sentences, *missing, *self.packing.notes]

    def is_ready(self, scene: Scene, samples: object = 1) -> bool:
        """Whether there is a kernel, specialised or generic, that can draw this scene with so many samples a pixel."""
        return self.kernels.is_ready(scene, samples)

    def prepare(self, scene: Scene, samples: object = 1) -> None:
        """Load a kernel that can draw this scene with so many samples a pixel, 1 or others; where there is none, have
        the specialised one compiled, which takes seconds. RenderError where that fails."""
        self.render(scene, np.zeros((1, 1, 4), np.uint8), 1 if samples == 1 else 2)

    def specialise(self, scene: Scene, samples: object = 1) -> None:
        """Load or compile the specialised kernel for this scene, to measure it alone. RenderError where that fails."""
        self.kernels.compile(scene, samples)
        self.prepare(scene, samples)

    def specialise_early(self) -> None:
        """Have specialised kernels compiled as soon as a generic one has drawn a picture: for windows."""
        self.kernels.specialised_after = 0.0

    def stop(self) -> None:
        """Stop compiling; callable from any thread."""
        self.kernels.stop()

    def preview(self, scene: Scene, width: int, height: int) -> np.ndarray | None:
        """Return a coarse picture of a scene without using a kernel; see `minirt.rendering.queries.preview`."""
        from minirt.rendering.queries import preview

        return preview.preview(scene, width, height)

    def render(
        self,
        scene: Scene,
        pixels: np.ndarray,
        samples: int = 1,
        linear: np.ndarray | None = None,
        is_wanted: Callable[[], bool] = lambda: True,
        crop: Crop | None = None,
        edges_only: bool = False,
    ) -> bool:
        """Render into `pixels`, C-contiguous uint8 (h, w, 4) in the order blue, green, red, alpha, and the unclamped
        light into `linear`, float64 (h, w, 3), if given: the whole picture, or the rectangle at `crop` of a larger one.

        Return False where `cancel` ended it early, or `is_wanted` says no. `is_wanted` is asked twice: before the first
        ray, when `cancel` already has an effect, and after the last one; so stop wanting the picture, and then call
        `cancel`. With `edges_only` the pixels hold a picture of the scene, and only packets of it in which neighbours
        differ are rendered again, unless a lens or a light with a size blurs all of it; elsewhere pixels and light
        stay. RenderError for a wrong number of samples, or where there is too little memory.
        """
        with self.busy:
            return self._draw(Request(scene, pixels, linear, crop), samples, is_wanted, edges_only)

    def _draw(
        self, request: Request, samples: int, is_wanted: Callable[[], bool] = lambda: True, edges_only: bool = False
    ) -> bool:
        """Render a picture with a number of samples. The caller holds `busy`."""
        need = SAMPLE * check_whole("samples", samples, 1)
        check_memory(need, f"{samples} samples a pixel need", "fewer need less")
        request, is_done = self._begin(request, samples, edges_only)
        if not is_done:
            is_done = self.runner.render_samples(self.packing, request, samples, is_wanted, edges_only)
        if is_done:
            self.tone_mapper.apply(request, is_wanted)
        return is_done and is_wanted()

    def _begin(self, request: Request, samples: object = None, edges_only: bool = False) -> tuple[Request, bool]:
        """Return the request with an array for its light, and whether the picture is done: a scene without shapes shows
        the background, which is drawn here.

        Otherwise a kernel is made ready. Rays that are not finite are counted anew. The caller holds `busy`."""
        for memory, _ in self.runner.memories:
            memory[-1, NOT_FINITE] = 0.0
        has_shapes = bool(request.scene.runs and request.pixels.size)
        if has_shapes and not self.kernels.is_ready(request.scene, samples):
            self.kernels.compile(request.scene, samples)
        request = request._replace(linear=self.tone_mapper.light_for(request, edges_only))
        if has_shapes:
            return request, False
        from minirt.rendering.queries.preview import draw_background

        draw_background(request)
        return request, True

    def reach(
        self,
        scene: Scene,
        pixels: np.ndarray,
        error: float = 0.0,
        seconds: float = inf,
        linear: np.ndarray | None = None,
        crop: Crop | None = None,
    ) -> Outcome | None:
        """Render into `pixels` and `linear`, as `render` does, until the estimated error is at most `error` or that
        many seconds have passed; see `minirt.rendering.sampling.auto`. Without `linear` it ends where rounding to 8
        bits decides. Return samples, error and seconds; None where `cancel` ended it early and the picture is
        incomplete."""
        request, start = Request(scene, pixels, linear, crop), perf_counter()
        with self.busy:
            request, is_done = self._begin(request)
            outcome: Outcome | None = Outcome(1.0, 1, 0.0, perf_counter() - start, error)
            if not is_done:
                draw = partial(self._draw, request, 1)
                least = 0.0 if linear is not None else self.tone_mapper.floor(request, draw)
                left = seconds - (perf_counter() - start)
                outcome = self.runner.render_to_error(self.packing, request, error, left, least)
            if outcome and self.tone_mapper.needed(scene):
                self.tone_mapper.apply(request)
                outcome = outcome._replace(rounding=self.tone_mapper.rounding(request))
            return outcome

    def pick(self, scene: Scene, width: int, height: int, x: int, y: int) -> tuple[Shape | None, Triple | None]:
        """Return the shape that a pixel of a picture shows, and the point there, see `minirt.rendering.queries.pick`.

        A picture that is being made is cancelled. Where something else keeps the renderer busy, such as the compiler,
        this packs the scene anew instead of using the packed shapes.
        """
        from minirt.rendering.queries import pick

        self.cancel()
        if not self.busy.acquire(timeout=PATIENCE):
            return pick.pick(scene, width, height, x, y)
        try:
            return pick.pick(scene, width, height, x, y, self.packing.shape_arrays_for(*scene.runs))
        finally:
            self.busy.release()

    def rows_done(self, height: int) -> float:
        """Return the share of the rows of the picture being rendered, of `height` pixels, that threads have taken."""
        return min(1.0, int(self.runner.next_row[0]) / height)

    def cancel(self) -> None:
        """End the picture that is being rendered, soon and incomplete; callable from any thread."""
        self.runner.cancel()


renderers: dict[str, Renderer] = {}  # by their arguments, as Python writes them: for it True is equal to 1
lock = ForkSafeLock()  # two threads that ask at once get the same renderer


def renderer(
    threads: int | None = None, precision: str = "double", depth: int | None = None, dither: bool = False
) -> Renderer:
    """A renderer with these threads, precision and depth, that dithers or not: the one that `minirt.render` uses.

    Equal arguments, defaults included, give the same object, which keeps its threads and the packed scene.
    """
    settings = threads, precision, depth, dither
    with lock:
        if repr(settings) not in renderers:
            renderers[repr(settings)] = Renderer(*settings)
        return renderers[repr(settings)]
