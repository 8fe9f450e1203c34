"""Print the lowest versions of the dependencies as arguments of pip: python -m tests.lowest_versions"""

from __future__ import annotations

import re
import tomllib

from tests.paths import ROOT


def lowest_versions(*extras: str) -> list[str]:
    """Return requirements such as `numpy==2.0`, one for each dependency of every platform and of some extras."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    required = project["dependencies"] + [each for name in extras for each in project["optional-dependencies"][name]]
    everywhere = [each for each in required if ";" not in each]
    return [re.sub(r"^([\w-]+)>=([\d.]+).*$", r"\1==\2", each) for each in everywhere]


if __name__ == "__main__":
    print(*lowest_versions("video", "report"))
