"""Scenarios of the contract: opening and closing windows, the loop and its hooks."""

from __future__ import annotations

import io
import threading
from contextlib import redirect_stderr
from typing import TYPE_CHECKING

from minirt.mlx import Event
from tests.mlx.contract import scenario

if TYPE_CHECKING:
    from tests.mlx.contract import Harness
    from tests.mlx.user import User


@scenario(["map"], ["expose", "mine"], ["looked", [[9, 9, 9]]])
def a_window_is_mapped_and_exposed_at_first(harness: Harness) -> None:
    def draw(param: str) -> None:
        harness.m.mlx_pixel_put(harness.mlx, harness.win, 1, 1, 0xFF090909)
        if len(harness.log) == 1:  # the window system may send further events
            harness.record("expose", param)

    harness.hook(Event.MAP_NOTIFY, "map")
    harness.m.mlx_expose_hook(harness.win, draw, "mine")
    harness.run(lambda user: user.log_picture("looked", lambda picture: [picture[1, 1].tolist()]))


@scenario(["hidden"], ["ticks while hidden"], ["shown"], ["exposed", True], ["kept", [7, 8, 9]])
def a_minimised_window_keeps_its_picture_and_the_loop_goes_on(harness: Harness) -> None:
    ticks: list[int] = []
    exposes: list[int] = []

    def actions(user: User) -> None:
        user.wait_until(lambda: bool(ticks), 0.1)
        user.do(lambda: harness.hook(Event.MAP_NOTIFY, "shown"))
        user.minimise()
        user.until(lambda: len(harness.log) == 1)
        user.do(ticks.clear)
        user.wait_until(lambda: len(ticks) >= 5, 0.4)
        user.do(lambda: harness.record("ticks while hidden"))
        user.do(exposes.clear)
        user.restore()
        user.until(lambda: len(harness.log) == 3 and len(exposes) > 0)
        user.do(lambda: harness.record("exposed", bool(exposes)))
        user.log_picture("kept", lambda picture: picture[50, 100].tolist())

    harness.m.mlx_pixel_put(harness.mlx, harness.win, 100, 50, 0xFF070809)
    harness.hook(Event.UNMAP_NOTIFY, "hidden")
    harness.m.mlx_loop_hook(harness.mlx, ticks.append, 1)
    harness.m.mlx_expose_hook(harness.win, exposes.append, 1)
    harness.run(actions)


@scenario(["close", 17], ["close", 33], ["key", 97])
def the_close_button_calls_its_hook_and_closes_nothing(harness: Harness) -> None:
    for event in (Event.DESTROY_NOTIFY, Event.CLIENT_MESSAGE):
        harness.m.mlx_hook(harness.win, event, 0, lambda param: harness.record("close", param), int(event))
    harness.hook(Event.KEY_PRESS, "key")

    def actions(user: User) -> None:
        user.close_button()
        user.until(lambda: len(harness.log) == 2)
        user.keys("+a -a")

    harness.run(actions)


@scenario(["closed", 0], ["left", 0])
def destroying_the_last_window_in_a_hook_ends_the_loop(harness: Harness) -> None:
    def closed(param: str) -> None:
        harness.record(param, harness.m.mlx_destroy_window(harness.mlx, harness.win))
        harness.m.mlx_destroy_window(harness.mlx, harness.win)

    harness.m.mlx_close_hook(harness.win, closed, "closed")
    harness.hook(Event.CLIENT_MESSAGE, "not after the window is gone")
    harness.run(lambda user: user.close_button())
    harness.m.mlx_destroy_window(harness.mlx, harness.win)
    harness.record("left", harness.m.mlx_loop(harness.mlx))


@scenario(["second", 98], ["first", 97], ["gone"], ["second", 99])
def several_windows_have_their_own_hooks(harness: Harness) -> None:
    second = harness.m.mlx_new_window(harness.mlx, 120, 80, "second")
    harness.hook(Event.KEY_PRESS, "first")
    harness.hook(Event.KEY_PRESS, "second", second)

    def close(_: object) -> None:
        harness.m.mlx_destroy_window(harness.mlx, harness.win)
        harness.record("gone")

    harness.m.mlx_close_hook(harness.win, close)

    def actions(user: User) -> None:
        for number, (window, key) in enumerate(((second, "b"), (harness.win, "a"))):
            user.focus(window)
            user.keys(f"+{key} -{key}")
            user.until(lambda number=number: len(harness.log) == number + 1)  # type: ignore[misc]
        user.close_button()
        user.until(lambda: len(harness.log) == 3)
        user.focus(second)
        user.keys("+c -c")

    harness.run(actions)


@scenario(["wheel", 4], ["raised", "no wheel"], ["again", 98])
def an_exception_of_a_hook_is_raised_by_the_loop(harness: Harness) -> None:
    def turned(button: int, _x: int, _y: int, _: object) -> None:
        harness.record("wheel", button)
        raise KeyError("no wheel")

    harness.m.mlx_mouse_hook(harness.win, turned, None)
    harness.hook(Event.BUTTON_RELEASE, "not after the error")  # comes with the press
    try:
        harness.run(lambda user: user.click(5, 5, 4))
    except KeyError as error:
        harness.record("raised", error.args[0])
    harness.hook(Event.KEY_PRESS, "again")
    harness.run(lambda user: user.keys("+b -b"))


@scenario(["wheel", 4], ["exit"], ["wheel", 4], ["key", 98], ["printed", 2, 1])
def the_loop_goes_on_after_an_exception_of_a_hook(harness: Harness) -> None:
    """It is printed, even SystemExit, as the official wrapper does."""
    harness.m.mlx_set_options(strict=False)

    def turned(button: int, _x: int, _y: int, _: object) -> None:
        harness.record("wheel", button)
        raise KeyError("no wheel")

    def released(*_: object) -> None:
        harness.m.mlx_hook(harness.win, Event.BUTTON_RELEASE, 0, None, None)
        harness.record("exit")
        raise SystemExit(3)

    harness.m.mlx_mouse_hook(harness.win, turned, None)
    harness.m.mlx_hook(harness.win, Event.BUTTON_RELEASE, 0, released, None)
    harness.hook(Event.KEY_PRESS, "key")

    def actions(user: User) -> None:
        for count in (2, 3):
            user.click(5, 5, 4)
            user.until(lambda count=count: len(harness.log) == count)  # type: ignore[misc]
        user.keys("+b -b")
        user.until(lambda: len(harness.log) == 4)
        user.do(
            lambda: harness.record("printed", *map(errors.getvalue().count, ("KeyError: 'no wheel'", "SystemExit: 3")))
        )

    errors = io.StringIO()
    with redirect_stderr(errors):
        harness.run(actions)


@scenario(["wheel", 4], ["returned", 0], ["loop", 0], ["again", 98])
def no_hook_is_called_after_loop_exit(harness: Harness) -> None:
    def turned(button: int, _x: int, _y: int, _: object) -> None:
        harness.record("wheel", button)
        harness.m.mlx_loop_exit(harness.mlx)

    harness.m.mlx_mouse_hook(harness.win, turned, None)
    harness.hook(Event.BUTTON_RELEASE, "not after the end")  # comes with the press
    harness.run(lambda user: user.click(5, 5, 4))
    harness.record("returned", harness.m.mlx_loop_exit(harness.mlx))  # no loop runs: the next one returns at once
    harness.record("loop", harness.m.mlx_loop(harness.mlx))
    harness.hook(Event.KEY_PRESS, "again")
    harness.run(lambda user: user.keys("+b -b"))


@scenario(["ticks", 5])
def the_loop_hook_ticks_until_it_is_removed(harness: Harness) -> None:
    """The loop hook ticks until it is removed. test_memory and test_window test its rate in simulated time."""
    ticks: list[int] = []

    def tick(_: object) -> None:
        ticks.append(1)
        if len(ticks) == 5:
            harness.m.mlx_loop_hook(harness.mlx, None, None)

    harness.m.mlx_loop_hook(harness.mlx, tick, None)

    def actions(user: User) -> None:
        user.wait_until(lambda: len(ticks) == 5, 0.2)
        user.wait_until_asleep(0.3)
        user.do(lambda: harness.record("ticks", len(ticks)))

    harness.run(actions)


@scenario(["woken", "mine", True])
def a_sleeping_loop_is_woken_from_another_thread(harness: Harness) -> None:
    main = threading.get_ident()
    harness.m.mlx_wake_hook(
        harness.mlx, lambda param: harness.record("woken", param, threading.get_ident() == main), "mine"
    )
    harness.run(lambda user: user.wake())


@scenario(["clipboard", "c 1,2,3"])
def the_clipboard_keeps_text(harness: Harness) -> None:
    harness.m.mlx_set_clipboard(harness.win, "c 1,2,3")
    harness.record("clipboard", harness.m.mlx_get_clipboard(harness.win))
