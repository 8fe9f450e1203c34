"""Keys, buttons and pointer shapes of events; keys by X11's keysyms, as MiniLibX passes them to hooks."""

from __future__ import annotations

import sys
from enum import Enum, IntEnum, IntFlag


class Key(IntEnum):
    """Named keys. A hook receives plain integers, which may be keys without a name here.

    The code is that of the symbol which the key prints without modifiers: a letter's lower case, and 1 even if Shift
    makes it an exclamation mark. With the option `symbols` it is that of the printed symbol.
    """

    SPACE = 0x20
    EXCLAMATION = 0x21
    HASH = 0x23
    APOSTROPHE = 0x27
    ASTERISK, PLUS, COMMA, MINUS, PERIOD, SLASH = range(0x2A, 0x30)
    DIGIT_0, DIGIT_1, DIGIT_2, DIGIT_3, DIGIT_4, DIGIT_5, DIGIT_6, DIGIT_7, DIGIT_8, DIGIT_9 = range(0x30, 0x3A)
    COLON, SEMICOLON, LESS, EQUAL, GREATER, QUESTION = range(0x3A, 0x40)
    BRACKET_LEFT, BACKSLASH, BRACKET_RIGHT = range(0x5B, 0x5E)
    UNDERSCORE, GRAVE = range(0x5F, 0x61)
    A, B, C, D, E, F, G, H, I, J, K, L, M, N, O, P, Q, R, S, T, U, V, W, X, Y, Z = range(0x61, 0x7B)  # noqa: E741
    BACKSPACE, TAB = range(0xFF08, 0xFF0A)
    RETURN = 0xFF0D
    PAUSE = 0xFF13
    ESCAPE = 0xFF1B
    HOME, LEFT, UP, RIGHT, DOWN, PAGE_UP, PAGE_DOWN, END = range(0xFF50, 0xFF58)
    INSERT = 0xFF63
    KEYPAD_ENTER = 0xFF8D
    # The keys of the keypad with these names print digits only with Num Lock.
    KEYPAD_HOME, KEYPAD_LEFT, KEYPAD_UP, KEYPAD_RIGHT, KEYPAD_DOWN, KEYPAD_PAGE_UP = range(0xFF95, 0xFF9B)
    KEYPAD_PAGE_DOWN, KEYPAD_END, KEYPAD_BEGIN, KEYPAD_INSERT, KEYPAD_DELETE = range(0xFF9B, 0xFFA0)
    KEYPAD_MULTIPLY, KEYPAD_ADD = range(0xFFAA, 0xFFAC)
    KEYPAD_SUBTRACT = 0xFFAD
    KEYPAD_DIVIDE = 0xFFAF
    F1, F2, F3, F4, F5, F6, F7, F8, F9, F10, F11, F12 = range(0xFFBE, 0xFFCA)
    SHIFT_L, SHIFT_R, CONTROL_L, CONTROL_R = range(0xFFE1, 0xFFE5)
    ALT_L, ALT_R, SUPER_L, SUPER_R = range(0xFFE9, 0xFFED)  # SUPER is the Windows key
    COMMAND_L, COMMAND_R = range(0xFFED, 0xFFEF)  # macOS
    DELETE = 0xFFFF


KEYS = {"".join(map(str.capitalize, key.name.split("_"))): key for key in Key}  # PageUp, A, F1


class Modifier(IntFlag):
    """Modifier keys that are held, as `Mlx.mlx_get_modifiers` returns them."""

    NONE = 0
    SHIFT = 1
    CTRL = 2
    ALT = 4
    COMMAND = 8  # macOS
    ACCEL = COMMAND if sys.platform == "darwin" else CTRL  # the modifier of this platform's shortcuts


NAMES = {"SHIFT": Modifier.SHIFT, "CONTROL": Modifier.CTRL, "ALT": Modifier.ALT, "COMMAND": Modifier.COMMAND}
MODIFIER_KEYS: dict[int, Modifier] = {Key[f"{name}_{side}"]: NAMES[name] for name in NAMES for side in "LR"}


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


class Cursor(Enum):
    """Shape of the pointer over a window, by the meaning that it has for the user."""

    ARROW = "arrow"  # the usual one
    MOVE = "move"  # something moves with the pointer
    TURN = "turn"  # something turns with the pointer
    GRAB = "grab"  # the picture slides with the pointer
