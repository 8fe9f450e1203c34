"""Events and mouse buttons, with X11's numbers, for `Mlx.mlx_hook`."""

from enum import IntEnum


class Event(IntEnum):
    """Events that a hook can be set on; each comment lists the arguments before the hook's own parameter."""

    KEY_PRESS = 2  # keycode
    KEY_RELEASE = 3  # keycode
    BUTTON_PRESS = 4  # button, x, y
    BUTTON_RELEASE = 5  # button, x, y
    MOTION_NOTIFY = 6  # x, y
    ENTER_NOTIFY = 7
    LEAVE_NOTIFY = 8
    FOCUS_IN = 9
    FOCUS_OUT = 10
    EXPOSE = 12
    DESTROY_NOTIFY = 17  # the close button; the window stays until the program destroys it
    UNMAP_NOTIFY = 18  # hidden, minimised
    MAP_NOTIFY = 19
    CONFIGURE_NOTIFY = 22  # resized
    CLIENT_MESSAGE = 33  # the close button, after DESTROY_NOTIFY


class Button(IntEnum):
    """Mouse buttons; each step of the wheel is a press and a release."""

    LEFT = 1
    MIDDLE = 2
    RIGHT = 3
    WHEEL_UP = 4
    WHEEL_DOWN = 5
    WHEEL_LEFT = 6
    WHEEL_RIGHT = 7
    BACK = 8
    FORWARD = 9
