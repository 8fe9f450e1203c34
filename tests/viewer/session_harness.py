"""A session on a window in memory, whose pictures are finished when a test says so."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from minirt.mlx.recording import add_recording
from minirt.viewer.app.events import EventDispatcher
from minirt.viewer.app.session import Session
from minirt.viewer.display.jobs import PaintJob
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.display.painter import Painter, paint
from tests.viewer.fake import TEXT, FakeRenderer, scene

SIZE = (64, 48)


class ManualPainter(Painter):
    """A painter whose pictures are finished by the test, after as many seconds as it says."""

    def __init__(self, renderer, notify) -> None:
        super().__init__(renderer, notify)
        self.requests: list[PaintJob] = []
        self.open: list[PaintJob] = []  # the last request, until it is finished

    @property
    def busy(self) -> bool:
        return bool(self.open or self.outcomes)

    def request(self, job: PaintJob) -> None:
        self.requests.append(job)
        self.open = [job]

    def finish(self, seconds: float) -> None:
        """Finish the open job; `seconds`: its render time."""
        (job,) = self.open
        self.open = []
        self.outcomes.append(replace(paint(self.renderer, job, job.base), seconds=seconds))
        self.notify()

    @property
    def divisors(self) -> list[int]:
        """The divisors of all requests."""
        return [job.divisor for job in self.requests]

    @property
    def samples(self) -> list[int]:
        """The samples of all requests."""
        return [job.samples for job in self.requests]


class SessionHarness:
    """A session with a manual painter, which has processed its first events."""

    def __init__(self, samples: int = 1, memory: Memory | None = None, text: str = TEXT) -> None:
        self.memory = memory or Memory()
        mlx = Mlx(self.memory)
        self.display = mlx.mlx_init()
        self.session = Session(
            mlx,
            self.display,
            scene(text),
            path=Path("scene.rt"),
            size=SIZE,
            renderer=FakeRenderer(),
            painter=ManualPainter,
            samples=samples,
        )
        EventDispatcher(self.session)
        self.painter = self.session.refinement.painter
        self.memory.play()

    def finish(self, seconds: float) -> None:
        """Finish the open picture and show it; `seconds`: its render time."""
        self.painter.finish(seconds)
        self.memory.play()

    def hide_overlay(self) -> None:
        """Show the picture alone."""
        self.session.screen.level = HudLevel.NOTHING
        self.session.draw()
        self.memory.play()

    def play(self, *lines: str) -> None:
        """Perform lines of a recording."""
        add_recording(lines, "test", self.memory)
        self.memory.play()
