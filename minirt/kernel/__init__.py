"""What runs for every pixel: plain functions, written once, that `minirt.kernel.compiler.jit` compiles."""
