"""`python -m tests.hostile`: every hostile test, some minutes."""

import sys

from tests.hostile import damage, kills, payloads

sys.exit(max(part.main() for part in (damage, payloads, kills)))
