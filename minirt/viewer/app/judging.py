"""Judge pictures: say what a picture does not show, and what to do, once it is there."""

from __future__ import annotations

from minirt.scene import Scene
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import platform_spelling as named

NO_SHAPES = "the scene has no shapes; the grid marks the ground y = 0, and is on no picture"
MOST_SHAPES = 200  # of a scene that is judged after edits, which takes some hundredths of a second


class PictureJudge:
    """Judges the first picture of each file, and the final one after each edit, of a session."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._scene: Scene | None = None  # the last one whose picture was judged
        self._saved: Scene | None = None  # what the file held then
        self._told = set[str]()  # what was noticed about it

    def judge(self) -> None:
        """Show the first notice about the latest picture that was none about the picture judged before.

        Previews and pictures of the scene that was judged last are passed over. So is a picture after an edit, while
        something else goes on or if the scene has more than MOST_SHAPES.
        """
        session = self.session
        latest = session.refinement.latest
        if latest is None or latest.preview or latest.pixels is None:
            return
        if latest.job.scene is self._scene:
            return
        scene, is_first = latest.job.scene, self._saved is not session.saved
        if is_first and scene is not session.saved and scene is not session.opened:  # still the file before
            return
        is_busy = session.pressed or session.screen.list_box or not session.refinement.complete
        if not is_first and (is_busy or sum(map(len, scene.runs)) > MOST_SHAPES):
            return
        from minirt.rendering.notices import notices_about
        from minirt.rendering.queries.unseen import SHOWN_BY

        height, width = latest.pixels.shape[:2]
        notices = notices_about(scene, latest.pixels[..., :3], (width, height)) if scene.runs else iter([NO_SHAPES])
        parts = [notice.partition(SHOWN_BY) for notice in notices]
        reasons = [(reason, bool(separator)) for reason, separator, _ in parts]  # with whether F helps
        told = set[str]() if is_first else self._told
        self._scene, self._saved, self._told = scene, session.saved, {reason for reason, _ in reasons}
        before = f"{session.state.message}\n" if session.state.message else ""
        for reason, can_be_shown in reasons:
            if reason not in told:
                session.say(before + reason + (f"; {named('F')} brings the scene into view" if can_be_shown else ""))
                session.refresh()
                return
