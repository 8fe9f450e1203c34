"""`python -m minirt` is the program `miniRT`."""

import sys

from minirt.cli import main

sys.exit(main())
