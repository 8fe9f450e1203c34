"""Work on files of which any operation may fail: pictures, films, journals, a session in a window, a cache of kernels.

Each begins with the files of a folder, and is done in that folder. It ends in milliseconds: kernels are loaded, and
where they are compiled anew a function returns what was compiled before.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass, field
from functools import cache as kept_result
from functools import partial
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import minirt
from minirt import cli
from minirt.cli import render
from minirt.cluster import job, journal
from minirt.errors import MiniRTError
from minirt.formats.table import is_installed
from minirt.helpers.file_io import writing
from minirt.kernel.machine_code import cache
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY
from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from minirt.mlx.recording import add_recording
from minirt.movie import save_movie
from minirt.rendering import settings
from minirt.rendering.image import Image
from minirt.rendering.renderer import Renderer
from minirt.report import document
from minirt.report.document import report_files
from minirt.scene import load
from minirt.viewer import recovery
from minirt.viewer.app import desktop
from tests.cli.program import SCENE as BALL
from tests.faults.supervised import run
from tests.report.made_up import FINDINGS, ROWS

Files = dict[str, bytes]  # contents by path in the folder

OLD = b"an old file\n" * 50
SCENE = """A 0.2 255,255,255
C 0,0,-5 0,0,1 70
L -4,3,-3 0.7 255,255,255
sp 0,0,0 2 255,255,255 texture:dots.png
pl 0,-1,0 0,1,0 200,200,200
ob corner.obj 1,1,0 1 200,100,0
"""
CORNER = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
CACHE = "cache"
RESUMED = [f"resumed {each}{torn}" for each in ("picture", "film", "numbered", "streamed") for torn in ("", ", torn")]
KEYS = ["press n", "press Ctrl+S", "press Ctrl+Shift+S", "press P", "wait 0.2"]
SIZE = "--size", "8x80"
SPIN = "--size", "12x10", "--turntable", "3"


@dataclass
class Workload:
    """Some work, and what it may do."""

    name: str
    work: Callable[[], int]  # done in the folder; returns an exit status
    files: Files = field(default_factory=dict)  # besides the scene and what it names
    may_leave: tuple[str, ...] = ()  # patterns of further files
    may_miss: str = ""  # pattern of files that may not be written
    is_exact: bool = True  # the files are those of a run without faults, and the same work once more makes them


def program(*arguments: str) -> int:
    """Call the program with arguments."""
    return cli.main(["scene.rt", *arguments])


def library(write: Callable[[], object]) -> int:
    """Call a function of the library that writes files; return an exit status."""
    try:
        write()
    except MiniRTError as error:
        return cli.failed(error)
    return 0


def film(name: str) -> None:
    """Write a film, or a picture, of light that moves."""
    light = np.random.default_rng(1).random((18, 32, 3))
    levels = (255 * light).astype(np.uint8)
    save_movie((Image(np.roll(levels, 5 * n, axis=1), light) for n in range(3)), Path(name))


@kept_result
def report() -> dict[str, bytes]:
    """Draw a report, which takes a second, once."""
    return report_files(FINDINGS, {ROWS[0].name: DARK}, DARK)


# A picture of several bands, and what the command line does not write.
DARK = np.zeros((20, 32, 3))
STREAMED = partial(library, lambda: minirt.render_to("out.tif", minirt.load("scene.rt"), 8, 80, samples=4))
WRITTEN: dict[str, Callable[[], object]] = {
    "report": lambda: document.write_files(Path(), FINDINGS, {}, DARK),
    "exr": lambda: Image(np.zeros((18, 32, 3), np.uint8), np.ones((18, 32, 3))).save("out.exr"),
    "webp": partial(film, "out.webp"),
    **({"mp4": partial(film, "out.mp4")} if is_installed("MP4") else {}),
}


def session() -> int:
    """Open a scene with unsaved changes of a killed program, take them, edit and save, and leave with new changes."""
    memory = Memory()
    add_recording(["press Ctrl+R", *KEYS, "press n", "close"], "keys", memory)
    how: Any = {"renderer": Renderer(threads=1), "size": (48, 32), "mlx": Mlx(memory)}
    try:
        return desktop.run(load("scene.rt").scene, path="scene.rt", **how)
    except MiniRTError as error:
        return cli.failed(error)


def leave_changes() -> int:
    """Leave unsaved changes, as a program does that is killed."""
    saved, kept = load("scene.rt").scene, recovery.Recovery()
    kept.keep(recovery.Version(saved.replace(saved.spheres[0], diameter=3.0), saved, Path("scene.rt")))
    return 0


class ImmediateTimer:
    """A timer that does not wait."""

    daemon = True

    def __init__(self, _: float, function: Callable[[], object]) -> None:
        self.start = function

    def cancel(self) -> None:
        pass


@contextmanager
def surroundings(folder: Path) -> Iterator[pytest.MonkeyPatch]:
    """Let work of this process be cut into small bands that are all kept, and have its own folders of the user."""
    with pytest.MonkeyPatch.context() as patch:
        for name in ("state", "config"):
            patch.setenv(f"XDG_{name.upper()}_HOME", str(folder / name))
        elsewhere = folder.with_name("elsewhere")
        elsewhere.mkdir(exist_ok=True)
        patch.setattr(tempfile, "tempdir", str(elsewhere))
        patch.setattr(render, "LONG", 0)
        patch.setattr(job, "RAYS", 8 * 16 * 4)
        patch.setattr(journal, "SHARE", 1e9)
        patch.setattr(recovery.threading, "Timer", ImmediateTimer)
        patch.setattr(writing, "SWEPT", set())
        patch.setattr(document, "report_files", lambda *_: report())
        yield patch


def with_own_cache(codes: dict[str, cache.ObjectCode]) -> int:
    """Render a picture in a child process that finds kernels in its own cache alone, and compiles none really."""
    for each in (LIBRARY.entries, LIBRARY.seen, LIBRARY.missing):
        each.clear()
    vars(LIBRARY).pop("cache", None)
    os.environ["XDG_CACHE_HOME"] = str(Path(CACHE).absolute())
    vars(cache)["SHIPPED"] = Path("nothing").absolute()
    CompileProcess.compile = lambda _, requests, target=None: [codes[each] for each in requests]  # type: ignore[method-assign]
    return cli.main(["ball.rt", *SIZE, "-o", "out.png"])


def interrupted(work: Callable[[], int], last: int) -> int:
    """Do work until the program renders a picture or a band with a number."""
    rendered, count = settings.rendered, iter(range(1, 1000))

    def until_last(*arguments: Any) -> Any:
        if next(count) == last:
            raise KeyboardInterrupt
        return rendered(*arguments)

    settings.rendered = until_last
    try:
        return work()
    except KeyboardInterrupt:  # of a function of the library
        return 130


NAMES = ("picture", "film", "numbered", "streamed", "replay", *WRITTEN, *RESUMED,
         "no kernels", "kept kernels", "damaged kernels", "session")  # fmt: skip
PICTURE = partial(program, *SIZE, "--samples", "4", "-o", "out.png")
FILM = partial(program, *SPIN, "-o", "out.gif")
NUMBERED = partial(program, *SPIN, "-o", "out.png")


class Laboratory:
    """A folder in which workloads are done, and what they need."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "work"
        dots = minirt.render(minirt.loads("A 1 255,255,255\nC 0,0,0 0,0,1 60\nsp 0,0,5 4 255,0,0\n"), 8, 8).encode()
        self.base: Files = {"scene.rt": SCENE.encode(), "corner.obj": CORNER, "dots.png": dots}
        self.base["config/minirt/config.toml"] = b"threads = 1\n"

    def workloads(self) -> list[Workload]:
        """Return all workloads. They are done once in this process, so that nothing is imported in a child."""
        olds = {f"out{each}": OLD for each in (".png", ".gif", ".tif", "-0001.png", "-0002.png", "-0003.png")}
        journals = (".out.*.journal",)
        replay = partial(program, "--size", "32x24", "--replay", "keys.txt")
        simple = [
            Workload("picture", PICTURE, olds, journals),
            Workload("film", FILM, olds, journals),
            Workload("numbered", NUMBERED, olds, journals),
            Workload("streamed", STREAMED, olds, journals),
            Workload("replay", replay, {"keys.txt": "\n".join(KEYS).encode()}, is_exact=False),
        ]
        for name, write in WRITTEN.items():
            work = partial(library, write)
            simple.append(Workload(name, work, dict.fromkeys(self.after(work, {}), OLD), is_exact=name != "mp4"))
        for each in simple:
            self.do_here(each)
        return [*simple, *self.resumed(olds), *self.with_cache(olds), self.in_window()]

    def resumed(self, olds: Files) -> Iterator[Workload]:
        """Yield workloads that go on with what an interrupted program has left, whole or torn."""
        works = {"picture": PICTURE, "film": FILM, "numbered": NUMBERED, "streamed": STREAMED}
        for name, first in works.items():
            again = STREAMED if first is STREAMED else partial(first, "--resume")
            files = self.after(partial(interrupted, first, 3), olds)
            (kept,) = (each for each in files if each.endswith(".journal"))
            yield Workload(f"resumed {name}", again, files, (kept,))
            yield Workload(f"resumed {name}, torn", again, files | {kept: files[kept][:-7]}, (kept,))

    def with_cache(self, olds: Files) -> Iterator[Workload]:
        """Yield workloads that keep kernels on disk, and find them there, whole or damaged."""
        scene, codes = minirt.loads(BALL), {}
        kernels = Renderer(threads=1).kernels
        kernels.compile(scene)
        for identity in kernels.specialised(scene):
            code = LIBRARY.code(identity)
            assert code
            codes[identity] = code
        work = partial(with_own_cache, codes)
        given = olds | {"ball.rt": BALL.encode()}
        kept = {name: data for name, data in self.after(work, given).items() if name.startswith(CACHE)}
        damaged = {name: OLD if name.endswith(".kernel") else data for name, data in kept.items()}
        for name, files in (("no kernels", {}), ("kept kernels", kept), ("damaged kernels", damaged)):
            yield Workload(name, work, given | files, (".out.*.journal", f"{CACHE}/*.lock"), f"{CACHE}/*.kernel")

    def in_window(self) -> Workload:
        """Return the session in a window."""
        found = Workload("session", session, self.after(leave_changes, {}), ("*/unsaved/*.lock",), "*", is_exact=False)
        self.do_here(found)
        return found

    def prepare(self, files: Files) -> Path:
        """Let the folder hold these files alone, besides the scene and what it names; return it."""
        shutil.rmtree(self.folder, ignore_errors=True)
        for name, data in (self.base | files).items():
            path = self.folder / name
            path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            path.write_bytes(data)
        return self.folder

    def do_here(self, workload: Workload) -> None:
        """Do a workload in this process; it must end well."""
        folder = self.prepare(workload.files)
        with surroundings(folder) as patch, redirect_stdout(StringIO()):
            patch.chdir(folder)
            assert workload.work() == 0, workload.name

    def after(self, work: Callable[[], int], files: Files) -> Files:
        """Return the files after some work in a child process, without those that it did not change."""
        folder = self.prepare(files)
        with surroundings(folder):
            ended = run(work, folder)
        assert ended.status in (0, 130), ended
        return {name: data for name, data in contents(folder).items() if self.base.get(name) != data}


def contents(folder: Path) -> Files:
    """Return the files of a folder and of the folders in it."""
    return {each.relative_to(folder).as_posix(): each.read_bytes() for each in folder.rglob("*") if each.is_file()}
