"""The rendering kernel: culling, BVH, ray tracing and shading, in plain functions that `kernel.compiler` compiles."""
