"""The window contract: what is drawn, and how it stands in the window."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from minirt.mlx import Event, Key
from minirt.mlx.text import draw_text
from tests.mlx.contract import scenario

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from minirt.mlx import Image
    from tests.mlx.stage import Stage
    from tests.mlx.user import User

RGB = list[int]


def at(*places: tuple[int, int]) -> Callable[[NDArray[np.uint8]], list[RGB]]:
    """Sees the colours (red, green, blue) at these x, y."""
    return lambda picture: [picture[y, x].tolist() for x, y in places]


def quarters(stage: Stage, width: int, height: int) -> Image:
    """Red and green above, blue and white below."""
    image = stage.m.mlx_new_image(stage.mlx, width, height)
    top, left = slice(0, height // 2), slice(0, width // 2)
    image.pixels[...] = 255
    image.pixels[top, left] = 0, 0, 255, 255
    image.pixels[top, width // 2 :] = 0, 255, 0, 255
    image.pixels[height // 2 :, left] = 255, 0, 0, 255
    return image


def solid(stage: Stage, width: int, height: int, color: int) -> Image:
    image = stage.m.mlx_new_image(stage.mlx, width, height)
    image.pixels.view("<u4")[...] = color
    return image


@scenario(["size", [100, 200, 3]], ["black", 0])
def a_new_window_is_black(stage: Stage) -> None:
    def acts(user: User) -> None:
        user.look("size", lambda picture: list(picture.shape))
        user.look("black", lambda picture: int(picture.max()))

    stage.play(acts)


@scenario(["picture", True])
def every_pixel_is_shown_as_it_is(stage: Stage) -> None:
    image = stage.m.mlx_new_image(stage.mlx, 200, 100)
    image.pixels[...] = np.random.default_rng(1).integers(0, 256, (100, 200, 4), np.uint8)
    stage.m.mlx_put_image_to_window(stage.mlx, stage.win, image, 0, 0)
    expected = image.pixels[..., 2::-1].copy()
    image.pixels[...] = 0  # the window has its copy
    stage.play(lambda user: user.look("picture", lambda picture: np.array_equal(picture, expected)))


@scenario(["picture", True])
def pictures_are_clipped_at_the_borders(stage: Stage) -> None:
    expected = np.zeros((100, 200, 3), np.uint8)
    for x, y, blue in ((-5, -5, 1), (195, -5, 2), (-5, 95, 3), (195, 95, 4), (300, 0, 5), (0, -10, 6), (0, 100, 7)):
        stage.m.mlx_put_image_to_window(stage.mlx, stage.win, solid(stage, 10, 10, blue), x, y)
    expected[:5, :5] = 0, 0, 1
    expected[:5, 195:] = 0, 0, 2
    expected[95:, :5] = 0, 0, 3
    expected[95:, 195:] = 0, 0, 4
    stage.play(lambda user: user.look("picture", lambda picture: np.array_equal(picture, expected)))


@scenario(["picture", True])
def single_pixels_and_clear(stage: Stage) -> None:
    stage.m.mlx_put_image_to_window(stage.mlx, stage.win, quarters(stage, 200, 100), 0, 0)
    stage.m.mlx_clear_window(stage.mlx, stage.win)
    expected = np.zeros((100, 200, 3), np.uint8)
    for x, y in ((0, 0), (199, 99), (200, 0), (0, 100), (-1, -1), (7, 3)):
        stage.m.mlx_pixel_put(stage.mlx, stage.win, x, y, 0xFF102030)
    expected[[0, 99, 3], [0, 199, 7]] = 0x10, 0x20, 0x30
    stage.play(lambda user: user.look("picture", lambda picture: np.array_equal(picture, expected)))


@scenario(["before", [[0, 0, 0], [0, 0, 0]]], ["after", [[9, 0, 0], [0, 9, 0]]])
def drawing_in_a_hook_is_shown_after_it(stage: Stage) -> None:
    """Two far pixels, one after the other: both are in the box that is brought to the screen."""

    def draw(*_: object) -> None:
        stage.m.mlx_pixel_put(stage.mlx, stage.win, 20, 30, 0x090000)
        stage.m.mlx_pixel_put(stage.mlx, stage.win, 190, 5, 0x000900)

    stage.m.mlx_key_hook(stage.win, draw, None)
    see = at((20, 30), (190, 5))

    def acts(user: User) -> None:
        user.look("before", see)
        user.keys("+a -a")
        user.look("after", see)

    stage.play(acts)


@scenario(["picture", True], ["box", True])
def text_has_its_top_left_corner_at_the_place(stage: Stage) -> None:
    expected = np.zeros((100, 200, 4), np.uint8)
    width, height = draw_text(expected, 30, 40, "Hello", 0x80C0FF)
    stage.m.mlx_string_put(stage.mlx, stage.win, 30, 40, 0x80C0FF, "Hello")

    def inside(picture: NDArray[np.uint8]) -> bool:
        rows, columns = np.nonzero(picture.any(axis=2))
        box = rows.min() >= 40, rows.max() < 40 + height, columns.min() >= 30, columns.max() < 30 + width
        return all(map(bool, box)) and bool(columns.min() <= 33)

    def acts(user: User) -> None:
        user.look("picture", lambda picture: np.array_equal(picture, expected[..., 2::-1]))
        user.look("box", inside)

    stage.play(acts)


CORNERS = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]


@scenario(
    ["configure", [0, 400, 300]],
    ["resize", 400, 300],
    ["stretched", CORNERS],
    ["drawn", [[0, 0, 0], [1, 2, 3], [0, 0, 0]]],
)
def the_old_picture_is_stretched_until_the_next(stage: Stage) -> None:
    def acts(user: User) -> None:
        user.resize(400, 300)
        user.until(lambda: len(stage.log) == 2)
        user.look("stretched", at((199, 149), (200, 149), (199, 150), (200, 150)))
        user.keys("+a -a")
        user.look("drawn", at((0, 0), (399, 299), (200, 150)))

    stage.m.mlx_put_image_to_window(stage.mlx, stage.win, quarters(stage, 200, 100), 0, 0)
    stage.m.mlx_resize_hook(stage.win, lambda width, height, param: stage.note(param, width, height), "resize")
    size = stage.m.mlx_get_window_size
    stage.m.mlx_hook(
        stage.win, Event.CONFIGURE_NOTIFY, 0, lambda param: stage.note(param, list(size(stage.win))), "configure"
    )
    stage.m.mlx_key_hook(stage.win, lambda *_: stage.m.mlx_pixel_put(stage.mlx, stage.win, 399, 299, 0xFF010203), None)
    stage.play(acts)


@scenario(["full", [2560, 1600]], ["back", [200, 100]], ["key", 122])
def full_screen_and_back(stage: Stage) -> None:
    """Keys go on working: where the window is made anew, the release of the key that asked for it may be lost."""
    sizes: list[list[int]] = []

    def acts(user: User) -> None:
        for number in (1, 2):
            user.press_for_another_window("f")
            user.until(lambda number=number: len(sizes) >= number)  # type: ignore[misc]
        user.keys("+z -z")

    def pressed(key: int, _: object) -> None:
        if key == Key.F:
            stage.m.mlx_set_fullscreen(stage.win, not sizes)
        else:
            stage.note("key", key)

    def resized(width: int, height: int, _: object) -> None:
        sizes.append([width, height])
        stage.note("back" if len(sizes) > 1 else "full", [width, height])

    stage.m.mlx_resize_hook(stage.win, resized)
    stage.m.mlx_hook(stage.win, Event.KEY_PRESS, 0, pressed, None)
    stage.play(acts)


@scenario(["title", "another"])
def the_title_changes(stage: Stage) -> None:
    def acts(user: User) -> None:
        user.keys("+a -a")
        user.read_title()

    stage.m.mlx_key_hook(stage.win, lambda *_: stage.m.mlx_set_window_title(stage.win, "another"), None)
    stage.play(acts)
