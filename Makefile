# make demo    convert a sample clip and put source and result side by side
# make test    run every test          make lint    ruff, mypy, and tsc for the editor's page
# make clean   remove what these made
# make cuda-check  what can be known of CUDA without a card (needs g++; takes some minutes)
# make cuda-kernels  its first part: every kernel compiles for cards (no g++; 80 s on two cores)
#
# Needs only Python 3.11 or newer and make; everything is installed into .venv.

PYTHON ?= python3
DEMO_CLIP ?= sample_videos/bigbuckbunny.mp4

VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check
DEMO_VIDEO := demo/$(basename $(notdir $(DEMO_CLIP))).mp4
DEMO_SHEET := $(basename $(DEMO_VIDEO))_sheet.png
TSC := $(VENV)/typescript/node_modules/typescript/bin/tsc
SOURCES := $(shell find warp_kernels stages pipeline -name '*.py' -o -name '*.toml')

CARD_TESTS := tests tests/card_emulated.py

.PHONY: demo test lint cuda-kernels cuda-check clean
.DELETE_ON_ERROR:

demo: $(DEMO_SHEET)
	@echo "video:         $(DEMO_VIDEO)"
	@echo "contact sheet: $(DEMO_SHEET)"

# Tests start hundreds of processes: each would compile all modules if byte code were not kept.
test cuda-kernels cuda-check: export PYTHONDONTWRITEBYTECODE :=

test: $(VENV)/.installed-dev
	@$(BIN)/python -m pytest --numprocesses=logical --maxprocesses=4 --dist=worksteal

lint: $(VENV)/.installed-dev $(TSC)
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/mypy
	@$(BIN)/mypy --strict --follow-imports=silent tests/client_of_trimotion.py
	@$(BIN)/node $(TSC) --project pipeline/editor/page/jsconfig.json

cuda-kernels: $(VENV)/.installed-dev
	@$(BIN)/python -m benchmarks.card_compile

cuda-check: cuda-kernels
	@$(BIN)/python -m pytest --emulated $(CARD_TESTS) \
		--numprocesses=logical --maxprocesses=4 --dist=worksteal

clean:
	@rm -rf $(VENV) demo out build *.egg-info .pytest_cache .ruff_cache .mypy_cache .hypothesis
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(DEMO_VIDEO): $(DEMO_CLIP) $(SOURCES) $(VENV)/.installed
	@mkdir -p $(@D)
	@$(BIN)/trimotion animate $(DEMO_CLIP) -o $@ --overwrite

$(DEMO_SHEET): $(DEMO_VIDEO) benchmarks/contact_sheet.py
	@$(BIN)/python benchmarks/contact_sheet.py $(DEMO_CLIP) $(DEMO_VIDEO) -o $@

# A change of pyproject.toml makes the stamps stale: the installation is then repeated.
$(VENV)/.installed: pyproject.toml $(VENV)/.created
	@echo "installing trimotion into $(VENV)"
	@$(PIP) install --editable .
	@touch $@

$(VENV)/.installed-dev: pyproject.toml $(VENV)/.installed
	@echo "installing the tools for tests into $(VENV)"
	@$(PIP) install --editable '.[dev]'
	@touch $@

# The types of the editor's page are checked by TypeScript, which PyPI does not have; Node it has.
$(TSC): $(VENV)/.installed-dev
	@echo "installing TypeScript into $(VENV)"
	@$(BIN)/npm install --silent --no-audit --no-fund --prefix $(VENV)/typescript typescript@5.9
	@touch $@

$(VENV)/.created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
		echo "trimotion needs Python 3.11 or newer, and $(PYTHON) is" \
			"$$({ $(PYTHON) --version 2>&1 || echo missing; } | tail -n 1);" \
			"try: make $(MAKECMDGOALS) PYTHON=python3.12" >&2; exit 1; }
	@$(PYTHON) -m venv --clear $(VENV)
	@touch $@
