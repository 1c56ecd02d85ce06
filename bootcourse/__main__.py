"""`python -m bootcourse`: the same as `bootcourse`. The commands are in `cli`."""

import atexit
import gc
import sys

# torch, numba and matplotlib make some 300,000 objects that stay. Python's garbage collector would look at them again
# and again while they load, and twice at the end: together a quarter of a short command's time.
gc.set_threshold(50_000, 20, 20)
atexit.register(gc.freeze)

try:
    from bootcourse.cli import main
except ModuleNotFoundError as error:
    if error.name and error.name.startswith("bootcourse"):
        raise
    from bootcourse import doctor  # a package is missing: run the doctor, which names it, instead of the command

    sys.exit(doctor.main())

if __name__ == "__main__":
    main()
