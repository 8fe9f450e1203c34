"""The viewer in notebooks: a widget that shows the pictures of a session and sends keys and mouse back.

`view` chooses between the widget and a window. The widget needs anywidget, which the extra `minirt[notebook]` installs.
"""

from minirt.notebook.choice import view

__all__ = ["view"]
