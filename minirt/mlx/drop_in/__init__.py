"""Run unchanged programs that say `from mlx import Mlx`, in a window or without a screen."""
