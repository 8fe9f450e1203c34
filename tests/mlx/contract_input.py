"""Scenarios of the contract: keys, text, focus and mouse."""

from __future__ import annotations

from typing import TYPE_CHECKING

from minirt.mlx import Event, Modifier
from tests.mlx.contract import scenario

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.mlx.contract import Harness, Log
    from tests.mlx.user import User


def log_keys(harness: Harness) -> None:
    """Log presses and releases of keys."""
    harness.hook(Event.KEY_PRESS, "press")
    harness.hook(Event.KEY_RELEASE, "release")


TYPED = {  # keys that are pressed and released, and the codes that the program gets, negative ones for releases
    "a_key_is_pressed_and_released": ("+a -a +escape -escape", [97, -97, 65307, -65307]),
    "shift_tab_is_tab": ("+shift +tab -tab -shift", [65505, 65289, -65289, -65505]),
    "a_key_has_the_code_that_it_has_without_modifiers": (
        "+shift +digit_1 -digit_1 +equal -shift -equal +keypad_left -keypad_left",
        [65505, 49, -49, 61, -65505, -61, 65430, -65430],
    ),
    "a_symbol_whose_release_is_lost_is_released_with_shift": (
        2 * "+shift +equal -shift -equal ",
        2 * [65505, 43, -65505, -43],
    ),
    "a_letter_stays_held_when_shift_is_let_go": ("+shift +w -shift +z -z -w", [65505, 119, -65505, 122, -122, -119]),
}


def typed(name: str) -> Callable[[Harness], None]:
    """Make the scenario of a row of TYPED."""

    def program(harness: Harness) -> None:
        harness.m.mlx_set_options(symbols="symbol" in name)
        log_keys(harness)
        harness.hook(Event.DESTROY_NOTIFY, "Escape is not the close button")
        harness.run(lambda user: user.keys(TYPED[name][0]))

    program.__name__ = name
    return program


for scenario_name, (_, codes) in TYPED.items():
    scenario(*(["press" if code > 0 else "release", abs(code)] for code in codes))(typed(scenario_name))


@scenario(["hold"], ["key", 97, "mine"])
def key_hook_fires_on_release(harness: Harness) -> None:
    harness.m.mlx_key_hook(harness.win, lambda key, param: harness.record("key", key, param), "mine")
    harness.m.mlx_hook(harness.win, Event.KEY_PRESS, 0, lambda key, param: harness.record("hold"), None)
    harness.run(lambda user: user.keys("+a -a"))


@scenario(["second", 97])
def a_second_hook_replaces_the_first_and_none_removes(harness: Harness) -> None:
    harness.hook(Event.KEY_PRESS, "first")
    harness.hook(Event.KEY_PRESS, "second")
    harness.hook(Event.KEY_RELEASE, "removed")
    harness.m.mlx_hook(harness.win, Event.KEY_RELEASE, 0, None, None)
    harness.run(lambda user: user.keys("+a -a"))


@scenario(["text", "a"], ["text", "+"], ["text", "?"])
def text_is_the_printed_characters(harness: Harness) -> None:
    harness.m.mlx_text_hook(harness.win, lambda text, param: harness.record(param, text), "text")
    printed = "+a -a +shift +equal -equal +slash -slash -shift"
    not_printed = "+escape -escape +ctrl +a -a -ctrl"
    harness.run(lambda user: user.keys(f"{printed} {not_printed}"))


@scenario([65507, 2], [65505, 3], [122, 3], ["up", 122, 3], ["up", 65505, 2], ["up", 65507, 0], ["click", 0])
def modifiers_are_known_in_hooks(harness: Harness) -> None:
    def modifiers() -> int:
        return int(harness.m.mlx_get_modifiers(harness.win) & (Modifier.SHIFT | Modifier.CTRL | Modifier.ALT))

    harness.m.mlx_hook(harness.win, Event.KEY_PRESS, 0, lambda key, _: harness.record(key, modifiers()), None)
    harness.m.mlx_hook(harness.win, Event.KEY_RELEASE, 0, lambda key, _: harness.record("up", key, modifiers()), None)
    harness.m.mlx_mouse_hook(harness.win, lambda *_: harness.record("click", modifiers()), None)

    def actions(user: User) -> None:
        user.keys("+ctrl +shift +z -z -shift -ctrl")
        user.click(5, 5)

    harness.run(actions)


@scenario(["press", 119], ["release", 119], ["out"], ["in"], ["press", 119], ["release", 119])
def losing_the_focus_releases_held_keys(harness: Harness) -> None:
    other = harness.m.mlx_new_window(harness.mlx, 100, 100, "other")
    log_keys(harness)

    def actions(user: User) -> None:
        user.keys("+w")
        user.until(lambda: ["press", 119] in harness.log)
        harness.hook(Event.FOCUS_OUT, "out")
        user.focus(other)
        user.keys("-w")
        user.until(lambda: ["out"] in harness.log)
        harness.hook(Event.FOCUS_IN, "in")
        user.focus(harness.win)
        user.keys("+w -w")

    harness.run(actions)


@scenario(["press", 119], ["typed again", True], ["release", 119])
def a_held_key_does_not_repeat_if_asked_for(harness: Harness) -> None:
    """The platform repeats the key as text only."""
    typed: list[str] = []
    harness.m.mlx_do_key_autorepeatoff(harness.mlx)
    log_keys(harness)
    harness.m.mlx_text_hook(harness.win, lambda text, _: typed.append(text))

    def actions(user: User) -> None:
        user.hold_until("w", lambda: len(typed) > 5)
        user.do(lambda: harness.record("typed again", set(typed) == {"w"}))
        user.keys("-w")

    harness.run(actions)


@scenario(["repeats", True])
def a_held_key_repeats(harness: Harness) -> None:
    seen: Log = []
    harness.m.mlx_hook(harness.win, Event.KEY_PRESS, 0, lambda key, _: seen.append([2, key]), None)
    harness.m.mlx_hook(harness.win, Event.KEY_RELEASE, 0, lambda key, _: seen.append([3, key]), None)

    def actions(user: User) -> None:
        user.hold_until("w", lambda: len(seen) >= 8)
        user.keys("-w")
        user.wait_until_handled()
        user.do(lambda: harness.record("repeats", seen == [[2, 119], [3, 119]] * (len(seen) // 2)))

    harness.run(actions)


@scenario(
    *(entry for button, x in ((1, 10), (2, 11), (3, 12), (4, 13), (5, 14), (6, 15), (7, 16))
      for entry in (["down", button, x, 20], ["up", button, x, 20]))
)  # fmt: skip
def buttons_and_wheel_press_and_release(harness: Harness) -> None:
    harness.hook(Event.BUTTON_PRESS, "down")
    harness.hook(Event.BUTTON_RELEASE, "up")

    def actions(user: User) -> None:
        for button in range(1, 8):
            user.click(9 + button, 20, button)
            # A window manager may grab the pointer during a click: a move in between would go to the window manager.
            user.until(lambda button=button: len(harness.log) >= 2 * button)  # type: ignore[misc]

    harness.run(actions)


@scenario(["motion", 0, 0, [0, 0, 0]], ["motion", 199, 99, [0, 199, 99]])
def motion_counts_from_the_top_left(harness: Harness) -> None:
    def moved(x: int, y: int, param: str) -> None:
        if [x, y] in ([0, 0], [199, 99]):  # the pointer may report other positions on its way
            harness.record(param, x, y, list(harness.m.mlx_mouse_get_pos(harness.win)))

    harness.m.mlx_hook(harness.win, Event.MOTION_NOTIFY, 0, moved, "motion")

    def actions(user: User) -> None:
        user.move(100, 50)
        user.move(0, 0)
        user.until(lambda: len(harness.log) == 1)
        user.move(199, 99)

    harness.run(actions)


@scenario(["at once", [0, 30, 40]], ["motion", 30, 40])
def the_program_moves_the_pointer(harness: Harness) -> None:
    def moved(x: int, y: int, param: str) -> None:
        if harness.log:
            harness.record(param, x, y)

    def pressed(*_: object) -> None:
        harness.m.mlx_mouse_move(harness.win, 30, 40)
        harness.record("at once", list(harness.m.mlx_mouse_get_pos(harness.win)))

    harness.m.mlx_hook(harness.win, Event.MOTION_NOTIFY, 0, moved, "motion")
    harness.m.mlx_hook(harness.win, Event.KEY_PRESS, 0, pressed, None)

    def actions(user: User) -> None:
        user.move(100, 50)
        user.wait_until_handled()
        user.keys("+a -a")

    harness.run(actions)


@scenario(["enter"], ["leave"])
def the_pointer_enters_and_leaves(harness: Harness) -> None:
    def actions(user: User) -> None:
        user.leave()
        user.wait_until_handled()
        harness.hook(Event.ENTER_NOTIFY, "enter")
        harness.hook(Event.LEAVE_NOTIFY, "leave")
        user.enter()
        user.leave()

    harness.run(actions)


@scenario(["drop", "/tmp/a scene.rt"], ["drop", "/tmp/caf\u00e9.rt"], ["end"])
def dropped_files(harness: Harness) -> None:
    """Files are dropped one by one, with names as they are; without a hook they are ignored."""
    harness.m.mlx_drop_hook(harness.win, lambda file, name: harness.record(name, file), "drop")

    def actions(user: User) -> None:
        user.drop("/tmp/a scene.rt", "/tmp/caf\u00e9.rt")
        user.until(lambda: len(harness.log) == 2)
        user.do(lambda: harness.m.mlx_drop_hook(harness.win, None))
        user.drop("/tmp/a scene.rt")
        user.wait_until_handled()
        user.do(lambda: harness.record("end"))

    harness.run(actions)
