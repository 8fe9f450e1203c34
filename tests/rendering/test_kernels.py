"""Choice of kernels: the narrow one where it is there, else a wide one until the narrow one has been compiled."""

from __future__ import annotations

from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.kernel.machine_code import functions, shipped_code
from minirt.kernel.machine_code.code_cache import CodeCache
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY, Library
from minirt.materials import Checker
from minirt.rendering import Renderer, kernels
from minirt.rendering.culling.visibility import SMALL
from minirt.rendering.frame import Frame, frame_arguments
from minirt.rendering.kernels import Choice, Kernels, wide_identity
from minirt.rendering.needed_kernels import kernel_features, minimal_scene, packing_calls
from minirt.rendering.notes import NO_WIDE_KERNEL
from minirt.rendering.packing.generic import WIDE_KERNELS, WideKernel
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Light, ParallelLight, Scene, parse
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.mesh import Mesh
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import ALL, EYE, SHAPES
from tests.meshes.examples import GREY, named
from tests.skipping import skip_incomplete
from tests.waiting import HANG_LIMIT, until

VIEW = "A 0.2 255,255,255\nC 0,0,-4 0,0,1 60\nL 5,5,-5 0.7 255,255,255\n"
BALL = parse(f"{VIEW}sp 0,0,0 2 255,60,60\n").scene
SHINY = parse(f"{VIEW}sp 0,0,0 2 255,60,60 specular:0.5,20\n").scene


def frame_of(scene: Scene, precision: str = "double") -> Frame:
    """Return the arguments of a frame."""
    arrays = Packing(precision=precision).pack(scene, 8, 8)
    return frame_arguments(arrays, np.zeros((8, 8, 4), np.uint8))


class FakeLibrary:
    """A library in which only some kernels can be found: an entry is its identity."""

    def __init__(self, *found: str) -> None:
        self.found = list(found)
        self.identity = Library().identity
        self.compiled: list[str] = []

    def find(self, identity: str) -> Any:
        return identity if identity in self.found else None

    def has(self, identity: str) -> bool:
        return identity in self.found

    def get(self, call: Any) -> Any:
        self.compiled.append(self.identity(call))
        return self.identity(call)


def narrow_identity(scene: Scene, precision: str = "double") -> str:
    """Return the identity of the narrow kernel of a scene."""
    return Library().identity(functions.frame.call(*frame_of(scene, precision)))


def choose(monkeypatch: pytest.MonkeyPatch, scene: Scene, *found: str, precision: str = "double") -> Choice:
    """Return the choice of a kernel for a scene where only some can be found."""
    monkeypatch.setattr(kernels, "LIBRARY", FakeLibrary(*found))
    return Kernels(precision, 8).choose(frame_of(scene, precision))


WIDE = {wide: wide_identity(wide) for wide in WIDE_KERNELS}


def wide(name: str, precision: str) -> WideKernel:
    """Return a wide kernel."""
    (found,) = (each for each in WIDE_KERNELS if (each.name, each.precision) == (name, precision))
    return found


def test_the_narrowest_kernel_that_is_there_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    narrow = narrow_identity(BALL)
    assert choose(monkeypatch, BALL, narrow, *WIDE.values()).wide is None
    assert choose(monkeypatch, BALL, *WIDE.values()).wide == wide("plain", "double")
    assert choose(monkeypatch, SHINY, *WIDE.values()).wide == wide("full", "double")
    assert choose(monkeypatch, BALL, *WIDE.values(), precision="single").wide == wide("plain", "single")
    assert choose(monkeypatch, BALL, WIDE[wide("full", "double")]).wide == wide("full", "double")


def test_a_wide_kernel_gets_the_scene_in_its_form(monkeypatch: pytest.MonkeyPatch) -> None:
    choice = choose(monkeypatch, BALL, *WIDE.values())
    frame = frame_of(BALL)._replace(scene=choice.scene)
    assert Library().identity(functions.frame.call(*frame)) == WIDE[wide("plain", "double")]


def test_without_any_the_narrow_one_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    choice = choose(monkeypatch, BALL, WIDE[wide("full", "single")])
    assert (choice.wide, choice.entry) == (None, narrow_identity(BALL))
    library: Any = kernels.LIBRARY
    assert library.compiled == [narrow_identity(BALL)]


def test_specialising_compiles_the_narrow_kernel_though_a_wide_one_fits(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled: list[str] = []
    library: Any = FakeLibrary(*WIDE.values())
    library.compile = lambda identities, _process: compiled.extend(identities)
    monkeypatch.setattr(kernels, "LIBRARY", library)
    renderer = Renderer(1)
    monkeypatch.setattr(renderer, "prepare", lambda _scene: None)
    renderer.specialise(BALL)
    assert narrow_identity(BALL) in compiled


def test_a_narrow_kernel_is_compiled_once_that_is_worth_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    choice = choose(monkeypatch, BALL, *WIDE.values())
    asked: list[str] = []
    for after, seconds in ((kernels.NARROW_AFTER, kernels.NARROW_AFTER / 2), (0.0, 0.0)):
        mine = Kernels("double", 8)
        mine.narrow_after = after
        monkeypatch.setattr(mine.background, "compile", asked.append)
        mine.count(choice, seconds)
        assert asked == [choice.narrow] * (not after)
        mine.count(choice, seconds)
        assert set(asked) == {choice.narrow}
        asked.clear()


def test_a_scene_is_ready_where_wide_kernels_are(monkeypatch: pytest.MonkeyPatch) -> None:
    packing = [Library().identity(each) for each in packing_calls()]
    narrow = [Library().identity(functions.frame.call(*frame_of(BALL)))]
    for found, ready in (
        ([*packing, WIDE[wide("full", "double")]], True),
        ([*packing, WIDE[wide("plain", "double")]], False),
        ([WIDE[wide("full", "double")]], False),
        ([*packing, *narrow], True),
        ([], False),
    ):
        monkeypatch.setattr(kernels, "LIBRARY", FakeLibrary(*found))
        assert Kernels("double", 8).is_ready(BALL) is ready
    assert Kernels("double", 8).is_ready(Scene(BALL.elements[:3]))


def test_the_notes_say_where_no_wide_kernel_fits(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    library = empty_library(monkeypatch, tmp_path)
    renderer = Renderer(1)
    picture(renderer)
    assert NO_WIDE_KERNEL not in renderer.notes
    monkeypatch.setattr(library, "has", lambda _identity: False)
    assert NO_WIDE_KERNEL in renderer.notes


def empty_library(monkeypatch: pytest.MonkeyPatch, folder: Path) -> Library:
    """Let renderers use a library that has the kernels of the package and none of the user's."""
    library = Library()
    library.cache = CodeCache(folder)
    for module in (functions, kernels, kernels):
        monkeypatch.setattr(module, "LIBRARY", library)
    if not all(library.find(each) for each in WIDE.values()):
        skip_incomplete("wide kernels are not compiled: make all")
    return library


def picture(renderer: Renderer) -> bytes:
    """Render the ball into the bytes of its pixels."""
    pixels = np.zeros((60, 80, 4), np.uint8)
    assert renderer.render(BALL, pixels)
    return pixels.tobytes()


def test_the_narrow_kernel_is_swapped_in_and_draws_the_same_bits(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    library = empty_library(monkeypatch, tmp_path)
    renderer = Renderer(2)
    before = picture(renderer)
    assert renderer.runner.choice
    assert renderer.runner.choice.wide
    assert renderer.notes[0].startswith("wide kernel for all kinds of shapes")
    compiled = Event()
    renderer.specialise_early(compiled.set)
    picture(renderer)
    assert compiled.wait(HANG_LIMIT)
    until(lambda: library.find(narrow_identity(BALL)) is not None, "the narrow kernel")
    assert picture(renderer) == before
    assert renderer.runner.choice.wide is None
    assert renderer.notes[0] == "kernel for spheres"


def test_the_background_compiler_has_the_lowest_priority() -> None:
    assert kernels.BackgroundCompiler().process.patient


def test_a_wide_kernel_stays_where_the_narrow_one_cannot_be_compiled(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    empty_library(monkeypatch, tmp_path)
    asked: list[Any] = []

    def fail(_self: CompileProcess, requests: list[str], _target: str | None = None) -> None:
        asked.append(requests)
        raise RenderError("no compiler")

    monkeypatch.setattr(CompileProcess, "compile", fail)
    renderer = Renderer(2)
    renderer.specialise_early()
    before = picture(renderer)
    until(lambda: not renderer.kernels.background.busy, "the end of the attempt")
    assert picture(renderer) == before
    until(lambda: not renderer.kernels.background.busy, "the end of a second attempt")
    assert asked == [[narrow_identity(BALL)]]
    assert renderer.runner.choice
    assert renderer.runner.choice.wide


def test_the_package_has_the_wide_kernels_for_this_machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    library = empty_library(monkeypatch, tmp_path)
    identities = [*WIDE.values(), *map(library.identity, packing_calls())]
    assert all(shipped_code.read(each) for each in identities)


# Kernels: which scenes share one, and the minimal scene that it is compiled for.


LIGHT = Ambient(0.2, GREY)
SPHERE = Sphere((0, 0, 0), 1, GREY)
SUN = ParallelLight((0, -1, 0), 0.5)


def test_a_kernel_is_ready_for_all_scenes_of_its_kinds(monkeypatch: pytest.MonkeyPatch) -> None:
    renderer, there = Renderer(1), set[str]()
    monkeypatch.setattr(LIBRARY, "has", there.__contains__)
    assert renderer.is_ready(Scene((EYE,)))
    assert not renderer.is_ready(ALL)
    there.update(renderer.kernels.narrow(ALL))
    assert renderer.is_ready(ALL)
    assert renderer.is_ready(Scene((EYE, *SHAPES[:3])))
    assert not renderer.is_ready(Scene((EYE, SHAPES[0])))
    there.update(renderer.kernels.for_all_scenes)
    assert renderer.is_ready(Scene((EYE, SHAPES[0])))
    assert kernel_features(ALL) == {type(shape) for shape in SHAPES}


def test_the_minimal_scene_needs_the_same_kernel() -> None:
    balls = [Sphere((i, 0, 0), 1, GREY, mirror=0.5 if i == 70 else None) for i in range(100)]
    tube = Cylinder((0, 0, 0), (0, 1, 0), 1, 2, GREY, checker=Checker(0.1))
    for elements in ((SPHERE,), (*balls, tube, SUN), (*balls[: SMALL + 1], SUN), (SPHERE, SUN)):
        scene = Scene((LIGHT, EYE, *elements))
        assert kernel_features(minimal_scene(scene)) == kernel_features(scene)
        assert len(minimal_scene(scene).shapes) <= SMALL + 2
    assert "bvh" in kernel_features(Scene((LIGHT, EYE, *balls, SUN)))
    assert "bvh" not in kernel_features(Scene((LIGHT, EYE, *balls)))


def test_the_minimal_scene_of_a_large_mesh_is_small() -> None:
    scene = Scene((EYE, Light((5, 8, -9), 0.9), named("knot"), Sphere((0, 3, 0), 1, GREY), named("pot")))
    small = minimal_scene(scene)
    assert {type(shape) for shape in small.shapes} == {Mesh, Sphere}
    assert sum(shape.parts for shape in small.shapes) < 20
