"""Entry point of `python -m minirt`, which is the program `miniRT`."""

import sys

from minirt.cli import main

sys.exit(main())
