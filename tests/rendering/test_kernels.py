"""Choice of kernels: the specialised one where it is there, else a generic one until it has been compiled."""

from __future__ import annotations

import json
from pathlib import Path
from threading import Event, Lock
from typing import Any

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.kernel import functions
from minirt.kernel.machine_code import cache
from minirt.kernel.machine_code import library as libraries
from minirt.kernel.machine_code.cache import CodeCache, ObjectCode
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.fingerprint import fingerprint_of, processor
from minirt.kernel.machine_code.library import Library, identity_of
from minirt.materials import Checker
from minirt.rendering import ahead_of_time, kernels
from minirt.rendering import renderer as renderers
from minirt.rendering.frame import Frame, frame_arguments
from minirt.rendering.kernels import (
    KernelChoice,
    Kernels,
    generic_call,
    generic_identity,
    minimal_scene,
    packing_calls,
    some_primitives,
)
from minirt.rendering.notes import NO_GENERIC_KERNEL
from minirt.rendering.packing.features import DEPTH, features
from minirt.rendering.packing.generic_kernels import GENERIC_KERNELS, GenericKernel
from minirt.rendering.packing.light_buffers import SMALL
from minirt.rendering.renderer import Renderer
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Light, ParallelLight, Scene, parse
from minirt.shapes import Cylinder, Mesh, Sphere
from tests.kernel.pictures import EYE
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


def specialised_identity(scene: Scene, precision: str = "double") -> str:
    """Return the identity of the specialised kernel of a scene."""
    return Library().identity(functions.frame.call(*frame_of(scene, precision)))


def choose(monkeypatch: pytest.MonkeyPatch, scene: Scene, *found: str, precision: str = "double") -> KernelChoice:
    """Return the choice of a kernel for a scene where only some can be found."""
    monkeypatch.setattr(kernels, "LIBRARY", FakeLibrary(*found))
    return Kernels(precision, 8).choose(frame_of(scene, precision))


GENERIC = {generic: generic_identity(generic) for generic in GENERIC_KERNELS}


def generic(name: str, precision: str) -> GenericKernel:
    """Return a generic kernel."""
    (found,) = (each for each in GENERIC_KERNELS if (each.name, each.precision) == (name, precision))
    return found


def test_the_most_specialised_kernel_that_is_there_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    specialised = specialised_identity(BALL)
    assert choose(monkeypatch, BALL, specialised, *GENERIC.values()).generic is None
    assert choose(monkeypatch, BALL, *GENERIC.values()).generic == generic("plain", "double")
    assert choose(monkeypatch, SHINY, *GENERIC.values()).generic == generic("full", "double")
    assert choose(monkeypatch, BALL, *GENERIC.values(), precision="single").generic == generic("plain", "single")
    assert choose(monkeypatch, BALL, GENERIC[generic("full", "double")]).generic == generic("full", "double")


def test_without_any_the_specialised_one_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    choice = choose(monkeypatch, BALL, GENERIC[generic("full", "single")])
    assert (choice.generic, choice.entry) == (None, specialised_identity(BALL))
    library: Any = kernels.LIBRARY
    assert library.compiled == [specialised_identity(BALL)]


def test_specialising_compiles_the_specialised_kernel_though_a_generic_one_fits(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    compiled: list[str] = []
    library: Any = FakeLibrary(*GENERIC.values())
    library.compile = lambda identities, _process: compiled.extend(identities)
    monkeypatch.setattr(kernels, "LIBRARY", library)
    renderer = Renderer(1)
    monkeypatch.setattr(renderer, "prepare", lambda *_: None)
    renderer.specialise(BALL)
    assert specialised_identity(BALL) in compiled


def test_a_specialised_kernel_is_compiled_once_that_is_worth_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    choice = choose(monkeypatch, BALL, *GENERIC.values())
    asked: list[str] = []
    for after, seconds in ((0.5, 0.25), (0.0, 0.0)):
        mine = Kernels("double", 8)
        mine.specialised_after = after
        monkeypatch.setattr(mine.background, "compile", asked.append)
        mine.count(choice, seconds)
        assert asked == [choice.specialised] * (not after)
        mine.count(choice, seconds)
        assert set(asked) == {choice.specialised}
        asked.clear()


def test_a_scene_is_ready_where_generic_kernels_are(monkeypatch: pytest.MonkeyPatch) -> None:
    packing = [Library().identity(each) for each in packing_calls()]
    specialised = [Library().identity(functions.frame.call(*frame_of(BALL)))]
    for found, ready in (
        ([*packing, GENERIC[generic("full", "double")]], True),
        ([*packing, GENERIC[generic("plain", "double")]], False),
        ([GENERIC[generic("full", "double")]], False),
        ([*packing, *specialised], True),
        ([], False),
    ):
        monkeypatch.setattr(kernels, "LIBRARY", FakeLibrary(*found))
        assert Kernels("double", 8).is_ready(BALL) is ready
    assert Kernels("double", 8).is_ready(Scene(BALL.elements[:3]))


def test_the_notes_say_where_no_generic_kernel_fits(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    library = empty_library(monkeypatch, tmp_path)
    renderer = Renderer(1)
    picture(renderer)
    assert NO_GENERIC_KERNEL not in renderer.notes
    monkeypatch.setattr(library, "has", lambda _identity: False)
    assert NO_GENERIC_KERNEL in renderer.notes


def empty_library(monkeypatch: pytest.MonkeyPatch, folder: Path) -> Library:
    """Let renderers use a library that has the kernels of the package and none of the user's."""
    library = Library()
    library.cache = CodeCache(folder)
    for module in (libraries, kernels, renderers):
        monkeypatch.setattr(module, "LIBRARY", library)
    if not all(library.find(each) for each in GENERIC.values()):
        skip_incomplete("generic kernels are not compiled: make all")
    return library


def picture(renderer: Renderer) -> bytes:
    """Render the ball into the bytes of its pixels."""
    pixels = np.zeros((60, 80, 4), np.uint8)
    assert renderer.render(BALL, pixels)
    return pixels.tobytes()


class KeptKernels(CompileProcess):
    """Compiles only what the user's library lacks, which is there after the first run of the tests."""

    def compile(self, requests: list[str], target: str | None = None) -> list[ObjectCode]:
        usual = Library()
        usual.compile(requests, CompileProcess())
        return [code for code in map(usual.code, requests) if code]


def test_the_specialised_kernel_is_swapped_in_and_draws_the_same_bits(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    library = empty_library(monkeypatch, tmp_path)
    renderer = Renderer(2)
    renderer.kernels.background.process = KeptKernels()
    before = picture(renderer)
    assert renderer.runner.choice
    assert renderer.runner.choice.generic
    assert renderer.notes[0].startswith("generic kernel for all kinds of shapes")
    renderer.specialise_early()
    picture(renderer)
    until(lambda: library.find(specialised_identity(BALL)) is not None, "the specialised kernel")
    assert picture(renderer) == before
    assert renderer.runner.choice.generic is None
    assert renderer.notes[0] == "kernel for spheres"


def test_a_generic_kernel_stays_where_the_specialised_one_cannot_be_compiled(
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
    assert asked == [[specialised_identity(BALL)]]
    assert renderer.runner.choice
    assert renderer.runner.choice.generic


def test_the_package_has_the_generic_kernels_for_this_machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    library = empty_library(monkeypatch, tmp_path)
    identities = [*GENERIC.values(), *map(library.identity, packing_calls())]
    assert all(map(CodeCache(cache.SHIPPED / processor()).read, identities))


# Kernels: which scenes share one, and the minimal scene that it is compiled for.


LIGHT = Ambient(0.2, GREY)
SPHERE = Sphere((0, 0, 0), 1, GREY)
SUN = ParallelLight((0, -1, 0), 0.5)


def test_the_minimal_scene_needs_the_same_kernel() -> None:
    balls = [Sphere((i, 0, 0), 1, GREY, mirror=0.5 if i == 70 else None) for i in range(100)]
    tube = Cylinder((0, 0, 0), (0, 1, 0), 1, 2, GREY, checker=Checker(0.1))
    for elements in ((SPHERE,), (*balls, tube, SUN), (*balls[: SMALL + 1], SUN), (SPHERE, SUN)):
        scene = Scene((LIGHT, EYE, *elements))
        minimal = minimal_scene(scene)
        assert features(minimal) == features(scene)
        assert (some_primitives(minimal) > SMALL) is (some_primitives(scene) > SMALL)
        assert len(minimal.shapes) <= SMALL + 2


def test_the_minimal_scene_of_a_large_mesh_is_small() -> None:
    scene = Scene((EYE, Light((5, 8, -9), 0.9), named("knot"), Sphere((0, 3, 0), 1, GREY), named("pot")))
    small = minimal_scene(scene)
    assert {type(shape) for shape in small.shapes} == {Mesh, Sphere}
    assert sum(shape.parts for shape in small.shapes) < 20


# Compiling ahead of time: every generic kernel once, and none of older sources is left.


PROCESSOR = "x86-64-v3"


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Identities of the kernels that were compiled, by a compiler that makes no code."""
    done: list[str] = []
    lock = Lock()

    def compile(_self: CompileProcess, requests: list[str], target: str | None = None) -> list[ObjectCode]:
        assert target == PROCESSOR
        with lock:
            done.extend(requests)
        return [ObjectCode("entry", each.encode()) for each in requests]

    monkeypatch.setattr(CompileProcess, "compile", compile)
    return done


def test_every_generic_kernel_is_compiled_once(compiled: list[str], tmp_path: Path) -> None:
    number = len(GENERIC_KERNELS) + len(packing_calls()) + 1  # with the query for single rays
    assert ahead_of_time.build(tmp_path, PROCESSOR) == number
    assert len(set(compiled)) == len(compiled) == number == len(list(tmp_path.iterdir()))
    for generic in GENERIC_KERNELS:
        identity = identity_of(*generic_call(generic), fingerprint_of(PROCESSOR))
        assert CodeCache(tmp_path).read(identity) == ObjectCode("entry", identity.encode())
    assert ahead_of_time.build(tmp_path, PROCESSOR) == 0
    assert len(compiled) == number


def test_the_first_groups_can_draw_any_scene(compiled: list[str], tmp_path: Path) -> None:
    ahead_of_time.build(tmp_path, PROCESSOR, ahead_of_time.FIRST)
    needed = kernels.Kernels("double", DEPTH).for_all_scenes
    assert sorted(json.dumps(json.loads(each)[:2]) for each in compiled) == sorted(
        json.dumps(json.loads(each)[:2]) for each in needed
    )


def test_damaged_kernels_are_compiled_again_and_old_ones_deleted(compiled: list[str], tmp_path: Path) -> None:
    ahead_of_time.build(tmp_path, PROCESSOR)
    first, second, *_ = sorted(tmp_path.iterdir())
    first.write_bytes(first.read_bytes()[:-1])
    second.rename(tmp_path / "old.kernel")
    compiled.clear()
    assert ahead_of_time.build(tmp_path, PROCESSOR) == 2
    assert second.exists()
    assert not (tmp_path / "old.kernel").exists()


def test_an_error_is_told_and_leaves_no_file(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object) -> None:
        raise RenderError("no compiler")

    monkeypatch.setattr(CompileProcess, "compile", fail)
    monkeypatch.setattr(ahead_of_time, "SHIPPED", tmp_path)
    assert ahead_of_time.main() == 1
    assert capsys.readouterr().err == "Error\nno compiler\n"
    assert list(tmp_path.rglob("*.kernel")) == []


def test_an_interrupt_waits_for_no_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernels that pack a scene are compiled in another process, or are those that another program compiles."""
    chosen, goes_on = Kernels("double", DEPTH), Event()

    def compile_(_: object, process: CompileProcess) -> None:
        if process is chosen.compile_process:
            raise KeyboardInterrupt
        goes_on.wait(HANG_LIMIT)

    monkeypatch.setattr(kernels.LIBRARY, "compile", compile_)
    with pytest.raises(KeyboardInterrupt):
        chosen.compile(parse("A 1 9,9,9\nC 0,0,-9 0,0,1 60\nsp 0,0,0 1 9,9,9\n").scene)
    assert chosen.packing_process.stopped
    goes_on.set()
