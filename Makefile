# Compute the paper: `make reproduce`. Run the tests: `make test`. Measure times: `make benchmark`.
# Needs Python 3.11 or newer, make and a C compiler. Everything else is installed into .venv.

PYTHON ?= python3
CORES ?= 2
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready
FOR_TESTS := $(VENV)/ready-for-tests
FOR_BENCHMARKS := $(VENV)/ready-for-benchmarks

.PHONY: reproduce smoke slurm kernels test promises quick same-bytes benchmark faults lint format docs lock \
	lowest release citation archive archive-check clean

reproduce: $(READY)
	$(BIN)/snakemake --cores $(CORES)

smoke: $(READY)
	$(BIN)/snakemake everything --cores $(CORES) --configfile config/smoke.yaml

# The smoke run (every stage, with little data) on a Slurm that is set up only for it; needs root
# and the packages of Slurm.
slurm: $(FOR_TESTS)
	profiles/slurm/try.sh $(abspath $(BIN))/snakemake

# Compile the kernels (functions compiled by numba) before the tests, so that the processes of the
# tests load them instead of each compiling them.
kernels: $(READY)
	$(BIN)/python -m chatterjee1995.workflow.kernels '[2, []]'

# On all cores. One process runs all tests of a file, so that the fixtures are made once. The files
# run in the order in which tests/conftest.py puts them, the longest first.
# PYTEST= adds arguments, for example PYTEST="-k recurrence --durations=20".
PYTEST ?=
TESTS := $(BIN)/python -m pytest --numprocesses auto --dist loadfile --no-loadscope-reorder
# Keep bytecode even if the environment forbids it. Otherwise each process would compile the 400
# modules of the package and the tests again.
test quick: export PYTHONDONTWRITEBYTECODE =
test: kernels $(FOR_TESTS)
	$(TESTS) $(PYTEST)

# Search the gaps of four machines, and hold each promise against 400 starts of another program.
promises: kernels $(FOR_TESTS)
	$(TESTS) -m long

# Without the tests marked `workflow`, `thorough` or `long`; pyproject.toml describes these marks.
quick: kernels $(FOR_TESTS)
	$(TESTS) -m "not workflow and not thorough and not long" $(PYTEST)

# Compare the results of two runs, on one core and on two, byte by byte. `make same-bytes CONFIG=`,
# with nothing after the equals sign, compares runs of the whole paper instead of the smoke run.
CONFIG ?= config/smoke.yaml
same-bytes: $(FOR_TESTS)
	PYTHONPATH=tests $(BIN)/python -m helpers.same_bytes $(CONFIG)

# Measure times of the integrator and of other programs, into results/benchmarks/. The reference
# program that measures errors is in tests/references/.
benchmark: $(FOR_BENCHMARKS)
	PYTHONPATH=tests $(BIN)/python -m benchmarks

# Test whether a run recovers from kills, damaged files, full disks and so on.
faults: $(FOR_TESTS)
	PYTHONPATH=tests $(BIN)/python -m faults

lint: $(FOR_TESTS)
	$(BIN)/ruff format --check benchmarks docs src tests workflow
	$(BIN)/ruff check benchmarks docs src tests workflow
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint

format: $(FOR_TESTS)
	$(BIN)/ruff check --fix benchmarks docs src tests workflow
	$(BIN)/ruff format benchmarks docs src tests workflow
	$(BIN)/snakefmt Snakefile workflow

# The environment in .venv, made again only if requirements.lock or pyproject.toml has changed. The
# lock file has three parts: packages for a run, for tests and documentation, and for benchmarks.
$(READY): requirements.lock pyproject.toml
	$(PYTHON) -m venv --clear $(VENV)
	sed '/^# For test/,$$d' requirements.lock > $(VENV)/run.lock
	$(BIN)/pip install --require-hashes -r $(VENV)/run.lock
	$(BIN)/pip install --no-deps --no-build-isolation --editable .
	touch $@

$(FOR_TESTS): $(READY)
	sed '/^# For benchmark/,$$d' requirements.lock > $(VENV)/test.lock
	$(BIN)/pip install --require-hashes -r $(VENV)/test.lock
	touch $@

$(FOR_BENCHMARKS): $(FOR_TESTS)
	$(BIN)/pip install --require-hashes -r requirements.lock
	touch $@

# The documentation, into docs/_build/html. Sphinx runs the tutorials; the pages show claims and
# figures of the last run in results/.
docs: kernels $(FOR_TESTS)
	$(BIN)/python -m sphinx --fail-on-warning --keep-going --jobs auto docs docs/_build/html
	$(BIN)/python -m pytest -q tests/docs

# For developers, after a change of the dependencies; needs uv. All versions are chosen together; the
# shorter lists only tell which packages a run and the tests need.
COMPILE := uv pip compile pyproject.toml --quiet --group build --universal --python-version 3.11 \
	--no-emit-index-url --no-header
LISTS := .lists
lock:
	mkdir -p $(LISTS)
	cp requirements.lock $(LISTS)/all
	$(COMPILE) --all-extras --generate-hashes --output-file $(LISTS)/all
	$(COMPILE) --extra workflow --constraint $(LISTS)/all --output-file $(LISTS)/run
	$(COMPILE) --extra command --extra workflow --extra slurm --extra test --extra docs \
		--constraint $(LISTS)/all --output-file $(LISTS)/test
	cd $(LISTS) && for part in run test benchmark; do \
		echo "# For $$part"; \
		awk -v part=$$part 'FILENAME != "all" { if (!($$1 in of)) of[$$1] = FILENAME; next } \
			/^[a-z]/ { mine = (part == ($$1 in of ? of[$$1] : "benchmark")) } mine' run test all; \
	done > ../requirements.lock
	rm -r $(LISTS)

# For developers, after a change of the lower bounds in pyproject.toml; needs uv. Installs the
# oldest versions that these bounds allow and runs the tests of the library with them.
LOWEST := .venv-lowest
lowest:
	$(PYTHON) -m venv --clear $(LOWEST)
	uv pip compile pyproject.toml --extra command --extra test --resolution lowest-direct \
		--python-version 3.11 --no-header --no-emit-index-url --output-file $(LOWEST)/requirements.txt
	$(LOWEST)/bin/pip install --requirement $(LOWEST)/requirements.txt
	$(LOWEST)/bin/pip install --no-deps --editable .
	PYTHONPATH=src $(LOWEST)/bin/python -m pytest --numprocesses auto --dist loadfile \
		--ignore tests/paper $(PYTEST)

# Build a wheel and an sdist, check them, and run the tests of the library from the sdist, without
# its sources, with the wheel in a new environment. Needs the network.
RELEASE := .venv-release
release:
	rm -rf build dist
	$(PYTHON) -m venv --clear $(RELEASE)
	$(RELEASE)/bin/pip install --quiet build twine
	$(RELEASE)/bin/python -m build
	$(RELEASE)/bin/twine check --strict dist/*
	$(PYTHON) -m venv --clear $(RELEASE)
	$(RELEASE)/bin/pip install --quiet "$$(ls dist/*.whl)[command,test]"
	tar -xzf dist/*.tar.gz -C dist
	cd dist/impact_damper-*/ && rm -r src && $(abspath $(RELEASE))/bin/python -m pytest \
		--numprocesses auto --dist loadfile tests/library tests/literature $(PYTEST)

# CITATION.cff, codemeta.json and workflow/envs/impact-damper.yaml, from pyproject.toml.
citation: $(READY)
	$(BIN)/python workflow/citation.py

# One zip with the results of a run of the paper and all that computed them, as an RO-Crate; the
# check compares all digests and runs one of its jobs again.
ARCHIVE ?= impact-damper.zip
archive: reproduce
	$(BIN)/python workflow/archive.py write $(ARCHIVE)

archive-check: $(READY)
	$(BIN)/python workflow/archive.py check $(ARCHIVE)

clean:
	rm -rf results-smoke .snakemake
	find results -mindepth 1 ! -name README.md -delete
