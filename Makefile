# make run     sets everything up and shows a scene: make run SCENE=scenes/subject.rt
# make test    sets everything up and runs the tests
# make check   lint and types
# make bench   time of a frame, beside others: make bench BENCH=--quick for a short run
# make report  error against run time of some scenes: make report REPORT=--quick for a short run
# make textures, make gallery   draws the pictures of the scenes, and those of the README's gallery
# make bench-peers   installs what `make bench` compares with and draws by (Debian, Ubuntu)

VENV   := .venv
NAME   := $(VENV)/bin/miniRT
DEV    := $(VENV)/.dev
PYTHON ?= python3
PIP    := $(VENV)/bin/python -m pip --disable-pip-version-check
SCENE  ?= scenes/demo.rt
SUDO   ?= $(if $(filter 0,$(shell id -u)),,sudo)

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
	$(VENV)/bin/python -m tests.bench $(BENCH)

REPORTED := demo figure-v4-everything eval-shadows-many

report: $(NAME)
	$(VENV)/bin/python -m minirt.report out/report/shapes $(REPORT)
	$(foreach scene,$(REPORTED),$(NAME) scenes/$(scene).rt --report out/report/$(scene) $(REPORT) &&) true

textures gallery: $(NAME)
	$(VENV)/bin/python assets/make_$@.py

bench-peers: $(NAME)
	$(SUDO) apt-get install -y --no-install-recommends g++ povray tachyon-bin-nox
	$(PIP) install --quiet --editable '.[report]' embreex

clean:
	find . -name __pycache__ -not -path './$(VENV)/*' -prune -exec rm -rf {} +
	rm -rf out .pytest_cache .mypy_cache .ruff_cache .hypothesis build dist

fclean: clean
	rm -rf $(VENV)

re: fclean
	$(MAKE) all

.PHONY: all bonus run test check bench report textures gallery bench-peers clean fclean re
