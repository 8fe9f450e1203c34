"""Commands that look into a picture: explain a pixel, and show normals, depth or shapes in place of colours."""

from __future__ import annotations

from minirt.mlx import Button
from minirt.viewer.app.session import Session
from minirt.viewer.display.explained import explained
from minirt.viewer.display.lists import WHEEL, layout_of
from minirt.viewer.display.views import next_view

LOOKS = {"": "colours", "normals": "normals", "depth": "depth", "ids": "a colour for each shape"}  # names of views


def explain_pixel(session: Session) -> None:
    """Show the rays of the pixel under the pointer, or hide them if they are shown already. RenderError."""
    screen, scene = session.screen, session.shown_scene
    x, y = session.pointer
    before = screen.explained
    is_same_pixel = before is not None and (before.explanation.x, before.explanation.y) == (x, y)
    if before and before.scene is scene and is_same_pixel:
        screen.explained = None
        return
    from minirt.rendering.queries.explain import explained_by

    renderer = session.refinement.painter.renderer
    renderer.cancel()  # the picture that is being made
    explanation = explained_by(renderer, scene, *screen.size, x, y)
    screen.explained = explained(explanation, scene)
    session.say(screen.explained.parts[0].details)  # of the ray from the eye


def choose_row(session: Session, button: int, x: int, y: int) -> bool:
    """Choose the row at a pixel of the list of rays, or by the wheel there the next one, and show its numbers.

    Returns False for other buttons, beside the list, and where the list is not shown.
    """
    screen, shown = session.screen, session.screen.explained
    is_covered = screen.list_box or screen.help or not screen.level
    if not shown or is_covered or button not in (Button.LEFT, *WHEEL):
        return False
    row = layout_of(shown.box(screen.scale), *screen.size, screen.text_size).row_at(x, y)
    if row is None:
        return False
    row = min(max(shown.chosen + WHEEL[button], 0), len(shown.parts) - 1) if button in WHEEL else row
    screen.explained = shown._replace(chosen=row)
    session.say(shown.parts[row].details)
    session.show(session.state)
    return True


def show_next_view(session: Session) -> None:
    """Show the next view of the scene: normals, depth, shapes, and colours again."""
    view = next_view(session.refinement.view)
    session.refinement.show_view(view)
    session.say(f"view: {LOOKS[view]}")
