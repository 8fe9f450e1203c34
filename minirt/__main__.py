"""Entry point of the program `miniRT`, which is also `python -m minirt`."""

import sys

from minirt.helpers.signals import handle_from_start

handle_from_start()  # before the imports of the program, which take most of its start

from minirt.cli import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main())
