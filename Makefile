# Each target sets up what it needs in .venv; Python >= 3.10 with pip is all that must be there.
#   make test NUMPY=1.26.4     the tests with that numpy, in a venv of its own
#   make demo PYTHON=python3.12
#   make setup NUMPY=1.26.4 VENV_FLAGS=--system-site-packages     the same venv, seeing ROS's packages

PYTHON ?= python3
NUMPY ?=
VENV_FLAGS ?=
VENV := .venv$(if $(NUMPY),-numpy-$(NUMPY))
BIN := $(VENV)/bin
# The viewer wants numpy 2, so that its tests are skipped with an older one.
comma := ,
TESTED := test$(if $(NUMPY),,$(comma)view)
INSTALL := PYTHONWARNINGS=ignore $(BIN)/python -m pip install --quiet --disable-pip-version-check \
	$(if $(NUMPY),"numpy==$(NUMPY)")

# In processes of their own, and with the clock: other work on the machine disturbs them, so those
# that fail are run once more.
REAL_TIME := -m "slow and not soak" -rs

# Whoever waits longer, in seconds, waits forever: it fails, and shows where.
PYTEST := $(BIN)/python -m pytest --timeout 300

.PHONY: help demo live test soak faults lint docs bench notebooks config setup
.DEFAULT_GOAL := help

help:  ## this index
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/make \1\t\2/p' Makefile | expand -t 14

demo: $(VENV)/.installed  ## simulate a restaurant, replay it, print who raised a hand and where
	$(BIN)/raised-hand demo

live: $(VENV)/.installed-live  ## see yourself on a page in the browser; without a camera: make live SOURCE=--simulated
	$(BIN)/raised-hand live $(SOURCE)

test: $(VENV)/.installed-$(TESTED)  ## run the tests
	@# Compiled once beforehand, for all the processes that follow.
	$(BIN)/python -c 'from tracker.tracking.machine_frame import compile_tracker; compile_tracker(print)'
	$(PYTEST) -n auto --maxprocesses 2 -m "not slow" $(if $(NUMPY),--ignore=tests/notebooks)
ifeq ($(NUMPY),)
	$(PYTEST) $(REAL_TIME) || $(PYTEST) $(REAL_TIME) --last-failed
endif

soak: $(VENV)/.installed-$(TESTED)  ## an hour of simulated time through the node: about eight minutes
	SOAK_MINUTES=60 $(BIN)/python -m pytest -m soak -s

faults: $(VENV)/.installed  ## harm recordings, fill disks, kill writers: is anything else lost?
	$(BIN)/python -m benchmarks.faults

lint: $(VENV)/.installed-lint  ## style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

docs: $(VENV)/.installed-docs  ## build the pages of the documentation into site/
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet

bench:  ## time the product against its peers, some of which want numpy 1
	@$(MAKE) --no-print-directory VENV=.venv-bench .venv-bench/.installed-bench
	@set -e; for file in $(filter-out benchmarks/fit_%,$(wildcard benchmarks/[a-z]*.py)); do echo "$$file"; .venv-bench/bin/python "$$file"; done

notebooks: $(VENV)/.installed-notebooks  ## open the notebooks
	$(BIN)/jupyter lab notebooks

config: $(VENV)/.installed  ## write the parameter file and docs/parameters.md from tracker/config.py
	$(BIN)/python -m tracker.config_file config/hand_detector.yaml docs/parameters.md

setup: $(VENV)/.installed $(VENV)/.installed-$(TESTED) $(VENV)/.installed-lint  ## everything for development

# One stamp file per set of dependencies, so that a repeated call is quick.
$(VENV)/.installed: pyproject.toml setup.py | $(VENV)/.created
	@echo "Installing into $(VENV), which takes a minute or two ..."
	@$(INSTALL) --editable .
	@touch $@

$(VENV)/.installed-%: pyproject.toml setup.py | $(VENV)/.created
	@echo "Installing into $(VENV), with what $* needs; this takes a minute or two ..."
	@$(INSTALL) --editable ".[$*]"
	@touch $@

# Debian's Python comes without ensurepip; the pip beside it (22.3 or later) serves then.
$(VENV)/.created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || \
		{ echo "$(PYTHON) is not Python 3.10 or later; name one: make ... PYTHON=python3.12"; exit 1; }
	@if $(PYTHON) -c 'import ensurepip' 2>/dev/null; then \
		$(PYTHON) -m venv $(VENV_FLAGS) $(VENV); \
	else \
		$(PYTHON) -m venv $(VENV_FLAGS) --without-pip $(VENV) && \
		$(PYTHON) -m pip --python $(BIN)/python install --quiet pip; \
	fi || { echo "No virtual environment can be made; on Debian and Ubuntu:" \
		"sudo apt install python3-venv"; exit 1; }
	@touch $@
