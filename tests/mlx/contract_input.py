"""The window contract: keys, text, focus and mouse."""

from __future__ import annotations

from typing import TYPE_CHECKING

from minirt.mlx import Event, Modifier
from tests.mlx.contract import scenario

if TYPE_CHECKING:
    from tests.mlx.contract import Log
    from tests.mlx.stage import Stage
    from tests.mlx.user import User


def keys(stage: Stage) -> None:
    stage.hook(Event.KEY_PRESS, "press")
    stage.hook(Event.KEY_RELEASE, "release")


@scenario(["press", 97], ["release", 97], ["press", 65307], ["release", 65307])
def a_key_is_pressed_and_released(stage: Stage) -> None:
    keys(stage)
    stage.hook(Event.DESTROY_NOTIFY, "Escape is not the close button")
    stage.play(lambda user: user.keys("+a -a +escape -escape"))


@scenario(["hold"], ["key", 97, "mine"])
def key_hook_fires_on_release(stage: Stage) -> None:
    stage.m.mlx_key_hook(stage.win, lambda key, param: stage.note("key", key, param), "mine")
    stage.m.mlx_hook(stage.win, Event.KEY_PRESS, 0, lambda key, param: stage.note("hold"), None)
    stage.play(lambda user: user.keys("+a -a"))


@scenario(["second", 97])
def a_second_hook_replaces_the_first_and_none_removes(stage: Stage) -> None:
    stage.hook(Event.KEY_PRESS, "first")
    stage.hook(Event.KEY_PRESS, "second")
    stage.hook(Event.KEY_RELEASE, "removed")
    stage.m.mlx_hook(stage.win, Event.KEY_RELEASE, 0, None, None)
    stage.play(lambda user: user.keys("+a -a"))


@scenario(["press", 65505], ["press", 65289], ["release", 65289], ["release", 65505])
def shift_tab_is_tab(stage: Stage) -> None:
    keys(stage)
    stage.play(lambda user: user.keys("+shift +tab -tab -shift"))


PLUS_LOST = [["press", 65505], ["press", 43], ["release", 65505], ["release", 43]]


@scenario(*PLUS_LOST, *PLUS_LOST)
def a_symbol_whose_release_is_lost_is_released_with_shift(stage: Stage) -> None:
    keys(stage)
    stage.play(lambda user: user.keys(2 * "+shift +equal -shift -equal "))


@scenario(["press", 65505], ["press", 119], ["release", 65505], ["press", 122], ["release", 122], ["release", 119])
def a_letter_stays_held_when_shift_is_let_go(stage: Stage) -> None:
    keys(stage)
    stage.play(lambda user: user.keys("+shift +w -shift +z -z -w"))


@scenario(["text", "a"], ["text", "+"], ["text", "?"])
def text_is_what_is_printed(stage: Stage) -> None:
    stage.m.mlx_text_hook(stage.win, lambda text, param: stage.note(param, text), "text")
    printed = "+a -a +shift +equal -equal +slash -slash -shift"
    not_printed = "+escape -escape +ctrl +a -a -ctrl"
    stage.play(lambda user: user.keys(f"{printed} {not_printed}"))


@scenario([65507, 2], [65505, 3], [122, 3], ["up", 122, 3], ["up", 65505, 2], ["up", 65507, 0], ["click", 0])
def modifiers_are_known_in_hooks(stage: Stage) -> None:
    def modifiers() -> int:
        return int(stage.m.mlx_get_modifiers(stage.win) & (Modifier.SHIFT | Modifier.CTRL | Modifier.ALT))

    stage.m.mlx_hook(stage.win, Event.KEY_PRESS, 0, lambda key, _: stage.note(key, modifiers()), None)
    stage.m.mlx_hook(stage.win, Event.KEY_RELEASE, 0, lambda key, _: stage.note("up", key, modifiers()), None)
    stage.m.mlx_mouse_hook(stage.win, lambda *_: stage.note("click", modifiers()), None)

    def acts(user: User) -> None:
        user.keys("+ctrl +shift +z -z -shift -ctrl")
        user.click(5, 5)

    stage.play(acts)


@scenario(["press", 119], ["release", 119], ["out"], ["in"], ["press", 119], ["release", 119])
def losing_the_focus_releases_held_keys(stage: Stage) -> None:
    other = stage.m.mlx_new_window(stage.mlx, 100, 100, "other")
    keys(stage)

    def acts(user: User) -> None:
        user.keys("+w")
        user.until(lambda: ["press", 119] in stage.log)
        stage.hook(Event.FOCUS_OUT, "out")
        user.focus(other)
        user.keys("-w")
        user.until(lambda: ["out"] in stage.log)
        stage.hook(Event.FOCUS_IN, "in")
        user.focus(stage.win)
        user.keys("+w -w")

    stage.play(acts)


@scenario(["press", 119], ["typed again", True], ["release", 119])
def a_held_key_does_not_repeat(stage: Stage) -> None:
    """The platform's repetition is there, as text."""
    typed: list[str] = []
    keys(stage)
    stage.m.mlx_text_hook(stage.win, lambda text, _: typed.append(text))

    def acts(user: User) -> None:
        user.hold_until("w", lambda: len(typed) > 5)
        user.then(lambda: stage.note("typed again", set(typed) == {"w"}))
        user.keys("-w")

    stage.play(acts)


@scenario(["repeats", True])
def a_held_key_repeats_if_asked_for(stage: Stage) -> None:
    seen: Log = []
    stage.m.mlx_do_key_autorepeaton(stage.mlx)
    stage.m.mlx_hook(stage.win, Event.KEY_PRESS, 0, lambda key, _: seen.append([2, key]), None)
    stage.m.mlx_hook(stage.win, Event.KEY_RELEASE, 0, lambda key, _: seen.append([3, key]), None)

    def acts(user: User) -> None:
        user.hold_until("w", lambda: len(seen) >= 8)
        user.keys("-w")
        user.settle()
        user.then(lambda: stage.note("repeats", seen == [[2, 119], [3, 119]] * (len(seen) // 2)))

    stage.play(acts)


@scenario(
    *(entry for button, x in ((1, 10), (2, 11), (3, 12), (4, 13), (5, 14), (6, 15), (7, 16))
      for entry in (["down", button, x, 20], ["up", button, x, 20]))
)  # fmt: skip
def buttons_and_wheel_press_and_release(stage: Stage) -> None:
    stage.hook(Event.BUTTON_PRESS, "down")
    stage.hook(Event.BUTTON_RELEASE, "up")

    def acts(user: User) -> None:
        for button in range(1, 8):
            user.click(9 + button, 20, button)
            # A window manager may hold the pointer while it looks at a click: a move meanwhile would count for it.
            user.until(lambda button=button: len(stage.log) >= 2 * button)  # type: ignore[misc]

    stage.play(acts)


@scenario(["motion", 0, 0, [0, 0, 0]], ["motion", 199, 99, [0, 199, 99]])
def motion_counts_from_the_top_left(stage: Stage) -> None:
    def moved(x: int, y: int, param: str) -> None:
        if [x, y] in ([0, 0], [199, 99]):  # on the way to the window, the pointer may pass others
            stage.note(param, x, y, list(stage.m.mlx_mouse_get_pos(stage.win)))

    stage.m.mlx_hook(stage.win, Event.MOTION_NOTIFY, 0, moved, "motion")

    def acts(user: User) -> None:
        user.move(100, 50)
        user.move(0, 0)
        user.until(lambda: len(stage.log) == 1)
        user.move(199, 99)

    stage.play(acts)


@scenario(["enter"], ["leave"])
def the_pointer_enters_and_leaves(stage: Stage) -> None:
    def acts(user: User) -> None:
        user.leave()
        user.settle()
        stage.hook(Event.ENTER_NOTIFY, "enter")
        stage.hook(Event.LEAVE_NOTIFY, "leave")
        user.enter()
        user.leave()

    stage.play(acts)


@scenario(["drop", "/tmp/a scene.rt"], ["drop", "/tmp/caf\u00e9.rt"], ["end"])
def dropped_files(stage: Stage) -> None:
    """One by one, under their own names; and no more when nobody asks."""
    stage.m.mlx_drop_hook(stage.win, lambda file, name: stage.note(name, file), "drop")

    def acts(user: User) -> None:
        user.drop("/tmp/a scene.rt", "/tmp/caf\u00e9.rt")
        user.until(lambda: len(stage.log) == 2)
        user.then(lambda: stage.m.mlx_drop_hook(stage.win, None))
        user.drop("/tmp/a scene.rt")
        user.settle()
        user.then(lambda: stage.note("end"))

    stage.play(acts)
