"""Scenarios of the contract: drawing, clipping, resizing, full screen."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING
from unittest.mock import patch

import numpy as np

from minirt.mlx import Event, Key
from minirt.mlx.memory import Memory
from minirt.mlx.text import draw_text
from tests.mlx.contract import scenario

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from minirt.mlx import MlxImage
    from tests.mlx.contract import Harness
    from tests.mlx.user import User

RGB = list[int]


def at(*places: tuple[int, int]) -> Callable[[NDArray[np.uint8]], list[RGB]]:
    """Make a function that reads the colours (red, green, blue) at these x, y."""
    return lambda picture: [picture[y, x].tolist() for x, y in places]


def quarters(harness: Harness, width: int, height: int) -> MlxImage:
    """Make an image with red and green quarters above, blue and white quarters below."""
    image = harness.m.mlx_new_image(harness.mlx, width, height)
    top, left = slice(0, height // 2), slice(0, width // 2)
    image.pixels[...] = 255
    image.pixels[top, left] = 0, 0, 255, 255
    image.pixels[top, width // 2 :] = 0, 255, 0, 255
    image.pixels[height // 2 :, left] = 255, 0, 0, 255
    return image


@scenario(["size", [100, 200, 3]], ["black", 0])
def a_new_window_is_black(harness: Harness) -> None:
    def actions(user: User) -> None:
        user.log_picture("size", lambda picture: list(picture.shape))
        user.log_picture("black", lambda picture: int(picture.max()))

    harness.run(actions)


@scenario(["picture", True])
def every_pixel_is_shown_unchanged(harness: Harness) -> None:
    image = harness.m.mlx_new_image(harness.mlx, 200, 100)
    image.pixels[...] = np.random.default_rng(1).integers(0, 256, (100, 200, 4), np.uint8)
    image.pixels[..., 3] = 255
    harness.m.mlx_put_image_to_window(harness.mlx, harness.win, image, 0, 0)
    expected = image.pixels[..., 2::-1].copy()
    image.pixels[...] = 0  # the window has its copy
    harness.run(lambda user: user.log_picture("picture", lambda picture: np.array_equal(picture, expected)))


@scenario(["picture", True])
def single_pixels_and_clear(harness: Harness) -> None:
    harness.m.mlx_put_image_to_window(harness.mlx, harness.win, quarters(harness, 200, 100), 0, 0)
    harness.m.mlx_clear_window(harness.mlx, harness.win)
    expected = np.zeros((100, 200, 3), np.uint8)
    for x, y in ((0, 0), (199, 99), (200, 0), (0, 100), (-1, -1), (7, 3)):
        harness.m.mlx_pixel_put(harness.mlx, harness.win, x, y, 0xFF102030)
    expected[[0, 99, 3], [0, 199, 7]] = 0x10, 0x20, 0x30
    harness.run(lambda user: user.log_picture("picture", lambda picture: np.array_equal(picture, expected)))


@scenario(["before", [[0, 0, 0], [0, 0, 0]]], ["after", [[9, 0, 0], [0, 9, 0]]])
def drawing_in_a_hook_is_shown_after_it(harness: Harness) -> None:
    """Two distant pixels are drawn: both are in the box of changes that is uploaded."""

    def draw(*_: object) -> None:
        harness.m.mlx_pixel_put(harness.mlx, harness.win, 20, 30, 0xFF090000)
        harness.m.mlx_pixel_put(harness.mlx, harness.win, 190, 5, 0xFF000900)

    harness.m.mlx_key_hook(harness.win, draw, None)
    colours = at((20, 30), (190, 5))

    def actions(user: User) -> None:
        user.log_picture("before", colours)
        user.keys("+a -a")
        user.log_picture("after", colours)

    harness.run(actions)


@scenario(["picture", True])
def text_has_its_top_left_corner_at_x_y(harness: Harness) -> None:
    expected = np.zeros((100, 200, 4), np.uint8)
    draw_text(expected, 30, 40, "Hello", 0x80C0FF, pitch=10)
    harness.m.mlx_string_put(harness.mlx, harness.win, 30, 40, 0x80C0FF, "Hello")

    harness.run(lambda user: user.log_picture("picture", lambda shown: np.array_equal(shown, expected[..., 2::-1])))


CORNERS = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]


@scenario(
    ["configure", [0, 400, 300]],
    ["resize", 400, 300],
    ["stretched", CORNERS],
    ["drawn", [[0, 0, 0], [1, 2, 3], [0, 0, 0]]],
)
def the_old_picture_is_stretched_until_the_next_is_drawn(harness: Harness) -> None:
    def actions(user: User) -> None:
        user.resize(400, 300)
        user.until(lambda: len(harness.log) == 2)
        user.log_picture("stretched", at((199, 149), (200, 149), (199, 150), (200, 150)))
        user.keys("+a -a")
        user.log_picture("drawn", at((0, 0), (399, 299), (200, 150)))

    harness.m.mlx_put_image_to_window(harness.mlx, harness.win, quarters(harness, 200, 100), 0, 0)
    harness.m.mlx_resize_hook(harness.win, lambda width, height, param: harness.record(param, width, height), "resize")
    size = harness.m.mlx_get_window_size
    harness.m.mlx_hook(
        harness.win,
        Event.CONFIGURE_NOTIFY,
        0,
        lambda param: harness.record(param, list(size(harness.win))),
        "configure",
    )
    harness.m.mlx_key_hook(
        harness.win, lambda *_: harness.m.mlx_pixel_put(harness.mlx, harness.win, 399, 299, 0xFF010203), None
    )
    harness.run(actions)


def full_screen(harness: Harness, toggle: Callable[[User, Callable[[], bool]], None]) -> None:
    """Enter full screen and leave it by F. `toggle` presses the key until a condition is true."""
    sizes: list[list[int]] = []

    def resized(width: int, height: int, _: object) -> None:
        sizes.append([width, height])
        harness.record("back" if len(sizes) > 1 else "full", [width, height])

    def pressed(key: int, _: object) -> None:
        if key == Key.F:
            harness.m.mlx_set_fullscreen(harness.win, not sizes)
        else:
            harness.record("key", key)

    def actions(user: User) -> None:
        for number in (1, 2):
            toggle(user, lambda number=number: len(sizes) >= number)  # type: ignore[misc]
        user.keys("+z -z")

    harness.m.mlx_resize_hook(harness.win, resized)
    harness.m.mlx_hook(harness.win, Event.KEY_PRESS, 0, pressed, None)
    harness.run(actions)


FULL_SCREEN_LOG = ["full", [2560, 1600]], ["back", [200, 100]], ["key", 122]


@scenario(*FULL_SCREEN_LOG)
def full_screen_and_back(harness: Harness) -> None:
    """The window stays the same one, keeps the focus and gets the release of the key that was pressed before."""

    def toggle(user: User, done: Callable[[], bool]) -> None:
        user.keys("+f")
        user.until(done)
        user.keys("-f")

    harness.hook(Event.FOCUS_OUT, "focus lost")
    full_screen(harness, toggle)


@scenario(*FULL_SCREEN_LOG)
def full_screen_without_a_window_manager_and_back(harness: Harness) -> None:
    """Keys still work if full screen replaces the window and the release of the pressed key is lost."""

    def toggle(user: User, done: Callable[[], bool]) -> None:
        user.press_to_replace_window("f")
        user.until(done)

    if not isinstance(harness.mlx, Memory):
        native = importlib.import_module("minirt.mlx.on_pyglet.native")
        harness.undo.enter_context(patch.object(native.x11, "request_full_screen", lambda *_: False))
    full_screen(harness, toggle)


@scenario(["title", "another"])
def the_title_changes(harness: Harness) -> None:
    def actions(user: User) -> None:
        user.keys("+a -a")
        user.log_title()

    harness.m.mlx_key_hook(harness.win, lambda *_: harness.m.mlx_set_window_title(harness.win, "another"), None)
    harness.run(actions)
