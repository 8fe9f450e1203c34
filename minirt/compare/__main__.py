"""Print the C file that stands for MiniLibX and writes a program's window to a picture.

python -m minirt.compare stub > mlx_stub.c
"""

from __future__ import annotations

import sys

from minirt.helpers import package

USAGE = 2  # exit status


def main(arguments: list[str]) -> int:
    """Print the file; return the exit status."""
    if arguments != ["stub"]:
        print("usage: python -m minirt.compare stub > mlx_stub.c", file=sys.stderr)
        return USAGE
    print(package.read("minirt.compare", "mlx_stub.c").decode(), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
