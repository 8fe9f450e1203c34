"""A fake renderer whose pictures take no time or as long as a test says, and sessions from recorded keys."""

from __future__ import annotations

import threading
import zlib
from collections.abc import Callable
from pathlib import Path
from unittest.mock import patch

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.queries.pick import pick
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene, dump, parse
from minirt.viewer.app.judging import PictureJudge
from minirt.viewer.app.replay import play
from minirt.viewer.app.session import Session
from tests.waiting import HANG_LIMIT, until

IsWanted = Callable[[], bool]

TEXT = """\
# a comment
A 0.2 255,255,255
C 0,0,10 0,0,-1 90   # looks along -z
L 5,5,5 0.5 255,255,255
sp 0,0,0 2 255,0,0

pl 0,-1,0 0,1,0 0,255,0
cy 3,0,0 0,1,0 1 4 0,0,255
"""

SPHERE_ON_PLANE = """\
A 0.2 255,255,255
C 0,1,8 0,-0.1,-0.995 60
L 5,5,5 0.6 255,255,255
sp 0,0,0 2 255,60,60
pl 0,-1,0 0,1,0 90,200,90
"""
WITH_CYLINDER = SPHERE_ON_PLANE + "cy 2,0,0 0,1,0 1 2 60,60,255\n"  # these two are for real windows

MARK = (1, 2, 3, 255)  # BGRA of a refined pixel


def scene(text: str = TEXT) -> Scene:
    """Parse a scene."""
    return parse(text, "scene.rt").scene


class FakeRenderer:
    """A renderer that fills each picture with one colour, which depends on the scene."""

    precision = "double"

    def __init__(self) -> None:
        self.busy, self.packing = threading.Lock(), Packing()
        self.rendered: list[tuple[int, int]] = []  # width and height of the finished pictures
        self.samples: list[int] = []  # of the pictures that were started
        self.refined: list[int] = []  # samples of the refinements that were started
        self.cancelled = 0
        self.ready = True
        self.stops = False  # whether `stop` ends `prepare`
        self.error: Exception | None = None
        self.prepare_error: Exception | None = None
        self.gate = threading.Event()  # while it is closed, pictures are not finished
        self.gate.set()
        self.started = threading.Event()
        self.cancel_requested = threading.Event()

    def is_ready(self, _scene: Scene, _samples: object = 1) -> bool:
        return self.ready

    def prepare(self, _scene: Scene, _samples: object = 1) -> None:
        self.started.set()
        self.gate.wait(HANG_LIMIT)
        if self.prepare_error:
            raise self.prepare_error
        self.ready = True

    def specialise_early(self) -> None:
        pass

    def stop(self) -> None:
        if self.stops:
            self.gate.set()

    moves_in_single = False
    about: tuple[str, ...] = ()
    pick = staticmethod(pick)

    def preview(self, scene: Scene, width: int, height: int) -> NDArray[np.uint8] | None:
        return np.full((2, 3, 4), colour_of(scene), np.uint8)

    def render(
        self,
        scene: Scene,
        pixels: NDArray[np.uint8],
        samples: int = 1,
        is_wanted: IsWanted = lambda: True,
        edges_only: bool = False,
    ) -> bool:
        if edges_only:
            return self.refine(scene, pixels, samples, is_wanted)
        self.samples.append(samples)
        if not self.may_finish(is_wanted):
            return False
        pixels[...] = colour_of(scene)
        self.rendered.append((pixels.shape[1], pixels.shape[0]))
        return True

    def refine(self, scene: Scene, pixels: NDArray[np.uint8], samples: int, is_wanted: IsWanted = lambda: True) -> bool:
        """Mark as many pixels of the first row as there are samples, half of them before `cancel` has effect."""
        assert (pixels[1:] == colour_of(scene)).all()
        self.refined.append(samples)
        pixels[0, : samples // 2] = MARK
        if not self.may_finish(is_wanted):
            return False
        pixels[0, :samples] = MARK
        return True

    def may_finish(self, is_wanted: IsWanted) -> bool:
        """Wait for the gate to open; return False if the picture was cancelled."""
        self.cancel_requested.clear()
        self.started.set()
        if not is_wanted():
            self.cancelled += 1
            return False
        until(lambda: self.gate.is_set() or self.cancel_requested.is_set(), "the gate's opening")
        if self.cancel_requested.is_set():
            self.cancelled += 1
            return False
        if self.error:
            raise self.error
        return True

    def cancel(self) -> None:
        self.cancel_requested.set()


def colour_of(scene: Scene) -> tuple[int, int, int, int]:
    """Return the colour of a scene's pictures, BGRA."""
    blue, green, red, _ = zlib.crc32(dump(scene).encode()).to_bytes(4)
    return blue, green, red, 255


def played(
    *lines: str,
    text: str = TEXT,
    path: Path = Path("scene.rt"),
    keys: str = "qwerty",
    size: tuple[int, int] = (64, 48),
    watch: Callable[[Session], object] = lambda _: None,
) -> Session:
    """Return the session after these recorded keys; `watch` as in `minirt.viewer.app.replay.play`.

    Its pictures of one colour are not judged, which would take most of the time: the tests of sessions do that."""
    with patch.object(PictureJudge, "judge"):
        return play(
            parse(text, path).scene, lines, renderer=FakeRenderer(), size=size, path=path, keys=keys, watch=watch
        )


def write(path: Path, text: str) -> None:
    """Replace a file, as another program does."""
    new = path.with_name("new")
    new.write_text(text)
    new.replace(path)
