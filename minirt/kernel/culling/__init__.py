"""Visibility culling: binning of shapes into screen tiles and light buffers, and lookup in light buffers."""
