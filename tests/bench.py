"""How fast the road and the learner are, as ratios from one run on one thread: `make bench`.

`python -m tests.bench road` and `python -m tests.bench learn` measure one of the two. Exit status 1 says that a ratio
is not within its limit.
"""

import importlib
import sys


def main() -> int:
    import torch

    torch.set_num_threads(1)
    missed = 0
    for name in sys.argv[1:] or ("road", "learn"):
        for row in importlib.import_module(f"tests.bench_{name}").table():
            missed += row.missed
            print(row, flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
