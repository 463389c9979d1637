# Every target installs what it needs into .venv; only test-gazebo needs root.
PYTHON ?= python3
BIN := .venv/bin
# pip shows its progress on a terminal; elsewhere a line before each step is enough
PIP := $(BIN)/pip install --disable-pip-version-check $$(test -t 2 || echo --quiet)
GAZEBO_ROOT ?= $(CURDIR)/.venv-gazebo

.PHONY: run live page docs docs-quick test test-all check quick lint types imports tests tests-thorough examples test-learning test-clients test-ros2 test-pythons test-lowest test-distributions release test-gazebo test-targets validate random-missions mutation-check bench compare-engines bench-peers lock clean help

help:            ## list the targets
	@grep -E '^[a-z-]+: .*##' Makefile | sed -E 's/:[^#]*## */\t/' | expand -t 16

run: .venv/run   ## fly the paper's mission and write out/paper
	$(BIN)/tandemlift run paper

live: .venv/run  ## push it by hand, in the browser
	$(BIN)/tandemlift live

test: lint types imports tests   ## lint, types, import directions, and the tests that show that all works here: some ten minutes

test-all: test tests-thorough  ## and those that take long

page: .venv/run web/node_modules/.package-lock.json  ## build the live page from web/, checked and tested (needs Node.js 20)
	$(BIN)/python tools/wire_types.py
	npm --prefix web run --silent check
	npm --prefix web test --silent
	npm --prefix web run --silent build

web/node_modules/.package-lock.json: web/package-lock.json
	@echo 'Installing what the page is built with (once): some 10 s …'
	@npm --prefix web ci --silent
	touch $@

docs: .venv/docs  ## the site, into out/site: runs the tutorials, draws the gallery, checks every link within it
	$(BIN)/sphinx-build -b html -d out/doctrees -W --keep-going -j auto docs out/site
	@echo 'The site: out/site/index.html'

docs-quick: .venv/docs  ## the site without running tutorials, films and gallery, into out/site-quick
	$(BIN)/sphinx-build -b html -t quick -d out/doctrees-quick -W --keep-going -j auto docs out/site-quick
	@echo 'The site: out/site-quick/index.html'

lint: .venv/dev  ## format and lint
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .

types: .venv/dev ## type checker
	$(BIN)/mypy

imports: .venv/dev  ## imports go downward only
	$(BIN)/lint-imports

# a process for each core, whose threads of linear algebra would only wait, and one more: some tests wait for pages;
# bytecode is kept, whatever the shell says: tests start hundreds of processes;
# a file stays in one process, which makes its fixtures once
PYTEST = PYTHONDONTWRITEBYTECODE= OPENBLAS_NUM_THREADS=1 $(BIN)/pytest -n $$(( $$(getconf _NPROCESSORS_ONLN) + 1 )) --dist loadfile --no-loadscope-reorder

tests: .venv/dev ## the first tier of tests
	$(PYTEST) --tier first

tests-thorough: .venv/dev  ## the second: what takes long
	$(PYTEST) --tier thorough

quick: .venv/dev ## files of tests that were quick when they ran last; the first run, or `make tests`, learns which
	OPENBLAS_NUM_THREADS=1 $(BIN)/pytest -n auto -q --quick --dist loadfile --no-loadscope-reorder

check: .venv/dev ## one room: its format, lint, types, and the tests beside it: make check ROOM=parts/guidance
	@test -n "$(ROOM)" -a -d "src/tandemlift/$(ROOM)" || { echo "make check ROOM=$(ROOM): must be a folder below src/tandemlift, such as parts/guidance"; exit 2; }
	$(BIN)/ruff format --check src/tandemlift/$(ROOM)
	$(BIN)/ruff check src/tandemlift/$(ROOM)
	$(BIN)/mypy
	tests=tests/$(ROOM); until test -d $$tests; do tests=$$(dirname $$tests); done; OPENBLAS_NUM_THREADS=1 $(BIN)/pytest -n auto $$tests

examples: .venv/dev  ## run the scripts of examples/, whose numbers are asserted; `make docs` runs the same code
	$(BIN)/pytest -n auto -m examples tests/repository/test_tutorials.py

test-learning: .venv/dev  ## environments by Stable-Baselines3, a policy that learns, gradients by JAX and PyTorch; installs them into .venv-learning
	test -x .venv-learning/bin/python || $(BIN)/python -m venv .venv-learning
	.venv-learning/bin/pip install --disable-pip-version-check --quiet -e '.[gymnasium,jax,torch]' -r tools/dev.txt stable-baselines3
	.venv-learning/bin/pytest -p no:xdist -m learning $$(grep -rl --include='test_*.py' 'mark\.learning' tests)  # others need more packages

test-clients: .venv/dev  ## FMUs in FMPy and fmuloader, Crazyflies by cflib, MAVLink by mavsdk, Betaflight; installs them into .venv-clients
	test -x .venv-clients/bin/python || $(BIN)/python -m venv .venv-clients
	.venv-clients/bin/pip install --disable-pip-version-check --quiet -e '.[fmu,live,mavlink]' -r tools/dev.txt fmpy==0.3.32 fmuloader==0.1.2rc0 cflib==0.1.34 mavsdk==4.1.0
	.venv-clients/bin/pytest -p no:xdist -m clients tests/codegen tests/apps/clients

test-ros2:       ## our nodes beside one of rclpy, of ROS 2 Jazzy and Kilted; installs them into .venv-jazzy and .venv-kilted (Python 3.12)
	tools/test-ros2

test-pythons:    ## the fast tests under each installed Python from 3.11 to 3.13
	tools/test-pythons

test-lowest:     ## each extra at the lowest versions that pyproject.toml allows: what it is for, and its tests
	tools/test-lowest

test-distributions: .venv/dev  ## build the wheel and the source distribution; try them, and each extra, in fresh environments
	tools/test-distributions

release: .venv/dev .venv/docs  ## wheel, sources, site, page, paper, exercises, bill of materials, notes, checksums: tried, into dist/
	tools/release

test-gazebo: .venv/dev  ## flights in a real Gazebo 11, ROS 1, ROS 2's DDS and RViz; installs them, as root
	tools/gazebo-root $(GAZEBO_ROOT)
	tools/test-packages --ros
	TANDEMLIFT_GAZEBO_ROOT=$(GAZEBO_ROOT) TANDEMLIFT_REQUIRE_ALL=1 $(BIN)/pytest -m 'not ros2' tests/gazebo tests/apps/ros

test-targets: .venv/dev  ## every target on every mission: cross compilers, QEMU, sanitizers, Firefox; installs them, as root
	tools/test-packages --targets
	TANDEMLIFT_REQUIRE_ALL=1 $(BIN)/pytest -n 2 -m targets

validate: .venv/dev  ## the pilot's performance beside its targets, printed; 5 minutes. CHAPTER="tracking draws" for some, ENGINE=mujoco
	$(BIN)/python evidence/validate.py $(if $(CHAPTER),--chapter $(CHAPTER)) $(if $(ENGINE),--engine $(ENGINE)) $(if $(DRAWS),--draws $(DRAWS))

random-missions: .venv/dev  ## a thousand missions at random, each outcome confirmed by a judge; into docs/reference/validation.md
	$(BIN)/python evidence/fly_random_missions.py --write

mutation-check: .venv/dev  ## small mistakes in the source, one at a time: does a test notice each? For hours
	$(BIN)/python tools/mutation_check.py

bench: .venv/dev ## speed of everything, printed
	$(BIN)/python benchmarks/bench.py

compare-engines: .venv/dev  ## how closely the engines agree, printed
	$(BIN)/python benchmarks/compare_engines.py

bench-peers: .venv-peers/ready  ## speed beside other simulators, printed
	.venv-peers/bin/python benchmarks/peers.py

.venv-peers/ready: benchmarks/requirements-peers.txt pyproject.toml
	@echo 'Installing other simulators into .venv-peers (once); this may take minutes …'
	@$(PYTHON) -m venv .venv-peers
	@.venv-peers/bin/pip install --disable-pip-version-check $$(test -t 2 || echo --quiet) -r benchmarks/requirements-peers.txt
	.venv-peers/bin/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	touch $@

.venv/run: lock/run.txt pyproject.toml
	@$(PYTHON) -c 'import sys; v = sys.version_info[:2]; sys.exit(0 if (3, 11) <= v <= (3, 13) else f"tandemlift needs Python 3.11 to 3.13; $(PYTHON) is {v[0]}.{v[1]} (try: make PYTHON=python3.12)")'
	@echo 'Making a Python environment in .venv: a few seconds …'
	@$(PYTHON) -m venv .venv
	@echo 'Installing what lock/run.txt names (once): 100 MB to fetch, then some 10 s …'
	@$(PIP) -r lock/run.txt
	@echo 'Installing tandemlift: a second …'
	@$(PIP) --no-deps --no-build-isolation -e .
	@touch $@

.venv/dev: .venv/run lock/dev.txt
	@echo 'Installing what tests and linters need (once): 600 MB to fetch, then some 40 s …'
	@$(PIP) -r lock/dev.txt
	@touch $@

.venv/docs: .venv/run lock/docs.txt
	@echo 'Installing what the site is built with (once): 200 MB to fetch, then some 20 s …'
	@$(PIP) -r lock/docs.txt
	@touch $@

lock:            ## pin the newest versions of everything
	tools/lock

clean:           ## remove the environments and the outputs
	rm -rf .venv .venv-3.* .venv-peers out build dist
