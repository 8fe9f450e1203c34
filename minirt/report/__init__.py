"""Reports of error against run time: `generate` measures a scene and writes its page, `bench` times its frames."""
