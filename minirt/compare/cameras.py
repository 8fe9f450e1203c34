"""Cameras of the table of hypotheses: all that another ray tracer may look through, and how much they differ."""

from __future__ import annotations

from itertools import product

import numpy as np

from minirt.compare.geometry import frame, slopes
from minirt.compare.table import OURS, Guess, values
from minirt.scene import Camera

SCALES = tuple(np.geomspace(0.35, 4.0, 22))
FRAME = "direction", "flipped", "mirrored", "up"
FOVS = values("fov")
TURNED = "roll", "yaw", "pitch"  # by free numbers
CAMERA = *FRAME, "fov", "scale", *TURNED
FEW_VIEWS = 2  # fields of view of cameras whose direction means something else


def cameras(camera: Camera, aspect: float) -> dict[tuple[float, ...], Guess]:
    """Return guesses about the camera by what they draw, simple ones first; of those that draw the same the first."""
    found: dict[tuple[float, ...], Guess] = {}
    views = [(fov, 1.0) for fov in FOVS] + [("horizontal", float(scale)) for scale in SCALES]
    frames = [OURS | dict(zip(FRAME, each, strict=True)) for each in product(*map(values, FRAME))]
    # Of two that draw the same, the mirrored one is likelier.
    for each in sorted(frames, key=lambda each: (differences(each), each["up"] != OURS["up"])):
        for fov, scale in views if each["direction"] == "as given" else views[:FEW_VIEWS]:
            guess = each | {"fov": fov, "scale": scale}
            found.setdefault(drawn_by(camera, aspect, guess), guess)
    return found


def drawn_by(camera: Camera, aspect: float, guess: Guess) -> tuple[float, ...]:
    """Numbers that are equal for guesses whose cameras draw the same."""
    edges = (
        *slopes(camera, aspect, guess),
        float(guess["fov"] == "equal angles"),
        float(guess["direction"] == "position added"),
    )
    return tuple(np.round([*frame(camera, guess).ravel(), *edges], 4) + 0.0)


def differences(guess: Guess) -> int:
    """The number of parameters in which a guess differs from this program; those with a free number count twice, a
    camera that looks another way three times."""
    plain = [guess[name] != value for name, value in OURS.items() if name not in TURNED].count(True)
    costly = [guess["scale"] != 1.0, guess["ambient"] == "light plus object"].count(True)
    turned = 3 if is_aimed(guess) else 0
    if guess["roll"]:
        turned += 1 if is_aimed(guess) else 2
    return plain + costly + turned


def is_aimed(guess: Guess) -> bool:
    """Whether a camera looks another way than the scene says, by free numbers."""
    return bool(guess["yaw"] or guess["pitch"])
