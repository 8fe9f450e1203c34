"""Print the table of README.md: python -m tests.stability."""

from tests.stability.table import main

main()
