"""The back end on a real screen, by pyglet. Importing any of its modules opens the display."""
