"""`python -m bootcourse`: the same as `bootcourse`. The commands are in `cli`."""

import sys

try:
    from bootcourse.cli import main
except ModuleNotFoundError as error:
    if error.name and error.name.startswith("bootcourse"):
        raise
    from bootcourse import doctor  # a package is missing: run the doctor, which names it, instead of the command

    sys.exit(doctor.main())

if __name__ == "__main__":
    main()
