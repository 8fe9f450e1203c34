"""Calls as programs for the official wrapper make them: its parameter names, results, integers and failures."""

from __future__ import annotations

import ctypes
import inspect
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from minirt.mlx import Mlx, MlxError
from minirt.mlx.memory import Memory
from tests.paths import PACKAGE

if TYPE_CHECKING:
    from minirt.mlx import Window
    from minirt.mlx.display import Display

README = (PACKAGE / "mlx/README.md").read_text(encoding="utf-8")
OURS = README.index("These calls are ours")
CALLS = re.compile(r"`(mlx_\w+)\(([^)]*)\)`")
WRAPPER = {name: words.partition(", *")[0].split(", ") for name, words in CALLS.findall(README[:OURS])}

RESULTS = ("mlx_new", "mlx_get", "mlx_xpm", "mlx_png", "mlx_mouse_get")  # calls that return something

Opened = tuple[Mlx, "Display", "Window"]


@pytest.fixture
def opened() -> Opened:
    """A window of 20x10 pixels."""
    m = Mlx(Memory())
    mlx = m.mlx_init()
    return m, mlx, m.mlx_new_window(mlx, 20, 10, "window")


def test_the_readme_lists_every_call_with_its_parameters() -> None:
    """Those of the wrapper have its names and its order there."""
    calls = [spelled(name) for name in dir(Mlx) if name.startswith("mlx_")]
    assert sorted(f"{name}({words})" for name, words in CALLS.findall(README)) == sorted(calls)


def spelled(name: str) -> str:
    """Return the call with its parameters, those by name behind a star."""
    words: list[str] = []
    for parameter in list(inspect.signature(getattr(Mlx, name)).parameters.values())[1:]:
        if parameter.kind is parameter.KEYWORD_ONLY and "*" not in words:
            words.append("*")
        words.append(parameter.name)
    return f"{name}({', '.join(words)})"


def test_constants() -> None:
    assert (Mlx.SYNC_IMAGE_WRITABLE, Mlx.SYNC_WIN_FLUSH, Mlx.SYNC_WIN_COMPLETED) == (1, 2, 3)


def test_results(opened: Opened) -> None:
    """All calls without a result return 0; handles are numbers, each one its own."""
    m, mlx, win = opened
    image = m.mlx_new_image(mlx, 3, 2)
    values: dict[str, Any] = {
        "mlx_ptr": mlx, "win_ptr": win, "img_ptr": image, "img_or_win_ptr": win, "x": 1, "y": 1, "color": 1,
        "string": "a", "cmd": 2, "x_event": 2, "x_mask": 1, "callback": None, "param": None,
    }  # fmt: skip
    m.mlx_loop_hook(mlx, lambda _: m.mlx_loop_exit(mlx), None)
    assert m.mlx_loop(mlx) == 0
    others = {"mlx_init", "mlx_loop", "mlx_release", "mlx_destroy_window"}
    without_result = [name for name in WRAPPER.keys() - others if not name.startswith(RESULTS)]
    for name in without_result:
        assert getattr(m, name)(**{parameter: values[parameter] for parameter in WRAPPER[name]}) == 0, name
    assert m.mlx_get_screen_size(mlx) == (0, 2560, 1600)
    assert m.mlx_destroy_window(mlx, win) == 0
    assert m.mlx_release(mlx) == 0
    assert len({int(mlx), int(win), int(image)}) == 3
    assert all(isinstance(handle, int) and handle > 2**32 and f"{handle:x}" for handle in (mlx, win, image))


def test_the_pointer_is_that_of_a_window_or_of_the_first_one(opened: Opened) -> None:
    m, mlx, win = opened
    win.on_motion(7, 8)
    assert m.mlx_mouse_get_pos(win) == m.mlx_mouse_get_pos(mlx) == (0, 7, 8)


@pytest.mark.parametrize("kind", [ctypes.c_int, ctypes.c_uint, ctypes.c_long, np.int64, bool])
def test_integers_of_other_libraries_are_taken(opened: Opened, kind: Any) -> None:
    m, mlx, win = opened
    one = kind(1)
    image = m.mlx_new_image(mlx, one, one)
    m.mlx_get_data_addr(image)[0][:] = bytes((1, 2, 3, 255))
    m.mlx_put_image_to_window(mlx, win, image, one, one)
    m.mlx_pixel_put(mlx, win, one, kind(0), ctypes.c_uint(0xFF0000FF))
    m.mlx_pixel_put(mlx, win, 0, 0, -1)  # 0xFFFFFFFF
    assert win.canvas.pixels[:2, :2, :3].tolist() == [[[255] * 3, [255, 0, 0]], [[0] * 3, [1, 2, 3]]]
    m.mlx_string_put(mlx, win, one, one, ctypes.c_uint(0xFF0000FF), "a")
    m.mlx_hook(win, kind(1), one, print, None)
    assert m.mlx_new_window(mlx, one, one, "small").width == 1


@pytest.mark.parametrize("place", [(1.0, 1, 1), (1, "1", 1), (1, 1, None)])
def test_other_values_are_no_integers(opened: Opened, place: tuple[Any, Any, Any]) -> None:
    m, mlx, win = opened
    with pytest.raises(TypeError):
        m.mlx_pixel_put(mlx, win, *place)
    assert not win.canvas.pixels[..., :3].any()


FAILURES = {
    "no width": (lambda m, mlx: m.mlx_new_window(mlx, 0, 10, "none"), None),
    "no height": (lambda m, mlx: m.mlx_new_window(mlx, 10, 0, "none"), None),
    "no image": (lambda m, mlx: m.mlx_new_image(mlx, 10, -1), None),
    "a huge image": (lambda m, mlx: m.mlx_new_image(mlx, 32768, 10), None),
    "no file": (lambda m, mlx: m.mlx_png_file_to_image(mlx, "none.png"), (None, 0, 0)),
    "broken PNG": (lambda m, mlx: m.mlx_png_file_to_image(mlx, "broken.png"), (None, 0, 0)),
    "no PNG": (lambda m, mlx: m.mlx_png_file_to_image(mlx, __file__), (None, 0, 0)),
    "None as an image": (
        lambda m, mlx: m.mlx_put_image_to_window(mlx, m.mlx_new_window(mlx, 9, 9, ""), None, 0, 0),
        None,
    ),
    "no XPM": (lambda m, mlx: m.mlx_xpm_file_to_image(mlx, __file__), (None, 0, 0)),
}


@pytest.mark.parametrize("name", FAILURES)
def test_failures_return_none_or_raise(
    name: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("broken.png").write_bytes(b"\x89PNG\r\n\x1a\nbroken")
    call, result = FAILURES[name]
    m = Mlx(Memory())
    mlx = m.mlx_init()
    assert call(m, mlx) == result
    assert capsys.readouterr().err.startswith("mlx: ")
    m.mlx_set_options(strict=True)
    with pytest.raises(MlxError):
        call(m, mlx)


def test_a_derived_class_may_use_any_name_of_its_own() -> None:
    """Programs derive their classes from Mlx and add attributes and methods, even with the names of calls."""

    class Game(Mlx):
        def __init__(self) -> None:
            super().__init__(Memory())
            self.backend = self.options = self.alpha = self.strict = self.display = self.windows = None

        def mlx_hook(self, *_: object) -> int:
            raise AssertionError("calls do not call each other")

    game = Game()
    mlx = game.mlx_init()
    win = game.mlx_new_window(mlx, 10, 10, "game")
    assert game.mlx_key_hook(win, print, None) == game.mlx_close_hook(win, print) == 0


def test_an_option_is_taken_by_the_next_window() -> None:
    m = Mlx(Memory(), alpha=False, strict=True)
    m.mlx_set_options(strict=False)
    mlx = m.mlx_init()
    copying = m.mlx_new_window(mlx, 1, 1, "copies")
    m.mlx_set_options(alpha=True)
    blending = m.mlx_new_window(mlx, 1, 1, "blends")
    for win in (copying, blending):
        m.mlx_pixel_put(mlx, win, 0, 0, 0x00FFFFFF)
    assert [win.canvas.pixels[0, 0, 0] for win in (copying, blending)] == [255, 0]
    assert mlx.options.strict is False
