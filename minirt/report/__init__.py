"""Reports of error against run time: `measure` measures a scene and writes its page, `bench` times its frames."""
