"""Print the tables of README.md: python -m tests.stability."""

from tests.stability.table import main

main()
