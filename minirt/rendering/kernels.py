"""Kernels of one renderer: chooses the one that draws a frame, and has missing ones compiled, in the background where
a generic one draws meanwhile."""

from __future__ import annotations

import logging
from collections.abc import Callable, Hashable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, cached_property
from itertools import chain, islice
from threading import Lock, Thread
from typing import Any, NamedTuple

import numpy as np

from minirt.errors import RenderError
from minirt.kernel import functions, interpreted
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY, Call, Entry
from minirt.kernel.scene_arrays import SceneArrays
from minirt.meshes.obj_lines import READ, call_for
from minirt.rendering.frame import Frame, frame_arguments
from minirt.rendering.packing import generic_kernels
from minirt.rendering.packing.features import DEPTH, examples, features
from minirt.rendering.packing.generic_kernels import GenericKernel
from minirt.rendering.packing.light_buffers import SMALL
from minirt.rendering.sampling.packets import classify_call
from minirt.rendering.scene_packing import Packing
from minirt.scene import Camera, Scene, fast, parse
from minirt.shapes.mesh import Mesh


class BackgroundCompiler:
    """Compiles one kernel at a time, of those that are wanted the one that was asked for last."""

    def __init__(self) -> None:
        self.process = CompileProcess(patient=True)
        self.lock = Lock()
        self.wanted: list[str] = []
        self.asked: set[str] = set()  # identities, once and for all
        self.busy = False  # whether a kernel is being compiled

    def compile(self, *identities: str) -> None:
        """Ask for kernels, unless that was done before; callable from any thread."""
        with self.lock:
            self.wanted += [each for each in identities if each not in self.asked]
            self.asked.update(identities)
            if self.wanted and not self.busy:
                self.busy = True
                Thread(target=self.work, name="minirt-compiler", daemon=True).start()

    def work(self) -> None:
        """Compile what is wanted until nothing is: the body of the thread."""
        while True:
            with self.lock:
                self.busy = bool(self.wanted)
                if not self.busy:
                    return
                identity = self.wanted.pop()
            try:
                LIBRARY.compile([identity], self.process)
            except RenderError as error:
                logging.getLogger(__name__).info("a generic kernel stays in use: %s", error)

    def stop(self) -> None:
        """End compiling; callable from any thread."""
        with self.lock:
            self.wanted.clear()
        self.process.stop()


SPECIALISED_AFTER = 0.5  # seconds of rendering with a generic kernel, after which a specialised one is worth compiling


class KernelChoice(NamedTuple):
    """A kernel and the form of the scene that it takes."""

    entry: Entry
    scene: SceneArrays
    generic: GenericKernel | None  # None for the specialised kernel
    specialised: str  # the identity of the specialised kernel


class Kernels:
    """The kernels for scenes in one precision and with one depth of reflection.

    The specialised kernel of a scene has code for the scene's kinds of shapes and features alone. Where it is missing a
    generic kernel draws the same picture, and the specialised one is compiled in the background once that is worth its
    time.
    """

    def __init__(self, precision: str, depth: int) -> None:
        self.precision = precision
        self.depth = depth
        self.specialised_after = SPECIALISED_AFTER
        self.all_are_ready = False  # all of `for_all_scenes`
        # Identities, for each set of features, and whether there are many shapes, for whose shadow rays there is a BVH.
        self.specialised_kernels: dict[Hashable, list[str]] = {}
        self.generic_seconds: dict[str, float] = {}  # of generic kernels, by specialised one
        self.compile_process, self.packing_process = CompileProcess(), CompileProcess()
        self.background = BackgroundCompiler()

    def choose(self, frame: Frame) -> KernelChoice:
        """Return the most specialised kernel that is there for a frame; where there is none compile it."""
        call = functions.frame.call(*frame)
        specialised = LIBRARY.identity(call)
        if entry := LIBRARY.find(specialised):
            return KernelChoice(entry, frame.scene, None, specialised)
        for generic in generic_kernels.fitting(frame.scene):
            if entry := LIBRARY.find(generic_identity(generic)):
                scene = generic_kernels.generalised(frame.scene, generic_kernels.empty_arrays(generic))
                return KernelChoice(entry, scene, generic, specialised)
        return KernelChoice(LIBRARY.get(call), frame.scene, None, specialised)

    def has_better(self, choice: KernelChoice) -> bool:
        """Whether the specialised kernel is there by now, where a generic one was chosen."""
        return choice.generic is not None and LIBRARY.find(choice.specialised) is not None

    def count(self, choice: KernelChoice, seconds: float) -> None:
        """Count the time of rendering with a kernel; where a generic one took long compile the specialised one."""
        if choice.generic:
            total = self.generic_seconds.get(choice.specialised, 0.0) + seconds
            self.generic_seconds[choice.specialised] = total
            if total >= self.specialised_after:
                self.background.compile(choice.specialised)
        elif not self.specialised_after:  # so that edits need not wait for specialised ones
            self.background.compile(*(each for each in self.for_all_scenes if not LIBRARY.has(each)))

    def is_ready(self, scene: Scene, samples: object = None) -> bool:
        """Whether there are kernels that can draw a scene with so many samples, as of `features`; a scene without
        shapes needs none."""
        self.all_are_ready |= not self.all_are_ready and all(map(LIBRARY.has, self.for_all_scenes))
        return self.all_are_ready or not scene.runs or all(map(LIBRARY.has, self.specialised(scene, samples)))

    @cached_property
    def for_all_scenes(self) -> list[str]:
        """The identities of kernels that are enough for all scenes, some of which single precision cannot draw."""
        wanted = ("full", "double"), ("full", self.precision)
        full = [each for each in generic_kernels.GENERIC_KERNELS if each[:2] in wanted]
        return [*map(LIBRARY.identity, packing_calls()), *map(generic_identity, full)]

    def specialised(self, scene: Scene, samples: object = None) -> list[str]:
        """Return the identities of the specialised kernels for a scene with so many samples."""
        key = features(scene, samples), some_primitives(scene) > SMALL
        if key not in self.specialised_kernels:
            calls = calls_for(scene, self.precision, self.depth, samples)
            self.specialised_kernels[key] = list(map(LIBRARY.identity, calls))
        return self.specialised_kernels[key]

    def compile(self, scene: Scene, samples: object = None) -> None:
        """Compile the missing specialised kernels for a scene with so many samples, in two processes. RenderError
        where that fails."""
        if not scene.runs:
            return
        *packing, drawing = self.specialised(scene, samples)
        pool = ThreadPoolExecutor(1)
        try:
            beside = pool.submit(LIBRARY.compile, packing, self.packing_process)
            LIBRARY.compile([drawing], self.compile_process)
            beside.result()
        except BaseException:  # such as an interrupt, which should not wait for the other process
            self.packing_process.stop()
            raise
        finally:
            pool.shutdown(wait=False)

    def stop(self) -> None:
        self.compile_process.stop()
        self.packing_process.stop()
        self.background.stop()


# The kernels that a scene needs, found without rendering it, by a small scene that needs the same ones.


def some_primitives(scene: Scene) -> int:
    """Count the primitives of a scene, at least up to `SMALL` and one: shapes, and for each mesh its triangles."""
    return sum(shape.parts for shape in islice(chain.from_iterable(scene.runs), SMALL + 1))


def minimal_scene(scene: Scene) -> Scene:
    """Return a scene of few shapes that needs the same kernel, to compile it for."""
    shapes = [shape.some(np.arange(1)) for shape in examples(scene).values()]
    more = min(some_primitives(scene), SMALL + 1) - len(shapes)
    background = (scene.background,) if scene.background else ()
    return Scene((scene.camera.as_kind(Camera), *background, *scene.lights, *shapes, *shapes[:1] * more), scene.file)


# With so many shapes parallel light needs a BVH.
EXAMPLE = "A 1 255,255,255\nC 0,0,-9 0,0,1 60\ndl 0,-1,0 1 255,255,255\n" + "sp 0,0,0 1 255,255,255\n" * 9
PIXEL = np.zeros((1, 1, 4), np.uint8)


def calls_for(scene: Scene, precision: str, depth: int, samples: object = None) -> list[Call]:
    """Return calls of the kernels for a scene: of those that pack it, find contrast and copy levels, and at last of the
    specialised one that draws it. `samples` are those of `features`."""
    recorder = CallRecorder()
    with np.errstate(all="ignore"):  # as the compiled functions do, which are interpreted here
        arrays = Packing(recorder, precision, depth).pack(minimal_scene(scene), 1, 1, samples=samples)
    _, counter, binning, starts, members, *_ = recorder.calls["pack_frame"][1]  # as of `Bins.packing`
    project, move = (
        functions.project_shapes.call(counter, binning),
        functions.move_shape.call(0, binning, starts, members),
    )
    others = [project, move, classify_call(), functions.copy_levels.call(np.zeros(1, np.int64), PIXEL[0], PIXEL[0])]
    if any(isinstance(shape, Mesh) for shape in examples(scene).values()):
        others.append(READ.call(call_for(b"")))
    return [*recorder.calls.values(), *others, functions.frame.call(*frame_arguments(arrays, PIXEL))]


def generic_call(generic: GenericKernel) -> Call:
    """Return a call of a generic kernel, for a scene without lights and shapes."""
    return functions.frame.call(*frame_arguments(generic_kernels.empty_arrays(generic), PIXEL))


@cache
def generic_identity(generic: GenericKernel) -> str:
    """Return the name of a generic kernel in the library of compiled code."""
    return LIBRARY.identity(generic_call(generic))


def packing_calls() -> list[Call]:
    """Return calls of all functions beside those that draw, whose types are the same for all scenes."""
    *packing, _ = calls_for(parse(EXAMPLE).scene, "double", DEPTH)
    numbers, integers, table, corners = np.zeros(0), np.zeros(0, np.int64), np.zeros((0, 0)), np.zeros((0, 0), np.int32)
    placing = functions.place_triangles.call(integers, numbers, table, table, 0, corners, table, table)
    return [*packing, placing, READ.call(call_for(b"")), fast.call_for(b"", 0)]


def ray_query() -> Call:
    """Return a call of the query for single rays, for all kinds of shapes."""
    vectors, numbers, integers = np.zeros((0, 3)), np.zeros(0), np.zeros(0, np.int64)
    tree = generic_kernels.empty_arrays(generic_kernels.FULL_DOUBLE).bvh
    return functions.trace_rays.call(integers, tree, vectors, vectors, numbers, integers, vectors, vectors)


class CallRecorder:
    """The functions that pack a scene, interpreted; their calls are recorded."""

    def __init__(self) -> None:
        self.calls: dict[str, Call] = {}

    def __getattr__(self, name: str) -> Callable[..., Any]:
        compiled, function = getattr(functions, name), getattr(interpreted, name)

        def run(*arguments: Any) -> Any:
            self.calls[name] = compiled.call(*arguments)
            return function(*arguments)

        return run
