"""Recovery: unsaved changes outlive a killed program, and are offered when the scene is opened again."""
