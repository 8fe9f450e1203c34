"""Key codes: X11's keysyms, as MiniLibX passes them to hooks."""

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
    ASTERISK = 0x2A
    PLUS = 0x2B
    COMMA = 0x2C
    MINUS = 0x2D
    PERIOD = 0x2E
    SLASH = 0x2F
    DIGIT_0 = 0x30
    DIGIT_1 = 0x31
    DIGIT_2 = 0x32
    DIGIT_3 = 0x33
    DIGIT_4 = 0x34
    DIGIT_5 = 0x35
    DIGIT_6 = 0x36
    DIGIT_7 = 0x37
    DIGIT_8 = 0x38
    DIGIT_9 = 0x39
    COLON = 0x3A
    SEMICOLON = 0x3B
    LESS = 0x3C
    EQUAL = 0x3D
    GREATER = 0x3E
    QUESTION = 0x3F
    BRACKET_LEFT = 0x5B
    BACKSLASH = 0x5C
    BRACKET_RIGHT = 0x5D
    UNDERSCORE = 0x5F
    GRAVE = 0x60
    A = 0x61
    B = 0x62
    C = 0x63
    D = 0x64
    E = 0x65
    F = 0x66
    G = 0x67
    H = 0x68
    I = 0x69  # noqa: E741
    J = 0x6A
    K = 0x6B
    L = 0x6C
    M = 0x6D
    N = 0x6E
    O = 0x6F  # noqa: E741
    P = 0x70
    Q = 0x71
    R = 0x72
    S = 0x73
    T = 0x74
    U = 0x75
    V = 0x76
    W = 0x77
    X = 0x78
    Y = 0x79
    Z = 0x7A
    BACKSPACE = 0xFF08
    TAB = 0xFF09
    RETURN = 0xFF0D
    PAUSE = 0xFF13
    ESCAPE = 0xFF1B
    HOME = 0xFF50
    LEFT = 0xFF51
    UP = 0xFF52
    RIGHT = 0xFF53
    DOWN = 0xFF54
    PAGE_UP = 0xFF55
    PAGE_DOWN = 0xFF56
    END = 0xFF57
    INSERT = 0xFF63
    KEYPAD_ENTER = 0xFF8D
    KEYPAD_HOME = 0xFF95  # the keys of the keypad with these names print digits only with Num Lock
    KEYPAD_LEFT = 0xFF96
    KEYPAD_UP = 0xFF97
    KEYPAD_RIGHT = 0xFF98
    KEYPAD_DOWN = 0xFF99
    KEYPAD_PAGE_UP = 0xFF9A
    KEYPAD_PAGE_DOWN = 0xFF9B
    KEYPAD_END = 0xFF9C
    KEYPAD_BEGIN = 0xFF9D
    KEYPAD_INSERT = 0xFF9E
    KEYPAD_DELETE = 0xFF9F
    KEYPAD_MULTIPLY = 0xFFAA
    KEYPAD_ADD = 0xFFAB
    KEYPAD_SUBTRACT = 0xFFAD
    KEYPAD_DIVIDE = 0xFFAF
    F1 = 0xFFBE
    F2 = 0xFFBF
    F3 = 0xFFC0
    F4 = 0xFFC1
    F5 = 0xFFC2
    F6 = 0xFFC3
    F7 = 0xFFC4
    F8 = 0xFFC5
    F9 = 0xFFC6
    F10 = 0xFFC7
    F11 = 0xFFC8
    F12 = 0xFFC9
    SHIFT_L = 0xFFE1
    SHIFT_R = 0xFFE2
    CONTROL_L = 0xFFE3
    CONTROL_R = 0xFFE4
    ALT_L = 0xFFE9
    ALT_R = 0xFFEA
    SUPER_L = 0xFFEB  # the Windows key
    SUPER_R = 0xFFEC
    COMMAND_L = 0xFFED  # macOS
    COMMAND_R = 0xFFEE
    DELETE = 0xFFFF


class Modifier(IntFlag):
    """Modifier keys that are held, as `Mlx.mlx_get_modifiers` returns them."""

    NONE = 0
    SHIFT = 1
    CTRL = 2
    ALT = 4
    COMMAND = 8  # macOS
    ACCEL = COMMAND if sys.platform == "darwin" else CTRL  # the modifier of this platform's shortcuts


MODIFIER_KEYS: dict[int, Modifier] = {
    Key.SHIFT_L: Modifier.SHIFT,
    Key.SHIFT_R: Modifier.SHIFT,
    Key.CONTROL_L: Modifier.CTRL,
    Key.CONTROL_R: Modifier.CTRL,
    Key.ALT_L: Modifier.ALT,
    Key.ALT_R: Modifier.ALT,
    Key.COMMAND_L: Modifier.COMMAND,
    Key.COMMAND_R: Modifier.COMMAND,
}


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
