"""Helpers of all parts: files, the process and its memory, progress, signals."""
