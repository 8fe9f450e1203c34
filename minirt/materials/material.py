"""Base of materials that have several values: the record behind an attribute such as `glass:1.5,0.9`."""

from __future__ import annotations

from typing import ClassVar

from minirt.element import Record
from minirt.records import record


@record()
class Material(Record):
    """Values of one material, and the feature of the kernel that draws it."""

    feature: ClassVar[str]  # a key of `minirt.rendering.packing.features.FEATURES`

    def has_effect(self) -> bool:
        """Whether the picture shows it: a material without effect costs no feature of the kernel."""
        return True

    def further_features(self) -> tuple[str, ...]:
        """Features of the kernel that these values need beside `feature`."""
        return ()

    def used_feature(self) -> str:
        """The feature that the kernel needs to draw it; empty if it has no effect."""
        return self.feature if self.has_effect() else ""
