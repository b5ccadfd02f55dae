# Two commands do everything on a fresh machine: `make demo` and `make test`.
.PHONY: demo test same docs docs-links notebooks wheel try-wheel clean

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

# Run the notebooks of the manual and keep their outputs: some ten minutes. make notebooks NAMES="hopper own_law" runs these
notebooks: $(VENV)/installed-notebooks
	$(BIN)/python docs/notebooks/execute.py $(NAMES)

# What a release hands out, in dist/: the wheel and the source's archive, checked
wheel: $(VENV)/installed-release
	rm -rf dist
	$(BIN)/python -m build --outdir dist .
	$(BIN)/twine check --strict dist/*.whl dist/*.tar.gz
	$(BIN)/check-wheel-contents dist/*.whl

# The wheel in an environment of its own, outside of the source: make try-wheel PYTHON=python3.12
TRY = dist/try-$(shell $(PYTHON) -c 'import sys; print("%d.%d" % sys.version_info[:2])')
try-wheel:
	@test -n "$$(ls dist/*.whl 2>/dev/null)" || { echo "There is no wheel in dist/: make wheel"; exit 1; }
	rm -rf $(TRY) && $(PYTHON) -m venv $(TRY)
	$(TRY)/bin/pip install --quiet --disable-pip-version-check dist/*.whl
	cd $(TRY) && bin/cargolab doctor && bin/cargolab list && bin/cargolab run tilting/quick
	cd $(TRY) && bin/cargolab export renders/tilting/quick --to csv

# Without a Python that Taichi has wheels for, uv gets one, if it is there.
NEEDED := Python 3.11, 3.12 or 3.13 is needed, since Taichi has no wheels for others
REMEDY := install uv (https://docs.astral.sh/uv), which gets one, or name one: make demo PYTHON=/path/to/python3.12
$(VENV)/bin/pip:
	@if test -n "$(PYTHON)"; then \
		$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); echo "Python cannot make a virtual environment: sudo apt install python3-venv"; exit 1; }; \
	elif command -v uv >/dev/null; then \
		uv venv --quiet --seed --python 3.13 $(VENV) || { rm -rf $(VENV); echo "uv could not get a Python 3.13. $(NEEDED): name one: make demo PYTHON=/path/to/python3.12"; exit 1; }; \
	else echo "$(NEEDED): $(REMEDY)"; exit 1; fi

$(VENV)/installed: pyproject.toml | $(VENV)/bin/pip
	$(INSTALL) .
	@touch $@

$(VENV)/installed-test: pyproject.toml | $(VENV)/bin/pip
	$(INSTALL) '.[test]'
	@touch $@ $(VENV)/installed

$(VENV)/installed-docs: pyproject.toml | $(VENV)/bin/pip
	$(INSTALL) '.[docs]'
	@touch $@ $(VENV)/installed

$(VENV)/installed-release: | $(VENV)/bin/pip
	$(BIN)/pip install --quiet --disable-pip-version-check 'build>=1.2' 'twine>=6' 'check-wheel-contents>=0.6'
	@touch $@

$(VENV)/installed-notebooks: pyproject.toml | $(VENV)/bin/pip
	$(INSTALL) '.[notebooks]'
	@touch $@ $(VENV)/installed

clean:
	rm -rf $(VENV) docs/_build dist
