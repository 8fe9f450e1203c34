"""The viewer with a painter in the background, on a window in memory: when it renders, and when it does not."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from minirt.errors import FileError, RenderError
from minirt.mlx import Key, Mlx
from minirt.mlx.memory import Memory
from minirt.viewer.app.session import Session
from minirt.viewer.display.adaptive_resolution import LONGEST
from minirt.viewer.display.background_painter import BackgroundPainter
from minirt.viewer.display.overlay import Level
from minirt.viewer.display.painter import Job, Outcome, Painter, paint
from tests.viewer.fake import MARK, FakeRenderer, colour_of, scene
from tests.waiting import HANG_LIMIT, until

SIZE = (64, 48)


class ByHand(Painter):
    """A painter whose pictures come when the test says so, and took as long as it says."""

    def __init__(self, notify) -> None:
        super().__init__(FakeRenderer(), notify)
        self.requests: list[Job] = []
        self.open: list[Job] = []

    @property
    def busy(self) -> bool:
        return bool(self.open or self.outcomes)

    def request(self, job: Job) -> None:
        self.requests.append(job)
        self.open = [job]

    def finish(self, seconds: float) -> None:
        (job,) = self.open
        self.open = []
        self.outcomes.append(replace(paint(self.renderer, job, job.base), seconds=seconds))
        self.notify()

    @property
    def divisors(self) -> list[int]:
        return [job.divisor for job in self.requests]

    @property
    def samples(self) -> list[int]:
        return [job.samples for job in self.requests]


class Bench:
    def __init__(self, painter=ByHand, samples: int = 1, memory: Memory | None = None) -> None:
        self.memory = memory or Memory()
        m = Mlx(self.memory)
        self.display = m.mlx_init()
        self.session = Session(
            m,
            self.display,
            scene(),
            path=Path("scene.rt"),
            size=SIZE,
            painter=painter,
            pick=lambda *_: None,
            samples=samples,
        )
        self.painter = self.session.pictures.painter
        self.memory.play()

    def finish(self, seconds: float) -> None:
        self.painter.finish(seconds)
        self.memory.play()

    def bare(self) -> None:
        """Show nothing but the picture."""
        self.session.screen.level = Level.NOTHING
        self.session.draw()
        self.memory.play()

    def tap(self, *keys: Key) -> None:
        self.memory.tap(*keys)
        self.memory.play()


def test_the_first_picture_is_fine_and_then_nothing_is_rendered():
    bench = Bench()
    assert bench.painter.requests == [Job(bench.session.state.scene, *SIZE)]
    bench.finish(10.0)
    bench.memory.wait(2)
    bench.memory.expose()
    bench.memory.motion(5, 5)
    bench.memory.minimise(True)
    bench.memory.minimise(False)
    bench.tap(Key.I)
    bench.tap(Key.H)
    bench.tap(Key.TAB)
    assert len(bench.painter.requests) == 1


def test_the_loop_sleeps_unless_a_key_is_held():
    bench = Bench()
    assert not bench.display.busy
    bench.memory.press(Key.D)
    bench.memory.play()
    assert bench.display.busy
    bench.memory.release(Key.D)
    bench.memory.play()
    assert not bench.display.busy
    bench.memory.press(Key.D)
    bench.memory.focus(False)
    bench.memory.play()
    assert not bench.display.busy


def test_slow_pictures_are_coarse_while_a_key_is_held_and_fine_afterwards():
    bench = Bench()
    bench.finish(LONGEST * 3)
    bench.memory.press(Key.D)
    for _ in range(2):
        bench.memory.wait(0.5)
        bench.memory.play()
        bench.finish(LONGEST * 3 / 4)
        assert not bench.painter.busy
    assert set(bench.painter.divisors[1:]) == {2}
    assert all(job.urgent for job in bench.painter.requests[1:])
    bench.memory.release(Key.D)
    bench.memory.play()
    assert bench.painter.requests[-1] == Job(bench.session.state.scene, *SIZE)
    bench.finish(LONGEST * 3)
    bench.memory.wait(1)
    bench.memory.play()
    assert not bench.painter.busy
    assert bench.session.pictures.latest.job == Job(bench.session.state.scene, *SIZE)


def test_a_press_is_shown_coarse_first_where_that_is_quicker():
    bench = Bench()
    bench.finish(LONGEST * 3)
    bench.tap(Key.D)
    bench.finish(LONGEST)
    bench.finish(LONGEST * 3)
    assert bench.painter.divisors == [1, 2, 1]
    assert not bench.painter.busy


def test_quick_pictures_stay_fine():
    bench = Bench()
    bench.finish(LONGEST / 2)
    bench.memory.press(Key.D)
    bench.memory.wait(0.5)
    bench.memory.release(Key.D)
    bench.memory.play()
    bench.finish(LONGEST / 2)
    assert set(bench.painter.divisors) == {1}


def test_what_does_not_move_is_refined_pass_by_pass_and_then_nothing_is_rendered():
    bench = Bench(samples=16)
    bench.bare()
    for marked in (0, 4, 16):
        bench.finish(0.001)
        shown = bench.memory.screenshot()
        assert (shown[0, :marked] == MARK).all()
        assert (shown[0, marked:] == colour_of(scene())).all()
        assert (shown[1:] == colour_of(scene())).all()
    bench.memory.wait(2)
    bench.memory.expose()
    bench.tap(Key.H)
    bench.tap(Key.TAB)
    assert bench.painter.samples == [1, 4, 16]
    assert bench.painter.divisors == [1, 1, 1]
    assert not bench.painter.busy
    assert not bench.display.busy


def test_what_moves_again_has_one_sample_at_once():
    bench = Bench(samples=16)
    bench.finish(0.001)
    bench.finish(0.001)
    bench.memory.press(Key.D)
    bench.memory.play()
    job = bench.painter.requests[-1]
    assert (job.samples, job.base, job.urgent, job.divisor) == (1, None, True, 1)
    bench.finish(0.001)
    assert (bench.session.picture == colour_of(bench.session.state.scene)).all()
    for _ in range(3):
        bench.memory.wait(0.5)
        bench.memory.play()
        bench.finish(0.001)
    assert set(bench.painter.samples[3:]) == {1}
    bench.memory.release(Key.D)
    bench.memory.play()
    while bench.painter.busy:
        bench.finish(0.001)
    assert bench.painter.samples[-3:] == [1, 4, 16]


def test_from_coarse_to_whole_to_refined():
    bench = Bench(samples=4)
    bench.finish(LONGEST * 3)
    bench.finish(LONGEST * 10)
    bench.tap(Key.D)
    while bench.painter.busy:
        bench.finish(LONGEST / 2)
    assert list(zip(bench.painter.divisors, bench.painter.samples, strict=True))[2:] == [(2, 1), (1, 1), (1, 4)]


def test_nothing_is_rendered_after_an_error_in_a_pass():
    bench = Bench(samples=16)
    bench.finish(0.001)
    bench.painter.renderer.error = RenderError("no more")
    bench.finish(0.001)
    assert bench.session.state.message == "no more"
    assert not bench.painter.busy
    assert (bench.session.picture == colour_of(scene())).all()


def test_no_picture_is_shown_half_made():
    renderer = FakeRenderer()
    renderer.gate.clear()
    bench = Bench(partial(BackgroundPainter, renderer), samples=16)
    bench.bare()
    renderer.gate.set()
    for n in range(1, 6):
        until(lambda n=n: len(renderer.rendered) == n, "a picture")
        renderer.gate.clear()

        def half_refined(n=n) -> bool:
            bench.memory.play()
            return len(renderer.refined) == n

        until(half_refined, "a pass")
        whole = bench.memory.screenshot()
        assert (whole == colour_of(bench.session.state.scene)).all()
        bench.tap(Key.D)
        renderer.gate.set()
        until(lambda n=n: renderer.cancelled == n, "the end of the pass")
        assert np.array_equal(bench.memory.screenshot(), whole)
    assert bench.painter.close(HANG_LIMIT)


class SlowScreen(Memory):
    """Showing takes four tenths of the time."""

    def show(self, window) -> None:
        super().show(window)
        self._now += 0.4 * LONGEST


def test_a_slow_screen_leaves_less_time_for_rendering():
    for memory, divisor in ((Memory(), 1), (SlowScreen(), 2)):
        bench = Bench(memory=memory)
        bench.finish(LONGEST * 0.7)
        bench.tap(Key.D)
        assert bench.painter.divisors == [1, divisor]


def test_a_picture_is_shown_before_the_next_one_is_begun(monkeypatch):
    bench = Bench(samples=4)
    begun = []
    show = bench.memory.show
    monkeypatch.setattr(bench.memory, "show", lambda win: (begun.append(bench.painter.samples), show(win)))
    bench.finish(0.001)
    bench.finish(0.001)
    assert begun == [[1], [1, 4]]


def test_without_news_nothing_is_drawn():
    bench = Bench()
    bench.finish(0.001)
    frame = bench.session.screen.frame
    bench.painter.outcomes.append(Outcome(Job(scene(), *SIZE)))  # cancelled: another is wanted
    bench.painter.notify()
    bench.memory.play()
    assert bench.session.screen.frame is frame
    bench.tap(Key.I)
    assert bench.session.screen.frame is not frame


def test_a_coarse_picture_is_stretched_over_the_window():
    bench = Bench()
    bench.finish(LONGEST * 100)
    bench.bare()
    bench.tap(Key.D)
    bench.finish(LONGEST)
    assert bench.session.pictures.latest.pixels.shape == (6, 8, 4)
    assert bench.memory.screenshot().shape == (48, 64, 4)
    assert (bench.memory.screenshot() == colour_of(bench.session.state.scene)).all()


def test_of_many_sizes_the_last_is_rendered():
    bench = Bench(partial(BackgroundPainter, renderer := FakeRenderer()))
    until(lambda: renderer.rendered == [SIZE], "the first picture")
    renderer.gate.clear()
    for width in range(10, 40):
        bench.memory.resize(width, 20)
    bench.memory.play()
    renderer.gate.set()

    def shown() -> bool:
        bench.memory.play()
        latest = bench.session.pictures.latest
        return latest is not None and latest.job.shows(bench.session.state.scene, 39, 20)

    until(shown, "the picture of the last size")
    assert {width for width, _ in renderer.rendered} <= {64, 39, 5}
    assert bench.painter.close(HANG_LIMIT)


def test_the_old_picture_is_stretched_until_the_new_one_comes():
    bench = Bench()
    bench.bare()
    bench.finish(0.001)
    bench.memory.resize(30, 20)
    bench.memory.play()
    assert bench.memory.screenshot().shape == (20, 30, 4)
    assert (bench.memory.screenshot() == colour_of(bench.session.state.scene)).all()


def test_an_error_of_the_renderer_is_a_message_over_the_picture():
    bench = Bench()
    bench.finish(0.001)
    bench.tap(Key.D)
    before = bench.memory.screenshot()
    bench.painter.renderer.error = RenderError("too many shapes")
    bench.finish(0.001)
    assert bench.session.state.message == "too many shapes"
    assert (bench.session.picture == colour_of(scene())).all()
    assert (bench.memory.screenshot() != before).any()
    bench.memory.wait(1)
    bench.memory.play()
    assert len(bench.painter.requests) == 2  # and is not tried again


def test_an_error_under_the_pointer_is_a_message_over_the_picture() -> None:
    bench = Bench()
    bench.finish(0.001)

    def gone(*_: object) -> None:
        raise FileError("brick.png", "cannot be read")

    bench.session.pick = gone
    bench.memory.click(30, 20)
    bench.memory.play()
    assert "brick.png" in bench.session.state.message


def test_an_unknown_error_ends_the_program_with_a_known_one():
    bench = Bench()
    bench.painter.renderer.error = ZeroDivisionError("division by zero")
    with pytest.raises(RenderError, match="ZeroDivisionError: division by zero"):
        bench.finish(0.001)


def test_a_picture_that_was_cancelled_by_nobody_is_asked_for_again():
    bench = Bench()
    bench.painter.open.clear()
    bench.painter.outcomes.append(Outcome(bench.painter.requests[0]))
    bench.painter.notify()
    bench.memory.play()
    assert len(bench.painter.requests) == 2


def test_compiling_is_shown():
    bench = Bench()
    bench.bare()
    dark = bench.memory.screenshot()
    bench.painter.compiling = True
    bench.painter.notify()
    bench.memory.play()
    assert (bench.memory.screenshot() != dark).any()
    bench.painter.compiling = False
    bench.finish(0.001)
    assert (bench.memory.screenshot() == colour_of(scene())).all()


def test_a_screenshot_waits_for_the_last_picture(tmp_path):
    bench = Bench(samples=4)
    bench.session.path = tmp_path / "scene.rt"
    bench.finish(LONGEST * 100)
    bench.tap(Key.D)
    bench.tap(Key.P)
    for _ in range(2):  # the coarse one, the whole one
        bench.finish(LONGEST)
        assert list(tmp_path.iterdir()) == []
    bench.finish(LONGEST)
    assert [file.name for file in tmp_path.iterdir()] == ["scene-1.png"]
