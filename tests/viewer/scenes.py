"""Scenes of the tests in real windows."""

SPHERE_ON_PLANE = """\
A 0.2 255,255,255
C 0,1,8 0,-0.1,-0.995 60
L 5,5,5 0.6 255,255,255
sp 0,0,0 2 255,60,60
pl 0,-1,0 0,1,0 90,200,90
"""
WITH_CYLINDER = SPHERE_ON_PLANE + "cy 2,0,0 0,1,0 1 2 60,60,255\n"
