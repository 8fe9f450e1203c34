"""python -m minirt.report DIR [--quick]: how precise and fast the formulas of all kinds of shapes are."""

from __future__ import annotations

import argparse
import sys

from minirt.errors import RenderError
from minirt.report import report_formulas


def main() -> None:
    """Run it."""
    parser = argparse.ArgumentParser(prog="python -m minirt.report", description="Measure the formulas of all shapes.")
    parser.add_argument("folder", metavar="DIR", help="where the tables go")
    parser.add_argument("--quick", action="store_true", help="with fewer rays")
    asked = parser.parse_args()
    try:
        report_formulas(asked.folder, asked.quick)
    except RenderError as error:
        sys.exit(f"Error\n{error}")
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
