"""Machine code of kernels: find it, load it and call it, without the compiler."""
