"""Renders scenes to pixels: packing, culling, sampling and threads.

Knows no window and no file; imports the compiler only when the first picture is made.
"""
