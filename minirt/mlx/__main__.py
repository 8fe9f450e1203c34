"""Run a program that is written for the official Python wrapper of MiniLibX: `python -m minirt.mlx program.py`."""

from minirt.mlx.drop_in.command import main

if __name__ == "__main__":
    raise SystemExit(main())
