"""A program for the official wrapper, as students write them: it knows nothing of ours. `test_drop_in` runs it."""

import os
import sys
import time
from ctypes import c_int
from pathlib import Path

from mlx import Mlx  # type: ignore[import-not-found]

MAZE = ["#######", "#S  # #", "# # # #", "# #  E#", "#######"]
CELL = 20
KEYS = {65361: (-1, 0), 65362: (0, -1), 65363: (1, 0), 65364: (0, 1)}


class Game(Mlx):  # type: ignore[misc]
    """The maze, its player and its sprite."""

    def __init__(self, title: str) -> None:
        super().__init__()
        self.mlx_ptr = self.mlx_init()
        self.win_ptr = self.mlx_new_window(self.mlx_ptr, c_int(CELL * len(MAZE[0])), CELL * len(MAZE), title)
        if not self.mlx_ptr or self.win_ptr is None:
            sys.exit("no window")
        self.walls = self.mlx_new_image(self.mlx_ptr, CELL * len(MAZE[0]), CELL * len(MAZE))
        data, bits, line, kind = self.mlx_get_data_addr(self.walls)
        assert (bits, kind) == (32, 0)
        for y in range(CELL * len(MAZE)):
            for x in range(CELL * len(MAZE[0])):
                wall = MAZE[y // CELL][x // CELL] == "#"
                data[y * line + x * 4 : y * line + x * 4 + 4] = (0xFF204060 if wall else 0xFFD0D0D0).to_bytes(
                    4, "little"
                )
        self.player, _, _ = self.mlx_xpm_file_to_image(self.mlx_ptr, str(Path(__file__).with_name("player.xpm")))
        self.x = self.y = 1
        self.moves = 0
        self.start = time.perf_counter()

    def draw(self, _: object = None) -> None:
        """Draw everything; the corner turns red after a second."""
        self.mlx_put_image_to_window(self.mlx_ptr, self.win_ptr, self.walls, 0, 0)
        self.mlx_put_image_to_window(self.mlx_ptr, self.win_ptr, self.player, self.x * CELL, self.y * CELL)
        self.mlx_string_put(
            self.mlx_ptr, self.win_ptr, 5, 0, 0x00FFFF, f"moves {self.moves}"
        )  # yellow: red and blue are swapped
        if time.perf_counter() - self.start > 1:
            self.mlx_pixel_put(self.mlx_ptr, self.win_ptr, 139, 99, 0xFFFF0000)

    def move(self, key: int, _: object) -> None:
        """Move the player, once for each press that the keyboard reports."""
        print("key", key, flush=True)
        if key == 49:
            raise ValueError("one")
        across, down = KEYS.get(key, (0, 0))
        if MAZE[self.y + down][self.x + across] != "#":
            self.x, self.y = self.x + across, self.y + down
            self.moves += (across, down) != (0, 0)

    def quit(self, key: int, _: object) -> None:
        """Leave with Escape, as programs do that the wrapper does not let use sys.exit."""
        if key == 65307:
            self.mlx_destroy_window(self.mlx_ptr, self.win_ptr)
            os._exit(7)

    def close(self, _: object) -> None:
        """End the loop."""
        print("closed", flush=True)
        self.mlx_destroy_window(self.mlx_ptr, self.win_ptr)
        self.mlx_loop_exit(self.mlx_ptr)


if __name__ == "__main__":
    game = Game(sys.argv[1] if len(sys.argv) > 1 else "maze")
    game.mlx_hook(game.win_ptr, 2, 1, game.move, None)
    game.mlx_key_hook(game.win_ptr, game.quit, None)
    game.mlx_hook(game.win_ptr, 33, 0, game.close, None)
    game.mlx_loop_hook(game.mlx_ptr, game.draw, None)
    game.mlx_loop(game.mlx_ptr)
    print("moves", game.moves, flush=True)
