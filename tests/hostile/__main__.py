"""`python -m tests.hostile`: every hostile test, some minutes."""

import sys

from tests.hostile import kills

sys.exit(max(part.main() for part in (kills,)))
