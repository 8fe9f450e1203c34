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

    from minirt.mlx import Image, Window
    from tests.mlx.harness import Harness
    from tests.mlx.user import User

RGB = list[int]


def at(*places: tuple[int, int]) -> Callable[[NDArray[np.uint8]], list[RGB]]:
    """Make a function that reads the colours (red, green, blue) at these x, y."""
    return lambda picture: [picture[y, x].tolist() for x, y in places]


def quarters(harness: Harness, width: int, height: int) -> Image:
    """Make an image with red and green quarters above, blue and white quarters below."""
    image = harness.m.mlx_new_image(harness.mlx, width, height)
    top, left = slice(0, height // 2), slice(0, width // 2)
    image.pixels[...] = 255
    image.pixels[top, left] = 0, 0, 255, 255
    image.pixels[top, width // 2 :] = 0, 255, 0, 255
    image.pixels[height // 2 :, left] = 255, 0, 0, 255
    return image


def solid(harness: Harness, width: int, height: int, color: int) -> Image:
    """Make an image of one colour."""
    image = harness.m.mlx_new_image(harness.mlx, width, height)
    image.pixels.view("<u4")[...] = color
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
def pictures_are_clipped_at_the_borders(harness: Harness) -> None:
    expected = np.zeros((100, 200, 3), np.uint8)
    for x, y, blue in ((-5, -5, 1), (195, -5, 2), (-5, 95, 3), (195, 95, 4), (300, 0, 5), (0, -10, 6), (0, 100, 7)):
        harness.m.mlx_put_image_to_window(harness.mlx, harness.win, solid(harness, 10, 10, 0xFF000000 | blue), x, y)
    expected[:5, :5] = 0, 0, 1
    expected[:5, 195:] = 0, 0, 2
    expected[95:, :5] = 0, 0, 3
    expected[95:, 195:] = 0, 0, 4
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


@scenario(["picture", [[0x80, 0x40, 0], [0x80, 0x40, 0], [0x80, 0x40, 0x80], [0x80, 0x40, 0x80]]])
def images_and_pixels_are_blended_by_their_alpha(harness: Harness) -> None:
    """Of two pixels at one place the last counts, unless an image lies between."""

    def put(image: Image) -> None:
        harness.m.mlx_put_image_to_window(harness.mlx, harness.win, image, 0, 0)

    def point(x: int, color: int) -> None:
        harness.m.mlx_pixel_put(harness.mlx, harness.win, x, 0, color)

    put(solid(harness, 200, 100, 0xFF804000))
    put(solid(harness, 200, 100, 0x00FFFFFF))
    for x in (2, 3):
        point(x, 0xFF804001)
        point(x, 0x80804000 | 0xFF)
    point(1, 0x00FFFFFF)
    colours = at((0, 0), (1, 0), (2, 0), (3, 0))
    harness.run(lambda user: user.log_picture("picture", colours))


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


@scenario(["picture", True], ["box", True])
def text_has_its_top_left_corner_at_x_y(harness: Harness) -> None:
    expected = np.zeros((100, 200, 4), np.uint8)
    width, height = draw_text(expected, 30, 40, "Hello", 0x80C0FF, pitch=10)
    harness.m.mlx_string_put(harness.mlx, harness.win, 30, 40, 0x80C0FF, "Hello")

    def inside(picture: NDArray[np.uint8]) -> bool:
        rows, columns = np.nonzero(picture.any(axis=2))
        box = rows.min() >= 40, rows.max() < 40 + height, columns.min() >= 30, columns.max() < 30 + width
        return all(map(bool, box)) and bool(columns.min() <= 33)

    def actions(user: User) -> None:
        user.log_picture("picture", lambda picture: np.array_equal(picture, expected[..., 2::-1]))
        user.log_picture("box", inside)

    harness.run(actions)


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


@scenario(["full", [2560, 1600]], ["back", [200, 100]], ["key", 122])
def full_screen_and_back(harness: Harness) -> None:
    """The window stays the same one, keeps the focus and gets the release of the key that was pressed before."""
    sizes: list[list[int]] = []

    def actions(user: User) -> None:
        for number in (1, 2):
            user.keys("+f")
            user.until(lambda number=number: len(sizes) >= number)  # type: ignore[misc]
            user.keys("-f")
        user.keys("+z -z")

    harness.m.mlx_resize_hook(harness.win, log_sizes(harness, sizes))
    harness.m.mlx_hook(harness.win, Event.FOCUS_OUT, 0, lambda _: harness.record("focus lost"), None)
    harness.m.mlx_hook(harness.win, Event.KEY_PRESS, 0, toggle_full_screen(harness, harness.win, sizes), None)
    harness.run(actions)


@scenario(["full", [2560, 1600]], ["back", [200, 100]], ["key", 122])
def full_screen_without_a_window_manager_and_back(harness: Harness) -> None:
    """Keys still work if full screen replaces the window and the release of the pressed key is lost."""
    sizes: list[list[int]] = []

    def actions(user: User) -> None:
        for number in (1, 2):
            user.press_to_replace_window("f")
            user.until(lambda number=number: len(sizes) >= number)  # type: ignore[misc]
        user.keys("+z -z")

    without_manager(harness)
    harness.m.mlx_resize_hook(harness.win, log_sizes(harness, sizes))
    harness.m.mlx_hook(harness.win, Event.KEY_PRESS, 0, toggle_full_screen(harness, harness.win, sizes), None)
    harness.run(actions)


def log_sizes(harness: Harness, sizes: list[list[int]]) -> Callable[..., None]:
    """Return a hook that logs the sizes of a window, first that of full screen."""

    def resized(width: int, height: int, _: object) -> None:
        sizes.append([width, height])
        harness.record("back" if len(sizes) > 1 else "full", [width, height])

    return resized


def toggle_full_screen(harness: Harness, window: Window, sizes: list[list[int]]) -> Callable[..., None]:
    """Return a hook that lets F enter full screen, and leave it when there is a size; other keys are logged."""

    def pressed(key: int, _: object) -> None:
        if key == Key.F:
            harness.m.mlx_set_fullscreen(window, not sizes)
        else:
            harness.record("key", key)

    return pressed


def without_manager(harness: Harness) -> None:
    """Let the back end believe that no window manager has full screen."""
    if not isinstance(harness.mlx.backend, Memory):
        native = importlib.import_module("minirt.mlx.on_pyglet.native")
        harness.undo.enter_context(patch.object(native, "manager_has_full_screen", lambda _: False))


@scenario(["title", "another"])
def the_title_changes(harness: Harness) -> None:
    def actions(user: User) -> None:
        user.keys("+a -a")
        user.log_title()

    harness.m.mlx_key_hook(harness.win, lambda *_: harness.m.mlx_set_window_title(harness.win, "another"), None)
    harness.run(actions)
