"""How fast the road and the learner are, as ratios from one run on one thread: `make bench`.

`python -m tests.bench_road` and `python -m tests.bench_learn` measure one of the two. Exit status 1
says that a ratio is under what it should be.
"""

import importlib
import sys


def main() -> int:
    import torch

    torch.set_num_threads(1)
    missed = 0
    print(f"{'':<44} {'':>12} {'':<20} {'ratio':>9} {'wanted':>9}")
    for name in ("tests.bench_road", "tests.bench_learn"):
        for row in importlib.import_module(name).table():
            line = f"{row.name:<44} {row.value:>12,.{0 if row.value >= 100 else 3}f} {row.unit:<20}"
            if row.ratio is not None:
                short = row.ratio < row.target
                missed += short
                line += f" {row.ratio:>8,.1f}x {row.target:>8,.0f}x" + ("  MISSED" if short else "")
            print(line.rstrip(), flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
