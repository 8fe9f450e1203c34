"""Fuzzers of everything that comes from outside: scenes, meshes, pictures, recordings and arguments."""
