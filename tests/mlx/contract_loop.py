"""The window contract: opening and closing, the loop and its hooks."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from minirt.mlx import Event
from tests.mlx.contract import scenario

if TYPE_CHECKING:
    from tests.mlx.stage import Stage
    from tests.mlx.user import User


@scenario(["map"], ["expose", "mine"], ["looked", [[9, 9, 9]]])
def a_window_is_mapped_and_exposed_at_first(stage: Stage) -> None:
    def draw(param: str) -> None:
        stage.m.mlx_pixel_put(stage.mlx, stage.win, 1, 1, 0x090909)
        if len(stage.log) == 1:  # the window system may ask again
            stage.note("expose", param)

    stage.hook(Event.MAP_NOTIFY, "map")
    stage.m.mlx_expose_hook(stage.win, draw, "mine")
    stage.play(lambda user: user.look("looked", lambda picture: [picture[1, 1].tolist()]))


@scenario(["hidden"], ["ticks while hidden"], ["shown"], ["exposed", True], ["kept", [7, 8, 9]])
def a_minimised_window_keeps_its_picture_and_the_loop_goes_on(stage: Stage) -> None:
    ticks: list[int] = []
    exposes: list[int] = []

    def acts(user: User) -> None:
        user.wait_until(lambda: bool(ticks), 0.1)
        user.then(lambda: stage.hook(Event.MAP_NOTIFY, "shown"))
        user.minimise()
        user.until(lambda: len(stage.log) == 1)
        user.then(ticks.clear)
        user.wait_until(lambda: len(ticks) >= 5, 0.4)
        user.then(lambda: stage.note("ticks while hidden"))
        user.then(exposes.clear)
        user.restore()
        user.until(lambda: len(stage.log) == 3 and len(exposes) > 0)
        user.then(lambda: stage.note("exposed", bool(exposes)))
        user.look("kept", lambda picture: picture[50, 100].tolist())

    stage.m.mlx_pixel_put(stage.mlx, stage.win, 100, 50, 0x070809)
    stage.hook(Event.UNMAP_NOTIFY, "hidden")
    stage.m.mlx_loop_hook(stage.mlx, ticks.append, 1)
    stage.m.mlx_expose_hook(stage.win, exposes.append, 1)
    stage.play(acts)


@scenario(["close", 17], ["close", 33], ["key", 97])
def the_close_button_asks_and_closes_nothing(stage: Stage) -> None:
    for event in (Event.DESTROY_NOTIFY, Event.CLIENT_MESSAGE):
        stage.m.mlx_hook(stage.win, event, 0, lambda param: stage.note("close", param), int(event))
    stage.hook(Event.KEY_PRESS, "key")

    def acts(user: User) -> None:
        user.close_button()
        user.until(lambda: len(stage.log) == 2)
        user.keys("+a -a")

    stage.play(acts)


@scenario(["closed", 0], ["left", 0])
def destroying_the_last_window_in_a_hook_ends_the_loop(stage: Stage) -> None:
    def closed(param: str) -> None:
        stage.note(param, stage.m.mlx_destroy_window(stage.mlx, stage.win))
        stage.m.mlx_destroy_window(stage.mlx, stage.win)

    stage.m.mlx_close_hook(stage.win, closed, "closed")
    stage.hook(Event.CLIENT_MESSAGE, "not after the window is gone")
    stage.play(lambda user: user.close_button())
    stage.m.mlx_destroy_window(stage.mlx, stage.win)
    stage.note("left", stage.m.mlx_loop(stage.mlx))


@scenario(["second", 98], ["first", 97], ["gone"], ["second", 99])
def several_windows_have_their_own_hooks(stage: Stage) -> None:
    second = stage.m.mlx_new_window(stage.mlx, 120, 80, "second")
    stage.hook(Event.KEY_PRESS, "first")
    stage.hook(Event.KEY_PRESS, "second", second)

    def close(_: object) -> None:
        stage.m.mlx_destroy_window(stage.mlx, stage.win)
        stage.note("gone")

    stage.m.mlx_close_hook(stage.win, close)

    def acts(user: User) -> None:
        for number, (window, key) in enumerate(((second, "b"), (stage.win, "a"))):
            user.focus(window)
            user.keys(f"+{key} -{key}")
            user.until(lambda number=number: len(stage.log) == number + 1)  # type: ignore[misc]
        user.close_button(stage.win)
        user.until(lambda: len(stage.log) == 3)
        user.focus(second)
        user.keys("+c -c")

    stage.play(acts)


@scenario(["wheel", 4], ["raised", "no wheel"], ["again", 98])
def what_a_hook_raises_comes_out_of_the_loop(stage: Stage) -> None:
    def turned(button: int, _x: int, _y: int, _: object) -> None:
        stage.note("wheel", button)
        raise KeyError("no wheel")

    stage.m.mlx_mouse_hook(stage.win, turned, None)
    stage.hook(Event.BUTTON_RELEASE, "not after the error")  # comes with the press
    try:
        stage.play(lambda user: user.click(5, 5, 4))
    except KeyError as error:
        stage.note("raised", error.args[0])
    stage.hook(Event.KEY_PRESS, "again")
    stage.play(lambda user: user.keys("+b -b"))


@scenario(["exit", 3])
def sys_exit_in_a_hook_comes_out_of_the_loop(stage: Stage) -> None:
    ticks: list[int] = []

    def leave(_: object) -> None:
        ticks.append(1)
        raise SystemExit(3)

    stage.m.mlx_loop_hook(stage.mlx, leave, None)
    try:
        stage.play(lambda user: user.wait_until(lambda: bool(ticks), 1.0))
    except SystemExit as exit_:
        stage.note("exit", exit_.code)


@scenario(["wheel", 4], ["returned", 0], ["again", 98])
def no_hook_is_called_after_loop_exit(stage: Stage) -> None:
    def turned(button: int, _x: int, _y: int, _: object) -> None:
        stage.note("wheel", button)
        stage.m.mlx_loop_exit(stage.mlx)

    stage.m.mlx_mouse_hook(stage.win, turned, None)
    stage.hook(Event.BUTTON_RELEASE, "not after the end")  # comes with the press
    stage.play(lambda user: user.click(5, 5, 4))
    stage.m.mlx_loop_exit(stage.mlx)
    stage.note("returned", stage.m.mlx_loop(stage.mlx))
    stage.hook(Event.KEY_PRESS, "again")
    stage.play(lambda user: user.keys("+b -b"))


@scenario(["ticks", 5])
def the_loop_hook_ticks_until_it_is_removed(stage: Stage) -> None:
    """Its pace is asked for with simulated time, in test_memory and test_pace."""
    ticks: list[int] = []

    def tick(_: object) -> None:
        ticks.append(1)
        if len(ticks) == 5:
            stage.m.mlx_loop_hook(stage.mlx, None, None)

    stage.m.mlx_loop_hook(stage.mlx, tick, None)

    def acts(user: User) -> None:
        user.wait_until(lambda: len(ticks) == 5, 0.2)
        user.rest(0.3)
        user.then(lambda: stage.note("ticks", len(ticks)))

    stage.play(acts)


@scenario(["woken", "mine", True])
def a_sleeping_loop_is_woken_from_another_thread(stage: Stage) -> None:
    main = threading.get_ident()
    stage.m.mlx_wake_hook(stage.mlx, lambda param: stage.note("woken", param, threading.get_ident() == main), "mine")
    stage.play(lambda user: user.wake())


@scenario(["clipboard", "c 1,2,3"])
def the_clipboard_keeps_text(stage: Stage) -> None:
    stage.m.mlx_set_clipboard(stage.win, "c 1,2,3")
    stage.note("clipboard", stage.m.mlx_get_clipboard(stage.win))
