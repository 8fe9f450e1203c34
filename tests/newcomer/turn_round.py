"""A made-up key for `minirt/viewer/editing/editor.py`: the camera looks the other way."""

from __future__ import annotations

from minirt.viewer.editing import motion
from minirt.viewer.editing.state import State


# What goes into minirt/viewer/editing/editor.py.
def turn_round(state: State, _amount: float, now: float) -> State:
    """Turn the camera by half a turn about the vertical: it looks the other way."""
    return state.edit_camera(motion.turn_camera(state.scene.camera, 180.0, 0.0), "turn round", now)
