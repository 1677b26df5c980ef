# Every target sets up what it needs. The virtual environment is made once, and again when its versions change.
VENV := .venv
PYTHON := $(VENV)/bin/python
READY := $(VENV)/.ready

.PHONY: help demo test test-quick test-package test-gui test-web test-farm test-faults lint docs extension bench clean

help:
	@echo "make demo        capture two materials, preview them and compare with Cycles; pictures under demo/"
	@echo "make test        run all tests but those in a window (make test-quick: without shaders and renders)"
	@echo "make test-package build the wheel, and test it in a Python 3.11 without Blender"
	@echo "make lint        run ruff and mypy"
	@echo "make docs        build the documentation site: site/index.html"
	@echo "make extension   build dist/rsibr-*.zip: drop it on Blender's window"
	@echo "make test-gui    test the extension in Blender's window; .ci/window/blender installs a Blender for it (root on Debian)"
	@echo "make test-web    load exported light in engines in a browser; .ci/web/engines installs them (root on Debian, npm)"
	@echo "make test-farm   send batches to a manager of Flamenco with two workers; FLAMENCO=FOLDER has their programs"
	@echo "make test-faults kill commands at 300 moments and read 100,000 damaged files; takes hours"
	@echo "make bench       measure whole commands, captures, previews and filtering on this machine; prints the docs' tables"
	@echo "make clean       remove everything that these targets made"

$(READY): pyproject.toml .python-version .ci/constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit("%d.%d" % sys.version_info[:2] != "'$$(cat .python-version)'")' 2>/dev/null \
	  || { python=$$(.ci/find-python) && "$$python" -m venv --clear $(VENV); }
	$(PYTHON) -m pip install --quiet --disable-pip-version-check --constraint .ci/constraints.txt --editable '.[dev,docs]'
	@$(PYTHON) .ci/check_bpy.py
	@touch $@

demo: $(READY)
	PATH="$(CURDIR)/$(VENV)/bin:$$PATH" docs/demo.sh demo

test: $(READY)
	$(PYTHON) -m pytest -n 2

test-quick: $(READY)
	$(PYTHON) -m pytest -n 2 -m "not slow" --ignore tests/cycles --ignore tests/glsl --ignore tests/gui

test-package:
	.ci/test-package

test-gui: $(READY)
	RSIBR_REQUIRE=gui $(PYTHON) -m pytest tests/gui

test-web: $(READY)
	.ci/web/engines install
	RSIBR_REQUIRE=bpy,gl,web $(PYTHON) -m pytest tests/web

test-farm: $(READY)
	RSIBR_REQUIRE=farm FLAMENCO="$(FLAMENCO)" $(PYTHON) -m pytest tests/farm

test-faults: $(READY)
	RSIBR_MOMENTS=300 RSIBR_FAULT_CASES=35000 RSIBR_REQUIRE=gl,bpy,cycles $(PYTHON) -m pytest --timeout 0 tests/faults tests/glsl/test_faulty_draws.py tests/glsl/test_load.py

lint: $(READY)
	$(PYTHON) -m ruff check
	$(PYTHON) -m ruff format --check
	$(PYTHON) -m mypy

docs: $(READY)
	$(PYTHON) -m sphinx --quiet --fresh-env --fail-on-warning --keep-going docs site

extension: $(READY)
	$(PYTHON) .ci/build_extension.py

bench: $(READY)
	$(PYTHON) .ci/bench_commands.py
	$(PYTHON) .ci/bench.py
	$(PYTHON) .ci/bench_prefilter.py
	$(PYTHON) .ci/bench_growth.py
	$(PYTHON) .ci/bench_antialiased.py
	$(PYTHON) .ci/bench_fits.py
	$(PYTHON) .ci/bench_lobes.py
	$(PYTHON) .ci/bench_mips.py
	$(PYTHON) .ci/bench_materials.py
	$(PYTHON) .ci/bench_own_materials.py
	$(PYTHON) .ci/show_materials.py
	$(PYTHON) .ci/show_render.py
	$(PYTHON) .ci/bench_viewport.py

clean:
	rm -rf $(VENV) build demo dist docs/api docs/references.md site wheels rsibr.egg-info .hypothesis .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
