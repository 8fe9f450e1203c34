"""Picture formats: which extension is which format, what each can hold, and the writers of those that Pillow lacks."""
