# make help tells what there is. Everything is done by CMake, ctest and the scripts in scripts/.
BUILD_DIR ?= build
BUILD_TYPE ?= Release
CMAKE_ARGS ?=
PREFIX ?= /usr/local
JOBS ?= $(shell nproc)
SANITIZE := address,undefined
TSAN = TSAN_OPTIONS=suppressions=$(CURDIR)/cmake/tsan-suppressions.txt

# Continuous integration takes no warning for an answer.
ifeq ($(CI),true)
override CMAKE_ARGS += -DSEMLOOP_WERROR=ON
endif

.DEFAULT_GOAL := build
.PHONY: help dependencies configure build test demo experiments picture test-sanitize bench install format clean

help: ## tells the targets
	@echo 'make [target] [CMAKE_ARGS=-D...] [BUILD_DIR=build] [JOBS=n]'
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  \1\t\2/p' $(MAKEFILE_LIST) | expand -t 18

dependencies:
	@scripts/install-dependencies.sh

configure: dependencies
	cmake -S . -B $(BUILD_DIR) -G Ninja -DCMAKE_BUILD_TYPE=$(BUILD_TYPE) $(CMAKE_ARGS)

build: configure ## installs what is missing, builds into build/ (programs: build/bin)
	cmake --build $(BUILD_DIR) -j $(JOBS)

test: build ## builds and runs all tests
	ctest --test-dir $(BUILD_DIR) -j $(JOBS) --output-on-failure

demo: OUT ?= out/demo
demo: build ## simulates a flat and maps it; or maps a sequence: DATA=<TUM RGB-D folder> MODEL=<net.onnx>
	@DATA='$(DATA)' MODEL='$(MODEL)' EMBEDDING='$(EMBEDDING)' SIMULATE='$(SIMULATE)' SEED='$(SEED)' \
		SIZE='$(SIZE)' OUT='$(OUT)' BIN='$(BUILD_DIR)/bin' scripts/demo.sh

experiments: OUT ?= out/experiments
experiments: build ## the paper's experiments into doc/results: [SEEDS=1,2,3] [TUM=<folder> MODEL=<net.onnx>] [QUICK=1]
	@scripts/install-dependencies.sh python3-matplotlib
	@SEEDS='$(SEEDS)' JOBS='$(JOBS)' QUICK='$(QUICK)' TUM='$(TUM)' MODEL='$(MODEL)' \
		EMBEDDING='$(EMBEDDING)' OUT='$(OUT)' BIN='$(BUILD_DIR)/bin' scripts/experiments/run.sh

picture: OUT ?= out/demo
picture: ## draws what the last make demo simulated and mapped: OUT/apartment.png, OUT/objects.png
	@scripts/install-dependencies.sh python3-matplotlib
	@scripts/picture.py $(OUT)/result $(OUT)/apartment $(OUT)/apartment.png
	@scripts/objects_picture.py --bin $(BUILD_DIR)/bin $(OUT)/result $(OUT)/apartment $(OUT)/objects.png

test-sanitize: dependencies ## runs all tests under AddressSanitizer and UndefinedBehaviorSanitizer
	cmake -S . -B $(BUILD_DIR)-sanitize -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
		-DSEMLOOP_SANITIZE=$(SANITIZE) -DSEMLOOP_BUILD_BENCHMARKS=OFF $(CMAKE_ARGS)
	$(TSAN) cmake --build $(BUILD_DIR)-sanitize -j $(JOBS)
	$(TSAN) \
	LSAN_OPTIONS=suppressions=$(CURDIR)/cmake/lsan-suppressions.txt \
	UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1:suppressions=$(CURDIR)/cmake/ubsan-suppressions.txt ctest --test-dir $(BUILD_DIR)-sanitize -j $(JOBS) --output-on-failure

bench: build ## runs the benchmarks one after the other
	@for program in $(BUILD_DIR)/bin/*_benchmark; do echo "== $$program"; $$program || exit 1; done

install: build ## installs into PREFIX (/usr/local)
	cmake --install $(BUILD_DIR) --prefix $(PREFIX)

format: ## formats all C++ files as .clang-format says
	@scripts/install-dependencies.sh clang-format
	find libs apps rawlog_tools tests benchmarks doc/examples \( -name '*.h' -o -name '*.cpp' \) -print0 | \
		xargs -0 clang-format -i

clean: ## removes build/ and build-sanitize/
	rm -rf $(BUILD_DIR) $(BUILD_DIR)-sanitize
