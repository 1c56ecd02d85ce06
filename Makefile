# make lab    JupyterLab on the first lesson      (NO_BROWSER=1 make lab: only print its address)
# make drive  one page on which you drive the trap, beside agents; it needs no server and no network
# make check  in less than a minute: the road, the learner, the rule, what is recorded, and one lesson
# make test   every test, the notebooks included: 6 to 15 minutes on two cores
# make bench  how fast the road and the learner are, as ratios
# make book   the lessons as pages that need no server, in build/book/html  (EDITION=instructor: with solutions)
# make notebooks  execute the lessons' texts again and write the notebooks
# make solved     the notebooks with the solutions, and the instructor's pages, in notebooks/solved and notebooks/instructor
# make doctor what is right and wrong with this machine
# make types  the types of the road, the rule and the learners (mypy)
# make lock   resolve environment.lock and student.lock again
# make clean  remove .venv and the caches
#
# PYTHON=python3.12 make lab   uses another Python, 3.11 or newer

PYTHON ?= python3

BIN := .venv/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check
# Folders that JupyterLab's list of files leaves out: what is not for who begins.
HIDDEN := instructor solved __pycache__ ruff.toml
NOTEBOOKS := $(sort $(wildcard notebooks/*.ipynb))

# So that a notebook finds this `bootcourse` and this `python`.
WITH_PATH := PATH="$(CURDIR)/$(BIN):$$PATH"

.PHONY: help lab drive check test bench book notebooks solved doctor types lock clean

help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' Makefile

lab: .venv/installed
	@$(WITH_PATH) $(BIN)/jupyter-lab --ServerApp.ip=127.0.0.1 --ServerApp.root_dir="$(CURDIR)/notebooks" \
		$(addprefix --ContentsManager.hide_globs=,$(HIDDEN)) \
		--LabApp.default_url=/lab/tree/$(notdir $(firstword $(NOTEBOOKS))) --log-level=WARN \
		$(if $(NO_BROWSER),--no-browser) $(if $(filter 0,$(shell id -u)),--allow-root)

drive: .venv/installed
	@mkdir -p build
	@$(BIN)/python -m bootcourse.web.build --out build/trap.html
	@$(if $(NO_BROWSER),,$(BIN)/python -m webbrowser "file://$(CURDIR)/build/trap.html" > /dev/null)

# tests/check.txt and tests/all.txt hold what pytest is given: the long files first, and each stays in one process
# (tests/conftest.py puts some together).
# One thread each, or two workers with two torches fight over the cores. Each process may keep what it has compiled, also
# where the environment says otherwise: there are some hundred, and each would compile the project again.
TESTING := $(WITH_PATH) OMP_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest

check: .venv/installed
	@$(TESTING) @tests/check.txt $(PYTEST)

test: .venv/installed
	@$(TESTING) @tests/all.txt $(PYTEST)

bench: .venv/installed
	@OMP_NUM_THREADS=1 $(BIN)/python -m tests.bench

notebooks: .venv/installed
	@$(WITH_PATH) $(BIN)/python tools/notebooks.py

solved: .venv/installed
	@$(BIN)/python tools/notebooks.py --solved

book: .venv/installed
	@$(BIN)/python tools/book.py $(EDITION)

doctor: .venv/installed
	@$(BIN)/bootcourse doctor

types: .venv/installed
	@$(PIP) install --quiet mypy==2.4.1
	@$(BIN)/python -m mypy

lock: .venv/installed
	@$(PIP) install --quiet uv
	@$(BIN)/python tools/lock.py

clean:
	rm -rf .venv .pytest_cache .ruff_cache build *.egg-info
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

.venv/installed: environment.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
		|| { echo "bootcourse needs Python 3.11 or newer: install it, or name yours, as in PYTHON=python3.11 make lab"; exit 1; }
	@$(PYTHON) -m venv .venv \
		|| { echo "Python cannot make .venv: on Debian or Ubuntu, apt install python3-venv, then run make again"; exit 1; }
	@sh tools/install.sh $(BIN)/python
	@touch $@
