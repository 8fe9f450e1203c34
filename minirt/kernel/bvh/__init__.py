"""Bounding volume hierarchy: its construction on the host, its traversal, and ray queries through it."""
