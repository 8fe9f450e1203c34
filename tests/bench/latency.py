"""Latency of the viewer while it refines: seconds from a key to its first picture, and between pictures of a movement.

    python -m tests.bench.latency [--window] [--size 1280x720] scenes/demo.rt ...

A user in a thread of its own taps keys while a picture is refined, holds a key, and drags the pointer. The pictures go
to memory or, with `--window`, to a window.
"""

from __future__ import annotations

import argparse
import random
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from itertools import pairwise
from pathlib import Path
from statistics import median
from threading import Event, Thread
from time import perf_counter, sleep
from typing import NamedTuple

import minirt
from minirt.cli.arguments import WINDOW_SAMPLES
from minirt.mlx import Button, Key, Mlx
from minirt.mlx import Event as MlxEvent
from minirt.mlx.backend import Backend
from minirt.mlx.memory import TICK, Memory
from minirt.mlx.window import Window
from minirt.rendering import Renderer
from minirt.scene import Scene
from minirt.viewer.app import desktop
from minirt.viewer.app.session import Session

TAPS = 12
TAP_DELAYS = 0.05, 0.5  # seconds of refining before a tap: least and most
PAUSE = 0.3  # seconds before a key is held and before a drag, in which a picture is refined
HOLD = 1.0  # seconds that a key is held, and that a drag takes
MOTION_INTERVAL = 0.008  # seconds between two motions of a mouse
KEYS = Key.D, Key.A, Key.RIGHT, Key.LEFT


class Latency(NamedTuple):
    """Seconds from a tap of a key to its first picture, and between the pictures of movements that follow."""

    taps: list[float]  # until the picture is handed to the window
    shown: list[float]  # until the window shows it
    held: list[float]  # between pictures while a key is held
    dragged: list[float]  # between pictures while the pointer drags
    divisors: list[int]  # of width and height of the first pictures

    def __str__(self) -> str:
        return "  ".join(
            f"{name} {1000 * median(times):5.1f} {1000 * max(times):5.1f}"
            for name, times in zip(self._fields, self[:-1], strict=False)
        )


class Shown(NamedTuple):
    """A picture that was brought to the window."""

    scene: Scene
    divisor: int
    handed: float  # the time when the window got it
    shown: float


class LiveMemory(Memory):
    """A back end without a screen whose time is real."""

    def time(self) -> float:
        return perf_counter()

    def show(self, window: Window) -> None:
        window.shown.take_changes()  # nobody looks: a window's time to show a picture is measured in a window

    def run(self) -> None:
        tick = 0.0
        self.display.turn(tick=False)
        while not self.display.over:
            if self._wakeup.wait(max(0.0, tick - perf_counter()) if self.display.busy else None):
                self._wakeup.clear()
                while self._script:
                    self._script.popleft()()
                self.display.turn(tick=False)
            elif self.display.busy:
                tick = max(tick + TICK, perf_counter())
                self.display.turn(tick=True)


def live_window() -> Backend:
    """Return the back end for a window, whose method `do` performs an action in the event loop."""
    import pyglet.app

    from minirt.mlx.on_pyglet.loop import PygletBackend

    class LiveWindow(PygletBackend):
        def __init__(self) -> None:
            super().__init__()
            self.actions: deque[Callable[[], object]] = deque()

        def do(self, action: Callable[[], object]) -> None:
            self.actions.append(action)
            pyglet.app.platform_event_loop.post_event(self, "act")

        def dispatch_event(self, name: str) -> None:
            while self.actions:
                self.actions.popleft()()
            super().dispatch_event(name)

    return LiveWindow()


class User:
    """A user of a session, who acts in real time."""

    def __init__(self, session: Session, backend: Backend) -> None:
        self.session = session
        self.backend = backend
        self.pictures: list[Shown] = []
        self.finished = Event()  # the picture of a scene after the first `seen` ones was refined, or was not to be
        self.seen = 0
        self.draw = session.draw
        session.draw = self.draw_and_note  # type: ignore[method-assign]
        self.handed = 0.0
        self.put = session.mlx.mlx_put_image_to_window
        session.screen.mlx.mlx_put_image_to_window = self.put_and_note  # type: ignore[method-assign]
        self.random = random.Random(1)

    def put_and_note(self, *arguments: object) -> None:
        """Hand a picture to the window, and note when."""
        self.handed = perf_counter()
        self.put(*arguments)  # type: ignore[arg-type]

    def draw_and_note(self) -> None:
        """Draw the session, and note the first picture of each scene."""
        self.draw()
        latest = self.session.refinement.latest
        if latest and latest.pixels is not None:
            if not self.pictures or self.pictures[-1].scene is not latest.job.scene:
                self.pictures.append(Shown(latest.job.scene, latest.job.divisor, self.handed, perf_counter()))
            if latest.job.divisor == 1 and len(self.pictures) > self.seen:
                self.finished.set()

    def act(self, latency: Future[Latency]) -> None:
        """Measure the latency, and end the session."""
        try:
            self.finished.wait()
            latency.set_result(self.measure())
        except BaseException as error:
            latency.set_exception(error)
        finally:
            self.backend.do(self.session.quit)  # type: ignore[attr-defined]

    def measure(self) -> Latency:
        """Tap keys, hold one, and drag the pointer."""
        self.tap(0)  # the first coarse picture knows how long the first picture took
        taps = [self.tap(number) for number in range(TAPS)]
        return Latency(
            [shown.handed - start for start, shown in taps],
            [shown.shown - start for start, shown in taps],
            self.gaps(partial(self.hold, KEYS[0])),
            self.gaps(self.drag),
            [shown.divisor for _, shown in taps],
        )

    def do(self, action: Callable[..., object], *arguments: object) -> float:
        """Perform an action in the event loop, and return the time when it was asked for."""
        start = perf_counter()
        self.backend.do(lambda: action(*arguments))  # type: ignore[attr-defined]
        return start

    def tap(self, number: int) -> tuple[float, Shown]:
        """Tap a key while a picture is refined; return the time and the picture that follows."""
        self.expect_picture()
        keyboard, key = self.session.window.keyboard, KEYS[number % len(KEYS)]
        start = self.do(lambda: (keyboard.press(key, perf_counter()), keyboard.release(key)))
        self.finished.wait()
        sleep(self.random.uniform(*TAP_DELAYS))
        return start, self.pictures[self.seen]

    def expect_picture(self) -> None:
        """Let `finished` wait for a refined picture of a scene of which there is none yet."""
        self.seen = len(self.pictures)
        self.finished.clear()

    def gaps(self, move: Callable[[], float]) -> list[float]:
        """Move something while a picture is refined; return the seconds between its start, its pictures and its end."""
        sleep(PAUSE)
        before = len(self.pictures)
        start, end = move(), perf_counter()
        times = [start, *(shown.handed for shown in self.pictures[before:]), end]
        return [late - early for early, late in pairwise(times)]

    def hold(self, key: int) -> float:
        """Hold a key; return the time of its press."""
        keyboard = self.session.window.keyboard
        start = self.do(lambda: keyboard.press(key, perf_counter()))
        sleep(HOLD)
        self.do(lambda: keyboard.release(key))
        return start

    def drag(self) -> float:
        """Drag the pointer; return the time of the first motion."""
        window = self.session.window
        x, y = window.width // 3, window.height // 2
        self.do(window.on_button, MlxEvent.BUTTON_PRESS, Button.MIDDLE, x, y)
        sleep(PAUSE)
        start = perf_counter()
        while (now := perf_counter()) < start + HOLD:
            self.do(window.on_motion, x + 10 + int((now - start) * 100), y)
            sleep(MOTION_INTERVAL)
        self.do(window.on_button, MlxEvent.BUTTON_RELEASE, Button.MIDDLE, x, y)
        return start


def measure(scene: Scene, width: int, height: int, window: bool = False) -> Latency:
    """Measure the latency of a scene, whose kernel is compiled before."""
    renderer = Renderer()
    renderer.prepare(scene)
    backend = live_window() if window else LiveMemory()
    session = desktop.open_session(
        scene, Path("scene.rt"), (width, height), renderer, Mlx(backend), "qwerty", False, WINDOW_SAMPLES, False
    )
    latency: Future[Latency] = Future()
    Thread(target=User(session, backend).act, args=[latency], daemon=True).start()
    desktop.run_event_loop(session)
    return latency.result()


def main() -> None:
    """Measure scenes, and print medians and greatest times in milliseconds."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--window", action="store_true")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("scenes", nargs="+", type=Path)
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    for path in options.scenes:
        latency = measure(minirt.load(path), width, height, options.window)
        print(f"{path.stem:24} {latency}  divisors {sorted(set(latency.divisors))}", flush=True)


if __name__ == "__main__":
    main()
