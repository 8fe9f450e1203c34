"""Table of all fuzzers, by name."""

from __future__ import annotations

from tests.fuzz import arguments, extremes, meshes, pictures, replays, scenes

FUZZERS = {
    "scenes": scenes.FUZZER,
    "meshes": meshes.FUZZER,
    "pictures": pictures.FUZZER,
    "replays": replays.FUZZER,
    "arguments": arguments.FUZZER,
    "extremes": extremes.FUZZER,
}
