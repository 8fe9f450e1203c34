"""Shading: materials, textures, lights, shadows, reflection, refraction and the environment."""
