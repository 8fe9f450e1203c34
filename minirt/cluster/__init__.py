"""Pictures and films on several processes or machines: bands and frames as tasks of any executor.

A task is pure: it names a scene by its content, and says which rows to render. Whoever makes it, the result has the
same bits.
"""
