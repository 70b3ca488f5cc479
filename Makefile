# The developer's front door. `make help` lists what it opens.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
SITE   := build/site-venv
# With `PLAYGROUND=` the site is built without the playground.
PLAYGROUND = yes
READY  := $(VENV)/.ready
# pip installs uv, with the hash that the lock has for it, and uv the rest, in a fifth of the time.
UV   = $(BIN)/uv --quiet --no-progress --system-certs
INTO = $(UV) pip install --python
LOCK = $(UV) pip compile --python-version 3.11 --upgrade --generate-hashes --strip-extras --custom-compile-command "make lock"

# Tests start hundreds of processes: each would compile all modules anew.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help demo test test-all fuzz fuzz-readers fuzz-mends test-model lint ceilings format reference colours site pane editors vscode test-vscode bench bench-commands bench-stages bench-editor bench-check bench-regions bench-sweep bench-solver bench-peers accept examples site-playground test-playground lock clean

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-16s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: $(READY) ## set up, then draw examples/telephone.aidl
	@mkdir -p build
	@$(BIN)/aidl compile examples/telephone.aidl -o build/telephone.svg --quiet
	@echo "The drawing is in $(CURDIR)/build/telephone.svg; open it in a browser."

test: $(READY) ## run the tests: all but the slow ones, with a share of the examples of each property and of many cases
	$(BIN)/python -m pytest -n auto --dist worksteal -m "not slow"

test-all: $(READY) ## run all tests, with TIMES (2) as many examples as are written, others each time
	AIDL_EXAMPLES=$(or $(TIMES),2) $(BIN)/python -m pytest -n auto --dist worksteal

fuzz: $(READY) ## try programs that ask for trouble, for MINUTES (2), from a SEED if one is given
	$(BIN)/python -m tests.fuzz --minutes $(or $(MINUTES),2) $(if $(SEED),--seed $(SEED))

fuzz-readers: $(READY) ## try changed files and messages on what reads them, for MINUTES (2), from a SEED if one is given
	$(BIN)/python -m tests.fuzz.readers --minutes $(or $(MINUTES),2) $(if $(SEED),--seed $(SEED))

fuzz-mends: $(READY) ## try how PROGRAMS (1000) mutants are mended, from a SEED (1), with those of TEXTS
	$(BIN)/python -m tests.fuzz.mends --programs $(or $(PROGRAMS),1000) --seed $(or $(SEED),1) $(if $(TEXTS),--texts $(TEXTS))

test-model: $(READY) ## ask a real small model; installs it and llama.cpp into build/model, once
	$(BIN)/python tests/model/install.py build/model
	AIDL_TEST_MODEL=build/model $(BIN)/python -m pytest tests/model

lint: $(READY) ceilings ## style, format, types, the direction of imports and the size of each room
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

ceilings: $(READY) ## compare the lines of each room with its ceiling in pyproject.toml; `.ci/ceilings.py --set` lowers these
	@$(BIN)/python .ci/ceilings.py

format: $(READY) ## put all Python code into its canonical form
	$(BIN)/ruff check --fix-only --quiet .
	$(BIN)/ruff format .

reference: $(READY) colours ## write all that is generated from the library: docs/reference, docs/guide.md, llms.txt, what editors read
	$(BIN)/python -m aidl_dev.reference .
	$(BIN)/python -m aidl_site.pictures .

colours: $(READY) ## write the grammars, words and snippets for editors anew
	$(BIN)/python -m aidl_dev.highlighting .

site: $(READY) $(SITE)/.ready ## build the site into build/site, the playground with it; dead links fail; ADDRESS is where it will be found
	$(BIN)/python -m aidl_site . --builder $(SITE)/bin/zensical $(if $(ADDRESS),--address $(ADDRESS)) $(if $(PLAYGROUND),--playground)
	@$(if $(PLAYGROUND),$(MAKE) --no-print-directory site-playground && $(BIN)/python -m aidl_site . --check)

pane: ## bundle the editor of the preview's pane: server/aidl_server/preview/pane/editor.js
	cd editors/codemirror && npm ci --silent --no-audit --no-fund && npm run --silent pane

editors: vscode ## check all that is built with Node: the preview's pane, the CodeMirror package, the extension
	cd editors/preview && npm ci --silent --no-audit --no-fund && npm run --silent check
	cd editors/codemirror && npm ci --silent --no-audit --no-fund && npm test --silent

vscode: ## check and test the extension for VS Code, and pack it: build/aidl.vsix
	@mkdir -p build
	cd editors/vscode && npm ci --silent --no-audit --no-fund && npm run --silent check && npm test --silent \
		&& npm run --silent package -- --out ../../build/aidl.vsix

test-vscode: $(READY) vscode ## try the extension in VS Code itself; installs that into build/code-server, once
	$(BIN)/python tests/editors/vscode/install.py build/code-server
	AIDL_CODE_SERVER=build/code-server AIDL_VSIX=build/aidl.vsix $(BIN)/python -m pytest tests/editors/vscode

bench: $(READY) ## measure the command and the stages
	$(BIN)/python benchmarks/run.py

bench-commands: $(READY) ## measure whole commands beside OpenSCAD, on the pairs of programs in FOLDER
	$(BIN)/python benchmarks/commands.py $(FOLDER)

bench-stages: $(READY) ## measure each stage of a compile on the examples, or on the programs in FOLDERS
	$(BIN)/python benchmarks/stages.py $(FOLDERS)

bench-editor: $(READY) ## measure what an editor waits for
	$(BIN)/python benchmarks/editor.py

bench-check: $(READY) ## measure a check beside another language's
	$(BIN)/python benchmarks/check.py

bench-regions: $(READY) ## measure regions beside other libraries
	$(BIN)/python benchmarks/regions.py

bench-sweep: $(READY) ## measure sweeps beside a loop, a cluster on this machine and OpenSCAD
	$(BIN)/python benchmarks/sweep.py

bench-solver: $(READY) ## measure the solver against its peers
	$(BIN)/python benchmarks/solver/run.py

bench-peers: $(READY) ## install those peers, into benchmarks/solver/.peers
	$(BIN)/python benchmarks/solver/install_peers.py

accept: $(READY) ## take the present results as the new goldens, the README's pictures among them
	AIDL_ACCEPT=1 $(BIN)/python -m pytest $(wildcard tests/golden tests/spec tests/cli/test_transcripts.py)
	$(BIN)/aidl compile examples/telephone.aidl -o docs/images/telephone.svg --quiet
	$(BIN)/aidl compile examples/motor_bracket.aidl -o docs/images/motor_bracket.svg --dimension --quiet

examples: $(READY) ## draw every example into build/examples, those of the gallery among them
	@mkdir -p build/examples/gallery
	@$(BIN)/python -c "import sys; from aidl_lang.tools.cli import main; sys.exit(any(main(['compile', file, '-o', 'build/' + file[:-4] + 'svg']) for file in sys.argv[1:]))" examples/*.aidl examples/gallery/*.aidl

site-playground: $(READY) ## build the playground into build/site/playground, with Pyodide from its CDN or from the folder PYODIDE
	$(BIN)/python -m aidl_web build/site/playground $(if $(PYODIDE),--pyodide $(PYODIDE))

test-playground: $(READY) ## try the playground in Chromium; installs Pyodide into build/pyodide, once
	$(BIN)/python web/tests/install.py build/pyodide
	AIDL_PYODIDE=build/pyodide $(BIN)/python -m pytest -n 0 web/tests

lock: $(READY) ## renew requirements-dev.lock and requirements-site.lock
	$(LOCK) $(patsubst %,--extra %,dev nest step 3mf models mcp cluster parquet) --output-file requirements-dev.lock pyproject.toml
	$(LOCK) --group site --output-file requirements-site.lock

clean: ## remove what was built; the virtualenv stays
	rm -rf build dist .mypy_cache .pytest_cache .ruff_cache .import_linter_cache .hypothesis

$(SITE)/.ready: requirements-site.lock | $(READY)
	@$(PYTHON) -m venv $(SITE)
	@$(INTO) $(SITE)/bin/python --require-hashes -r requirements-site.lock
	@touch $@

# Done again only when the lock or the project file is newer than the last time.
$(READY): requirements-dev.lock pyproject.toml server/pyproject.toml eval/pyproject.toml dev/pyproject.toml web/pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "AIDL needs Python 3.11 or newer")'
	@echo "Setting up $(VENV) …"
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@sed -n '/^uv==/,/# via/p' requirements-dev.lock | $(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r /dev/stdin
	@$(INTO) $(BIN)/python --require-hashes -r requirements-dev.lock
	@$(INTO) $(BIN)/python --no-deps --no-build-isolation $(patsubst %,--editable %,. server eval dev web)
	@touch $@
