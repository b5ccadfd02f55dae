# Two commands do everything on a fresh machine: `make demo` and `make test`.
.PHONY: demo test same docs docs-links clean

VENV := .venv
BIN := $(VENV)/bin
# Python compiles a module when it is first used; compiling all of all packages takes as long as getting them does.
INSTALL = $(BIN)/pip install --quiet --disable-pip-version-check --no-compile --editable
SUPPORTED := import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))
PYTHON ?= $(shell for p in python3 python3.13 python3.12 python3.11; do \
	$$p -c '$(SUPPORTED)' 2>/dev/null && { echo $$p; break; }; done)

demo: $(VENV)/installed
	$(BIN)/cargolab run tilting/quick

# Tests start Python often, which takes far longer where bytecode is not kept.
unexport PYTHONDONTWRITEBYTECODE

test: $(VENV)/installed-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/python -m pytest

# Whether the numbers are still those of another revision, bit for bit: make same BASE=main
BASE ?= HEAD
same: $(VENV)/installed-test
	$(BIN)/python -m tests.same $(BASE) $(SCENES)

# The manual: open docs/_build/html/index.html. Any warning ends it; `make test` builds it, too, where Sphinx is installed.
docs: $(VENV)/installed-docs
	$(BIN)/sphinx-build --fail-on-warning --keep-going --quiet --builder html docs docs/_build/html

# Whether the addresses that the manual names elsewhere are there; this one asks the network
docs-links: $(VENV)/installed-docs
	$(BIN)/sphinx-build --quiet --builder linkcheck docs docs/_build/links

$(VENV)/bin/pip:
	@test -n "$(PYTHON)" || { echo "Python 3.11, 3.12 or 3.13 is needed (Taichi has no wheels for others): install one, or name it: make demo PYTHON=/path/to/python3.12"; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); echo "Python cannot make a virtual environment: sudo apt install python3-venv"; exit 1; }

$(VENV)/installed: pyproject.toml | $(VENV)/bin/pip
	$(INSTALL) .
	@touch $@

$(VENV)/installed-test: pyproject.toml | $(VENV)/bin/pip
	$(INSTALL) '.[test]'
	@touch $@ $(VENV)/installed

$(VENV)/installed-docs: pyproject.toml | $(VENV)/bin/pip
	$(INSTALL) '.[docs]'
	@touch $@ $(VENV)/installed

clean:
	rm -rf $(VENV) docs/_build
