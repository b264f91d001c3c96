# make run: build, replay the lecture's moving wall, draw it and a force controller.   make test: build and pass everything.
# make test NEED=page,wasm,notebooks: these optional parts must be there; else their tests are skipped and counted.
# Needed: python3 >= 3.10 with venv and headers, g++ and make. The rest comes from the package index into .venv.

PYTHON ?= python3
VENV   ?= .venv
BUILD  ?= build/ctest
BIN    := $(VENV)/bin
export PATH := $(abspath $(BIN)):$(PATH)
export CMAKE_BUILD_PARALLEL_LEVEL ?= $(shell nproc)

ifdef NEED
export ARM3R_NEED := $(NEED)
endif

SOURCES := pyproject.toml CMakeLists.txt LICENSE README.md CHANGELOG.md $(wildcard docs/*.md docs/*.schema.json build/page/live.html) \
           $(shell find cpp cmake tools python scenarios -type f -not -path '*/__pycache__/*')
CODE    := $(shell find cpp tests benchmarks examples -name '*.[ch]pp')
# Python compiles what it imports; pip would compile every module of every package, half of the time of an installation.
PIP     := $(BIN)/python -m pip --disable-pip-version-check install --no-compile --quiet
# Each worker has one core; threads of numpy's linear algebra would take turns with those of the other workers.
PYTEST  := OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -q -n $(CMAKE_BUILD_PARALLEL_LEVEL) --dist worksteal

.PHONY: run test gates seeds page docs wheels dist bench bench-avx2 format lint clean

run: $(VENV)/installed
	mkdir -p out
	$(BIN)/arm3r run scenarios/moving_wall.yaml -o out/moving_wall.csv
	$(BIN)/arm3r-plot out/moving_wall.csv --lecture --panels strobe,wall,contact -o out/
	$(BIN)/arm3r-plot scenarios/force_control/hybrid_first_contact.yaml -o out/

# The package index is read while compilers work.
test: $(VENV)/boost
	@$(MAKE) --no-print-directory -j2 $(VENV)/test $(BUILD)/tests
	@failed=0; \
	$(BIN)/ctest --test-dir $(BUILD) --output-on-failure --parallel $(CMAKE_BUILD_PARALLEL_LEVEL) || failed=1; \
	$(PYTEST) || failed=1; \
	exit $$failed

# Interrupted, it goes on where it was when it is called again with the same seed, as long as no file that git knows has changed.
SEED = $(or $(ARM3R_SEED),$(shell date +%Y%m%d))
TREE = $(shell git rev-parse "$$(git stash create | grep . || echo HEAD)^{tree}")
gates: $(VENV)/boost
	@$(MAKE) --no-print-directory -j2 $(VENV)/test $(BUILD)/tests
	@$(MAKE) --no-print-directory $(VENV)/docs $(VENV)/gates build/wheels/tested
	@echo "If this is interrupted, make gates ARM3R_SEED=$(SEED) goes on."
	ARM3R_SEED=$(SEED) ARM3R_SAMPLE=all ARM3R_RESUME=build/gates/$(SEED)-$(TREE).passed $(PYTEST) -m "(gate or sample) and not timed" --durations=40
	ARM3R_PATIENCE=1 $(BIN)/python -m pytest -q -m timed

# The gates that draw their cases at random, with four new seeds, a quarter of an hour each.
seeds: $(VENV)/test
	@for seed in $$($(BIN)/python -c "import secrets; print(*(secrets.randbits(31) for _ in range(4)))"); do \
	  echo "ARM3R_SEED=$$seed"; \
	  ARM3R_SEED=$$seed ARM3R_MINUTES=15 $(PYTEST) -m "gate and random" || exit 1; \
	done

# The live page, into build/page: needs node with npm. The tools come where they are needed: a change of JavaScript alone
# needs none of them.
page: build/page/arm3r.wasm build/page/core_licenses.txt web/page/node_modules/.package-lock.json
	node web/page/build.mjs

build/page/core_licenses.txt: build/page/arm3r.wasm tools/core_licenses.py
	$(BIN)/python tools/core_licenses.py wasm build/yaml_cpp/yaml-cpp > $@

web/page/node_modules/.package-lock.json: web/page/package-lock.json
	@$(MAKE) --no-print-directory $(VENV)/page
	npm --prefix web/page ci --no-audit --no-fund
	@touch $@

# The core in WebAssembly, by the clang of the Python package ziglang.
build/page/arm3r.wasm: $(shell find cpp cmake -type f) tools/yaml_cpp_source.py CMakeLists.txt pyproject.toml web/core/core.js
	@$(MAKE) --no-print-directory $(VENV)/wasm
	$(BIN)/python tools/yaml_cpp_source.py build/yaml_cpp
	$(BIN)/cmake -S . -B build/wasm -G Ninja -DCMAKE_TOOLCHAIN_FILE=cmake/wasm_toolchain.cmake \
	  -DARM3R_ZIG=$$($(BIN)/python -c "import ziglang; print(ziglang.__path__[0])")/zig \
	  -DARM3R_YAML_SOURCE=$(abspath build/yaml_cpp/yaml-cpp) \
	  -DARM3R_TAYLOR_KERNELS=$(abspath $(BUILD)/taylor/taylor_kernels.hpp) \
	  -DCMAKE_PREFIX_PATH=$$($(BIN)/python -c "import sysconfig; print(sysconfig.get_path('purelib'))") > /dev/null
	$(BIN)/cmake --build build/wasm
	mkdir -p $(@D)
	cp build/wasm/arm3r.wasm $@

docs: $(VENV)/docs
	$(BIN)/python docs/site/build.py

# Wheels for Linux, Windows and macOS, compiled here by the clang of the Python package ziglang; with the page, if it is built.
wheels: build/wheels/built

build/wheels/built: $(SOURCES) $(VENV)/wheels
	$(BIN)/python tools/wheels.py
	@touch $@

# For the gates: the others differ from these by what nothing here can run.
build/wheels/tested: $(SOURCES) $(VENV)/wheels
	$(BIN)/python tools/wheels.py linux-x86_64 linux-aarch64 windows-x86_64 macos-arm64
	@touch $@

# What a release publishes, into dist/: docs/releasing.md.
dist: page docs
	$(MAKE) wheels
	$(BIN)/python tools/dist.py build/wheels/*.whl

bench: $(VENV)/test $(VENV)/bench
	$(BIN)/cmake -S . -B $(BUILD) -DARM3R_BENCHMARKS=ON > /dev/null
	$(BIN)/cmake --build $(BUILD) --target arm3r_benchmarks
	$(BIN)/python benchmarks/run.py $(BUILD)/arm3r_benchmarks
	$(BIN)/python benchmarks/figures.py

# The same as on a processor without AVX-512. pip's build knows where Eigen is.
AVX2 := build/avx2
bench-avx2: $(VENV)/test $(VENV)/bench
	SKBUILD_BUILD_DIR=$(AVX2) $(PIP) --no-build-isolation --no-deps --upgrade --target $(AVX2)/python .
	$(BIN)/cmake -S . -B $(AVX2) -DARM3R_BENCHMARKS=ON -DARM3R_PEERS_FOR=x86-64-v3 > /dev/null
	$(BIN)/cmake --build $(AVX2) --target arm3r_benchmarks arm3r_without_avx512
	PYTHONPATH=$(AVX2)/python $(BIN)/python benchmarks/run.py $(AVX2)/arm3r_benchmarks \
	    --without-avx512 $(AVX2)/libarm3r_without_avx512.so

format: $(VENV)/dev
	$(BIN)/clang-format -i $(CODE)
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .
	$(BIN)/python tools/wrap_markdown.py README.md CONTRIBUTING.md docs/*.md $$(find cpp -name README.md)
	$(BIN)/python tools/strip_notebooks.py docs/notebooks/*.ipynb

lint: $(VENV)/dev
	$(BIN)/clang-format --dry-run -Werror $(CODE)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	for system in linux darwin win32; do $(BIN)/mypy --platform $$system || exit 1; done

clean:
	rm -rf build out $(VENV)

# The package, built in the tree that the C++ tests are built in too, so that nothing is compiled twice.
$(VENV)/installed: $(SOURCES) | $(VENV)/tools
	@SKBUILD_BUILD_DIR=$(BUILD) $(BIN)/python tools/install_package.py
	@touch $@

$(VENV)/tools: pyproject.toml
	@echo "Fetching the build's tools (cmake, ninja, Eigen, yaml-cpp) into $(VENV): about a minute."
	$(PYTHON) -m venv $(VENV)
	$(PIP) $$($(BIN)/python tools/build_requires.py)
	@touch $@

# An extra of the installed package.
$(VENV)/test $(VENV)/dev $(VENV)/docs $(VENV)/gates $(VENV)/page $(VENV)/bench $(VENV)/wasm $(VENV)/wheels: $(VENV)/%: pyproject.toml | $(VENV)/installed
	$(PIP) 'arm3r_cpp[$*]'
	@touch $@

# What the C++ tests are compiled with.
$(VENV)/boost: pyproject.toml | $(VENV)/installed
	$(PIP) $$($(BIN)/python tools/build_requires.py cmeel-boost)
	@touch $@

$(VENV)/test: | $(VENV)/boost # two at once would write the same files

.PHONY: $(BUILD)/tests
$(BUILD)/tests: $(VENV)/installed $(VENV)/boost
	$(BIN)/cmake -S . -B $(BUILD) -DARM3R_TESTS=ON > /dev/null
	$(BIN)/cmake --build $(BUILD) --target arm3r_tests
