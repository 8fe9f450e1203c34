"""A program for the official wrapper with two windows, which looks at its process. `test_drop_in` runs it."""

import importlib.util
import sys
import time

import helper  # type: ignore[import-not-found]
import mlx  # type: ignore[import-not-found]
from mlx.mlx import Mlx  # type: ignore[import-not-found]

if __name__ == "__main__":
    assert mlx.Mlx is Mlx is mlx.mlx.Mlx
    assert importlib.util.find_spec("mlx")
    m = Mlx()
    ptr = m.mlx_init()
    print(m.mlx_get_screen_size(ptr), sys.argv[1:], helper.VALUE)
    begin = time.time()
    time.sleep(1000)
    while time.time() < begin + 1000.01:
        pass
    print(round(time.time() - begin, 1), time.monotonic_ns() // 10**12)
    windows = [m.mlx_new_window(ptr, 30, 20, name) for name in "ab"]
    for number, win in enumerate(windows):
        m.mlx_mouse_hook(win, lambda *arguments: print(arguments), number)
        m.mlx_pixel_put(ptr, win, 3, 4, 0xFF000000 | 0xFF << 8 * number)
    m.mlx_hook(windows[1], 33, 0, lambda _: m.mlx_loop_exit(ptr), None)
    m.mlx_loop(ptr)
    sys.exit("done")
