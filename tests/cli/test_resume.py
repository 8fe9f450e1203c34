"""Interrupted work is kept, and `--resume` goes on with it: the result has the same bytes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import minirt
from minirt.cli import render
from minirt.cluster import job, journal
from minirt.rendering import settings
from tests.cli.program import SCENE, Run

STILL = ("ball.rt", "--size", "40x80", "--samples", "4", "-o", "x.png")
FILM = ("ball.rt", "--size", "40x30", "--turntable", "5", "-o", "x.gif")
NUMBERED = (*FILM[:-1], "x.png")
EVERY = pytest.mark.parametrize("arguments", [STILL, FILM, NUMBERED], ids=["still", "film", "numbered"])


@pytest.fixture(autouse=True)
def _small_work_is_long(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(render, "LONG", 0)
    monkeypatch.setattr(job, "RAYS", 40 * 16 * 4)
    monkeypatch.setattr(journal, "SHARE", 1e9)


class Renders:
    """Counts the pictures and strips that are rendered, and interrupts one."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.count, self.last, self.render = 0, 0, settings.rendered
        monkeypatch.setattr(settings, "rendered", self)

    def __call__(self, *arguments: Any, **settings: Any) -> Any:
        self.count += 1
        if self.count == self.last:
            raise KeyboardInterrupt
        return self.render(*arguments, **settings)

    def until(self, last: int) -> None:
        """Begin to count anew, and interrupt the program when it renders a number `last`."""
        self.count, self.last = 0, last


@pytest.fixture
def renders(monkeypatch: pytest.MonkeyPatch) -> Renders:
    return Renders(monkeypatch)


def contents(folder: Path) -> dict[str, bytes]:
    """The files that the program has written, by their names."""
    return {file.name: file.read_bytes() for file in folder.iterdir() if file.suffix != ".rt"}


def undisturbed(run: Run, folder: Path, arguments: tuple[str, ...]) -> dict[str, bytes]:
    """The files of a run without an interrupt, which are deleted."""
    assert run(*arguments) == (0, b"", "")
    written = contents(folder)
    assert not any(name.startswith(".") for name in written)
    for name in written:
        (folder / name).unlink()
    return written


@EVERY
def test_an_interrupted_program_goes_on(run: Run, folder: Path, renders: Renders, arguments: tuple[str, ...]) -> None:
    wanted = undisturbed(run, folder, arguments)
    parts = renders.count
    assert parts == 5
    renders.until(4)
    status, out, err = run(*arguments)
    assert (status, out) == (130, b"")
    what = "bands of the picture" if arguments is STILL else "pictures of the film"
    assert err == f"3 of 5 {what} are kept in .{arguments[-1]}.journal; miniRT {' '.join(arguments)} --resume goes on\n"
    renders.until(2)  # is interrupted again
    again = run(*arguments, "--resume")
    assert (again.status, again.err) == (130, err.replace("3 of", "4 of"))
    renders.until(0)
    assert run(*arguments, "--resume") == (0, b"", "")
    assert renders.count == 1
    assert contents(folder) == wanted


@EVERY
def test_without_resume_the_work_begins_anew(
    run: Run, folder: Path, renders: Renders, arguments: tuple[str, ...]
) -> None:
    wanted = undisturbed(run, folder, arguments)
    renders.until(3)
    assert run(*arguments).status == 130
    assert any(name.endswith(".journal") for name in contents(folder))
    renders.until(0)
    assert run(*arguments) == (0, b"", "")
    assert renders.count == 5
    assert contents(folder) == wanted


CHANGES = {
    "size": ("--size", "40x81"),
    "samples": ("--samples", "5"),
    "tone": ("--tone", "srgb"),
    "dithering": ("--dither",),
    "region": ("--region", "0,0,40,80"),
    "depth": ("--depth", "2"),
}


@pytest.mark.parametrize("change", [*CHANGES, "scene", "texture", "kernel"])
def test_what_was_left_by_other_work_is_refused(
    run: Run, folder: Path, renders: Renders, change: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "ball.rt").write_text(SCENE.replace("10,0,255", "10,0,255 texture:dots.png"))
    minirt.Image(minirt.render(minirt.loads(SCENE), 8, 6).array).save(folder / "dots.png")
    renders.until(3)
    assert run(*STILL).status == 130
    left = (folder / ".x.png.journal").read_bytes()
    if change == "scene":
        (folder / "ball.rt").write_text((folder / "ball.rt").read_text().replace("-4,3,-3", "-4,3,-2"))
    elif change == "texture":
        minirt.Image(minirt.render(minirt.loads(SCENE), 9, 6).array).save(folder / "dots.png")
    elif change == "kernel":
        monkeypatch.setattr(job, "__version__", "0.0.1")
    renders.until(0)
    ended = run(*STILL, *CHANGES.get(change, ()), "--resume")
    assert ended.status == 1
    assert ".x.png.journal: was left by another scene, other settings or another version" in ended.err
    assert (folder / ".x.png.journal").read_bytes() == left
    assert renders.count == 0


def test_one_thread_goes_on_with_what_two_have_done(run: Run, folder: Path, renders: Renders) -> None:
    wanted = undisturbed(run, folder, STILL)
    renders.until(3)
    run(*STILL, "--threads", "2")
    renders.until(0)
    assert run(*STILL, "--threads", "1", "--resume").status == 0
    assert contents(folder) == wanted


def test_a_numbered_picture_that_was_deleted_is_written_again(run: Run, folder: Path, renders: Renders) -> None:
    wanted = undisturbed(run, folder, NUMBERED)
    renders.until(4)
    run(*NUMBERED)
    (folder / "x-0001.png").unlink()
    renders.until(0)
    assert run(*NUMBERED, "--resume").status == 0
    assert renders.count == 3
    assert contents(folder) == wanted


def test_linear_light_is_kept_to_the_bit(run: Run, folder: Path, renders: Renders) -> None:
    for name in ("x.exr", "x.tif"):
        arguments = (*STILL[:-1], name, *(("--bits", "16") if name == "x.tif" else ()))
        wanted = undisturbed(run, folder, arguments)
        renders.until(4)
        run(*arguments)
        renders.until(0)
        assert run(*arguments, "--resume").status == 0
        assert contents(folder) == wanted
        (folder / name).unlink()


def test_parts_are_not_kept_where_that_takes_longer_than_they_are_worth(
    run: Run, folder: Path, renders: Renders, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(journal, "SHARE", 0.0)
    renders.until(4)
    ended = run(*STILL)
    assert ended.err.startswith("1 of 5 bands of the picture is kept")  # the first, whose cost nobody knew
    renders.until(0)
    assert run(*STILL, "--resume").status == 0
    assert renders.count == 4


def test_short_work_leaves_nothing_and_removes_what_was_left(
    run: Run, folder: Path, renders: Renders, monkeypatch: pytest.MonkeyPatch
) -> None:
    renders.until(3)
    run(*STILL)
    monkeypatch.setattr(render, "LONG", 2**24)
    renders.until(1)
    assert run(*STILL) == (130, b"", "")
    assert not contents(folder)


def test_resume_without_a_left_over_says_so(run: Run, folder: Path) -> None:
    ended = run(*STILL, "--resume")
    assert ended.status == 0
    assert ended.err == "notice: there is nothing to go on with, x.png is rendered from the beginning\n"
