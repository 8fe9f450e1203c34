"""The desktop viewer: a window in which keys and mouse move, turn and resize the elements of a scene.

Importing its modules loads neither the window library nor the compiler.
"""
