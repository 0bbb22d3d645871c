# The paper, end to end: `make reproduce`. The tests: `make test`. Times: `make benchmark`.
# Needs Python 3.11 or newer, make and a C compiler; everything else goes to .venv.

PYTHON ?= python3
CORES ?= 2
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready

.PHONY: reproduce smoke slurm kernels test quick same-bytes benchmark faults lint format docs lock \
	lowest clean

reproduce: $(READY)
	$(BIN)/snakemake --cores $(CORES)

smoke: $(READY)
	$(BIN)/snakemake everything --cores $(CORES) --configfile config/smoke.yaml

# The smoke run on a Slurm that is set up for it alone; needs root and Slurm's packages.
slurm: $(READY)
	profiles/slurm/try.sh $(abspath $(BIN))/snakemake

# Compiled before the tests, so that their processes load the kernels and do not all compile them.
kernels: $(READY)
	$(BIN)/python -m impact_damper.workflow.compile_kernels '[2, []]'

# On all cores, each file in one process, so that its fixtures are made once; in the order of the
# collection, in which the longest files come first.
# PYTEST= adds arguments, for example PYTEST="-k recurrence --durations=20".
PYTEST ?=
TESTS := $(BIN)/python -m pytest --numprocesses auto --dist loadfile --no-loadscope-reorder
test: kernels
	$(TESTS) $(PYTEST)

# Without the tests marked `workflow` or `thorough`; pyproject.toml says what these are.
quick: kernels
	$(TESTS) -m "not workflow and not thorough" $(PYTEST)

# Two runs, on one core and two, are compared; the whole paper with CONFIG= and nothing after it.
CONFIG ?= config/smoke.yaml
same-bytes: $(READY)
	PYTHONPATH=tests $(BIN)/python -m helpers.same_bytes $(CONFIG)

# Into results/benchmarks/; the tests hold the reference.
benchmark: $(READY)
	PYTHONPATH=tests $(BIN)/python -m benchmarks

# Into results/faults/: what a run makes of kills, damaged files, full disks and the like.
faults: $(READY)
	PYTHONPATH=tests $(BIN)/python -m faults

lint: $(READY)
	$(BIN)/ruff format --check benchmarks docs src tests workflow
	$(BIN)/ruff check benchmarks docs src tests workflow
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint

format: $(READY)
	$(BIN)/ruff check --fix benchmarks docs src tests workflow
	$(BIN)/ruff format benchmarks docs src tests workflow
	$(BIN)/snakefmt Snakefile workflow

# Made anew when the lock or the package's metadata change, and not otherwise.
$(READY): requirements.lock pyproject.toml
	$(PYTHON) -m venv --clear $(VENV)
	$(BIN)/pip install --require-hashes -r requirements.lock
	$(BIN)/pip install --no-deps --no-build-isolation --editable .
	touch $@

# The documentation, into docs/_build/html; runs the tutorials. Shows claims and figures of `results/`.
docs: kernels
	$(BIN)/python -m sphinx --fail-on-warning --keep-going --jobs auto docs docs/_build/html
	$(BIN)/python -m pytest -q tests/docs

# For developers, after a change of the dependencies; needs uv.
lock:
	uv pip compile pyproject.toml --all-extras --group build --universal --python-version 3.11 \
		--generate-hashes --no-emit-index-url --no-header --output-file requirements.lock

# For developers, after a change of the lower bounds in pyproject.toml; needs uv. Installs the oldest
# versions that these bounds allow and runs the tests of the library with them.
LOWEST := .venv-lowest
lowest:
	$(PYTHON) -m venv --clear $(LOWEST)
	uv pip compile pyproject.toml --extra test --resolution lowest-direct --python-version 3.11 \
		--no-header --no-emit-index-url --output-file $(LOWEST)/requirements.txt
	$(LOWEST)/bin/pip install --requirement $(LOWEST)/requirements.txt
	PYTHONPATH=src $(LOWEST)/bin/python -m pytest --numprocesses auto --dist loadfile \
		--ignore tests/workflow $(PYTEST)

clean:
	rm -rf results-smoke .snakemake
	find results -mindepth 1 ! -name README.md -delete
