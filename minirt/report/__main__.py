"""`python -m minirt.report DIR [--quick]`: measure the accuracy and cost of the formulas of all shape types."""

from __future__ import annotations

import argparse
import sys

from minirt.errors import RenderError
from minirt.report import report_formulas


def main() -> None:
    """Parse the arguments and write the tables."""
    parser = argparse.ArgumentParser(prog="python -m minirt.report", description="Measure the formulas of all shapes.")
    parser.add_argument("folder", metavar="DIR", help="folder to write the tables into")
    parser.add_argument("--quick", action="store_true", help="use fewer rays")
    arguments = parser.parse_args()
    try:
        report_formulas(arguments.folder, arguments.quick)
    except RenderError as error:
        sys.exit(f"Error\n{error}")
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
