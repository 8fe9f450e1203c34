# make run     sets everything up and shows a scene: make run SCENE=scenes/subject.rt
# make test    sets everything up and runs the tests
# make check   lint and types     make bench    time of a frame

VENV   := .venv
NAME   := $(VENV)/bin/miniRT
DEV    := $(VENV)/.dev
PYTHON ?= python3
PIP    := $(VENV)/bin/python -m pip --disable-pip-version-check
SCENE  ?= scenes/demo.rt
BENCH  ?= tests/bench/one.rt tests/bench/fifty.rt scenes/demo.rt
SIZE   ?= 1280x720

all: $(NAME)

# The program is installed so that it runs the sources as they stand: only a change of its dependencies installs again.
$(NAME): pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "miniRT needs Python 3.11 or newer: make PYTHON=python3.12")'
	$(PYTHON) -m venv $(VENV)
	$(PIP) install --quiet --upgrade 'pip>=25.1'
	$(PIP) install --quiet --editable .
	touch $@

# What the subject calls the bonus is part of the program.
bonus: all

$(DEV): $(NAME) pyproject.toml
	$(PIP) install --quiet --group dev
	touch $@

# Without a display the picture goes to a file.
run: $(NAME)
	@mkdir -p out
	$(NAME) $(SCENE) --fallback out/$(basename $(notdir $(SCENE))).png

test: $(DEV)
	$(VENV)/bin/python -m pytest $(TESTS)

check: $(DEV)
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/mypy

bench: $(NAME)
	@for scene in $(BENCH); do $(NAME) $$scene --bench --size $(SIZE) 2>/dev/null || exit 1; done

clean:
	find . -name __pycache__ -not -path './$(VENV)/*' -prune -exec rm -rf {} +
	rm -rf out .pytest_cache .mypy_cache .ruff_cache .hypothesis build dist

fclean: clean
	rm -rf $(VENV)

re: fclean
	$(MAKE) all

.PHONY: all bonus run test check bench clean fclean re
