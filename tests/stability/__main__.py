"""Judge rays at the special places of shapes, in 60 digits: python -m tests.stability --rays 1000000 cone."""

import argparse
import sys

from minirt.shapes import KINDS
from tests.stability.common import MODES
from tests.stability.degenerate import groups, wrong

EACH = 1024  # rays of a shape, whole packets of a kernel
SHOWN = 5  # wrong rays of a kind


def main() -> int:
    """Judge the rays that the command line asks for, and return whether some answers are wrong."""
    titles = [kind.element.title for kind in KINDS]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(titles))
    parser.add_argument("--rays", type=int, default=1_000_000, help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--mode", choices=MODES, default="arrays")
    chosen = parser.parse_args()
    if unknown := set(chosen.kinds) - set(titles):
        parser.error(f"no such kind: {', '.join(unknown)}")
    failed = 0
    for kind in KINDS:
        if kind.element.title in (chosen.kinds or titles):
            shapes = -(-chosen.rays // EACH)
            found = []
            for group in groups(kind, chosen.seed, shapes, EACH):
                found += wrong(MODES[chosen.mode], *group)
            start = sum(each.again for each in found)
            print(f"{kind.element.title}: {shapes * EACH} rays, {len(found)} wrong, {start} of them where a ray starts")
            others = [each for each in found if not each.again]
            for each in (*others[:SHOWN], *[each for each in found if each.again][:SHOWN]):
                print(f"    {each}")
            failed += bool(found)
    return int(failed > 0)


sys.exit(main())
