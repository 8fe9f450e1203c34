"""Arguments of MiniLibX's functions: integers, handles, images, options, hooks; Host calls a program's hooks."""

from __future__ import annotations

import itertools
import operator
import sys
import threading
import time
import traceback
from abc import ABC
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray

Integer: TypeAlias = int | Any  # also an integer of ctypes or numpy
MaybeNone: TypeAlias = Any  # `MlxImage | MaybeNone`: None after a failure, unless `Options.strict` is set


@dataclass
class Options:
    """The defaults are what the official wrapper does.

    alpha: images and pixels are blended by their alpha; False copies them and ignores it, as the C library does.
    strict: failures and exceptions of hooks raise; False reports them on standard error, and the program goes on.
    symbols: a key is reported as the symbol that it prints, Shift+1 as 33; False reports the symbol that it
        prints without modifiers, 49.
    application: name by which the desktop knows the windows (X11's WM_CLASS); empty for their first title.
    """

    alpha: bool = True
    strict: bool = False
    symbols: bool = False
    application: str = ""


def integer(value: Integer) -> int:
    """Convert an integer of Python, ctypes or numpy. Raises TypeError for anything else, such as 1.0."""
    return operator.index(getattr(value, "value", value))


_numbers = itertools.count(1 << 40, 64)  # as great as addresses: no colour and no position equals a handle


class NumberedObject(int):
    """An object that is a number of its own, too: programs print handles, compare them and use them as keys."""

    def __new__(cls, *_arguments: object, **_named: object) -> Self:
        return super().__new__(cls, next(_numbers))


@dataclass(eq=False, repr=False)
class MlxImage(NumberedObject):
    """A picture to draw into: (h, w, 4) uint8, in memory blue, green, red, alpha."""

    pixels: NDArray[np.uint8]

    @property
    def width(self) -> int:
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        return int(self.pixels.shape[0])


Hook: TypeAlias = Callable[..., object]  # its last argument is the parameter given with it
Hooks: TypeAlias = dict[int | str, tuple[Hook, object]]  # with parameters, by event, or by a name for hooks of ours


def set_hook(hooks: Hooks, event: int | str, callback: Hook | None, param: object) -> int:
    """Set the one hook of an event, or remove it with None; return 0 as MiniLibX does."""
    if callback:
        hooks[event] = callback, param
    else:
        hooks.pop(event, None)
    return 0


class Host(NumberedObject, ABC):
    """What windows know of their display: options, a clock, and the calls of the program's hooks."""

    options: Options

    def __init__(self) -> None:
        self.hooks: Hooks = {}  # those of the display: loop, wake and lost
        self.actions: deque[Callable[[], object]] = deque()
        self.clipboard = ""  # where the platform has none
        self.awake = threading.Event()  # a turn is to be taken; where the loop waits for nothing else
        self.calling = 0  # hooks that are being called now, one inside another
        self.ending = False
        self.failure: BaseException | None = None  # raised by a hook

    def time(self) -> float:
        """Seconds of a clock that never runs backwards."""
        return time.perf_counter()

    def do(self, action: Callable[[], object]) -> None:
        """Let the loop perform an action before its next turn. May be called from any thread."""
        self.actions.append(action)
        self.wake_up()

    def wake_up(self) -> None:
        """Make the loop take a turn soon, one for calls that come together. May be called from any thread."""
        self.awake.set()

    def request_turn(self) -> None:
        """Note that a window has had an event, where the loop does not know that by itself."""

    def call(self, hooks: Hooks, event: int | str, *arguments: object) -> None:
        """Call the hook of an event, if there is one, with `arguments` and its parameter; not while the loop ends.

        An exception of the hook, even SystemExit, is printed, and the loop goes on. With `Options.strict`, and always
        for exceptions such as KeyboardInterrupt, the loop ends and raises the exception: a window system would lose an
        exception that is raised at once.
        """
        if event not in hooks or self.ending or self.failure is not None:
            return
        function, parameter = hooks[event]
        self.calling += 1
        try:
            function(*arguments, parameter)
        except BaseException as failure:
            if self.options.strict or not isinstance(failure, Exception | SystemExit):
                self.fail(failure)
            else:
                print(f"Exception ignored in the hook {getattr(function, '__qualname__', function)}:", file=sys.stderr)
                traceback.print_exception(failure)
        finally:
            self.calling -= 1

    def fail(self, failure: BaseException) -> None:
        """End the loop and raise `failure` from it; of several failures the first is raised."""
        self.failure = self.failure or failure

    def raise_failure(self) -> None:
        """Raise the exception of a hook, if there is one, once."""
        failure, self.failure = self.failure, None
        if failure is not None:
            raise failure
