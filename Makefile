# `make help` lists the targets with the comments behind them.

VENV    := .venv
NAME    := $(VENV)/bin/miniRT
DEV     := $(VENV)/.dev
KERNELS := $(VENV)/.kernels
PYTHON  ?= python3
PIP     := $(VENV)/bin/python -m pip --disable-pip-version-check
WORKERS ?= auto
PYTEST  := $(VENV)/bin/python -m pytest --numprocesses $(WORKERS)
SCENE   ?= scenes/opening.rt
SUDO    ?= $(if $(filter 0,$(shell id -u)),,sudo)

# Else each process of the tests would compile all of them, and each program what it imports.
unexport PYTHONDONTWRITEBYTECODE

# The program is installed in editable mode, so only a change of its dependencies installs it again. The path to the
# sources is relative: Python reads it in the encoding of the locale, and an absolute one with an umlaut would keep Python
# from starting under LC_ALL=C.
UP       = $(shell echo $(VENV)/ | sed 's|[^/]*/|../|g')
INSTALL  = $(PIP) install --quiet --no-build-isolation --editable $(1) && \
           for file in $(VENV)/lib/python*/site-packages/*minirt*.pth; do echo $(UP)../../.. >"$$file"; done

all: $(NAME) $(KERNELS)  ## install the program as .venv/bin/miniRT, and compile its kernels for this machine

help:  ## list the targets
	@awk -F ':.*## ' '/^[a-z].*:.*## / { printf "make %-17s %s\n", $$1, $$2 }' Makefile

$(NAME): pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "miniRT needs Python 3.11 or newer: make PYTHON=python3.12")'
	$(PYTHON) -m venv $(VENV)
	$(PIP) install --quiet --upgrade 'pip>=25.1' hatchling editables  # what builds the project
	$(call INSTALL,.)
	$(VENV)/bin/python -m compileall -q minirt  # also for users who cannot write there
	$(MAKE) --no-print-directory -j2 further-packages $(FIRST)
	touch $@

.DELETE_ON_ERROR:

FIRST   := first-kernels
FURTHER := '.[report,panel]'

further-packages:
	$(call INSTALL,$(FURTHER))

# They draw the first picture of any scene at once. Where a change of the sources makes them useless, a program compiles
# what its scene needs, in seconds: so `make run` does not wait for them.
first-kernels:
	-$(VENV)/bin/python -m minirt.rendering.ahead_of_time first

$(KERNELS): $(NAME) $(shell find minirt -name '*.py')
	$(VENV)/bin/python -m minirt.rendering.ahead_of_time
	touch $@

bonus: all  ## the same: what the subject calls the bonus is part of the program

$(DEV): $(NAME) pyproject.toml
	$(PIP) install --quiet --group dev
	touch $@

# Without a display the picture is written to a file.
run: $(NAME)  ## show a scene: make run SCENE=scenes/subject.rt
	@mkdir -p out
	$(NAME) $(SCENE) --fallback out/$(basename $(notdir $(SCENE))).png

# On x86-64 Linux it has kernels for all such machines with AVX2, elsewhere none.
wheel: $(NAME)  ## build a wheel in dist, with the kernels that draw every scene at once
	$(VENV)/bin/python -m minirt.rendering.ahead_of_time wheel
	$(PIP) wheel --quiet --no-build-isolation --no-deps --wheel-dir dist .

# Tests that run few kernels, which are compiled when they ask for them, and no generic ones.
LIGHT := $(addprefix tests/,$(addsuffix %,formats helpers lanes materials meshes newcomer oracle scene shapes viewer/editing) \
         $(addprefix stability/test_,$(addsuffix .py,certificates edges exact starts)))

# Run all tests, or some: make test TESTS=tests/shapes; MINIRT_SEED=1 replays random ones.
test: $(DEV) $(if $(TESTS),$(if $(filter-out $(LIGHT),$(TESTS)),$(KERNELS)),$(KERNELS))  ## run all tests, or TESTS=FOLDER
	$(PYTEST) --durations=15 $(TESTS)

QUICK := not window and not slow

quick: $(DEV)  ## run the tests that take a minute in all
	$(PYTEST) -m "$(QUICK)" $(TESTS)

pythons: $(NAME)  ## run quick tests, a film, a window and a notebook with each other Python of this machine, in new environments
	$(VENV)/bin/python -m tests.pythons

newest: $(NAME)  ## run what may depend on the version of Python, with the newest of them alone
	$(VENV)/bin/python -m tests.pythons newest

FORMULAS := tests/lanes tests/kernel/test_features.py tests/kernel/test_frame.py tests/shapes/test_protocol.py \
            tests/shapes/test_known_answers.py tests/shapes/test_torus.py tests/shapes/test_triangle.py
# Formulas of single numbers, of numpy's arrays and of the interpreter are the same on each processor, and so are the
# distance of single precision from double and the hulls of shapes. One test asks about another processor itself.
COMPILED := $(FORMULAS) -k "not numbers] and not arrays] and not interpreted- and not random_scenes \
                            and not packet and not hull and not without_avx"

OWN = $(shell $(VENV)/bin/python -c 'from minirt.kernel.machine_code.fingerprint import level; print(level())')

# `make test` runs them as on the processor of this machine.
processors: $(DEV)  ## run the tests of compiled formulas as on processors without AVX-512 and without AVX
	$(foreach name,$(filter-out $(OWN),x86-64-v3 generic),NUMBA_CPU_NAME=$(name) NUMBA_CPU_FEATURES= $(PYTEST) $(COMPILED) &&) true

LOWEST := $(VENV)/lowest

# With kernels of its own, which the lowest version of numba compiles.
lowest:  ## run a short part of the tests with the lowest versions of the dependencies
	$(PYTHON) -m venv $(LOWEST)
	$(LOWEST)/bin/python -m pip --disable-pip-version-check install --quiet pytest pytest-xdist hypothesis mpmath gmpy2 \
	    $$($(PYTHON) -m tests.pythons lowest)
	mkdir -p $(LOWEST)/cache
	MINIRT_REQUIRE_WINDOW= XDG_CACHE_HOME=$(abspath $(LOWEST)/cache) $(LOWEST)/bin/python -m pytest --numprocesses $(WORKERS) \
	    -m "not window" tests/materials tests/formats tests/kernel/test_compiler.py tests/mlx

check: $(DEV)  ## lint, check types, and compare lines with the budget
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/mypy
	$(VENV)/bin/python -m tests.typed.snippets out/snippets
	$(VENV)/bin/mypy --strict tests/typed/every_name.py out/snippets/*.py
	$(VENV)/bin/python -m tests.budget

types: $(DEV)  ## check the types of the public names with pyright, too, which needs Node.js
	$(PIP) install --quiet pyright
	$(VENV)/bin/python -m tests.typed.snippets out/snippets
	$(VENV)/bin/pyright --pythonpath $(VENV)/bin/python tests/typed/every_name.py out/snippets/*.py

SECONDS ?= 60
MINUTES ?= 60
SEED    ?= 1

fuzz: $(DEV) $(KERNELS)  ## try damaged and extreme input: make fuzz SECONDS=3600 SEED=7
	$(VENV)/bin/python -m tests.fuzz $(SECONDS) $(SEED)

soak: $(DEV) $(KERNELS)  ## render, and use a window, at random for long: make soak MINUTES=60
	$(VENV)/bin/python -m tests.fuzz.soak $(MINUTES) $(SEED)
	$(VENV)/bin/python -m tests.viewer.monkey $(MINUTES) $(SEED)

bench: $(DEV)  ## time frames beside other programs: make bench BENCH=--quick for a short run
	$(VENV)/bin/python -m tests.bench $(BENCH)

bench-peers: $(NAME)  ## install what `make bench` compares with (Debian, Ubuntu)
	$(SUDO) apt-get install -y --no-install-recommends g++ llvm povray tachyon-bin-nox xvfb
	$(PIP) install --quiet embreex mitsuba

REPORTED := demo figure-v4-everything eval-shadows-many

report: $(NAME)  ## measure error against run time: make report REPORT=--quick for a short run
	$(foreach scene,$(REPORTED),$(NAME) scenes/$(scene).rt --report out/report/$(scene) $(REPORT) &&) true

textures gallery: $(NAME)  ## draw the textures of the scenes, or render the gallery
	$(VENV)/bin/python assets/make_$@.py

diagrams: $(NAME)  ## measure the diagrams of the pages anew: error against run time
	$(VENV)/bin/python assets/make_diagrams.py

clean:  ## remove what tests, tools and runs have left
	find . -name __pycache__ -not -path './$(VENV)/*' -prune -exec rm -rf {} +
	rm -rf out .pytest_cache .mypy_cache .ruff_cache .hypothesis build dist

fclean: clean  ## remove the installed program, too
	rm -rf $(VENV) minirt/kernel/ahead_of_time

docs: $(DEV)  ## build pages on the public names in out/docs, with pdoc
	$(PIP) install --quiet pdoc
	$(VENV)/bin/python -m pdoc --output-directory out/docs minirt minirt.Scene

re: fclean  ## install everything anew
	$(MAKE) all

.PHONY: all help further-packages first-kernels bonus run wheel test quick pythons newest processors lowest check fuzz soak types docs bench bench-peers report textures gallery diagrams clean fclean re
