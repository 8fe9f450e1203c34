"""The viewer as a program that logs the actions of its key bindings to a file, one per line.

python -m tests.viewer.action_log LAYOUT LOG SCENE...      # one scene after the other
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from minirt.scene import load
from minirt.viewer.app.desktop import run
from minirt.viewer.app.events import EventDispatcher
from minirt.viewer.bindings import Binding
from tests.viewer.fake import FakeRenderer


def main(layout: str, log: str, *scenes: str) -> int:
    """Show the scenes; return the first exit status that is not 0, or 0."""

    def logged(perform: Callable[..., None]) -> Callable[..., None]:
        def perform_and_log(dispatcher: EventDispatcher, binding: Binding, *arguments: float) -> None:
            perform(dispatcher, binding, *arguments)
            with Path(log).open("a") as lines:
                lines.write(f"{binding.action}\n")

        return perform_and_log

    for name in ("perform", "hold"):
        setattr(EventDispatcher, name, logged(getattr(EventDispatcher, name)))
    statuses = (
        run(load(scene).scene, path=scene, size=(320, 240), keys=layout, renderer=FakeRenderer()) for scene in scenes
    )
    return next((status for status in statuses if status), 0)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
