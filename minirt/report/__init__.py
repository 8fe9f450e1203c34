"""Report of error against run time, for the formulas of shapes and for the pictures of a scene.

`measurements` measures, `output` turns figures into text, tables and pictures, `generate` does both for a scene.
"""

from minirt.report.generate import report, report_formulas

__all__ = ["report", "report_formulas"]
