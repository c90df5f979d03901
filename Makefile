# A thin door: CMake presets do the work (cmake --list-presets).
PREFIX ?= /usr/local

# make instructions RECORD=1 writes what it counts to bench/instructions.csv.
RECORD ?=
# make check STAGE=cells: one stage, a folder of tests/.
STAGE ?=
STAGES = $(sort $(notdir $(patsubst %/,%,$(dir $(wildcard tests/*/*_test.cpp)))))

.PHONY: help demo test check nightly bench instructions format lint analyze reference install deb hooks clean dependencies configure
.DEFAULT_GOAL := help

help: ## What there is to make
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "  make %-12s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

demo: configure ## Build, and run the main job on a shipped cloud
	@cmake --build --preset release --target cloud2csg
	@scripts/demo.sh

test: configure ## Build everything and run all tests
	@cmake --build --preset release
	@ctest --preset release

check: ## Build and test one stage: make check STAGE=cells
	@case " $(STAGES) " in *" $(or $(STAGE),none) "*) ;; \
	  *) echo "make check STAGE=...: one of $(STAGES)" >&2; exit 2;; esac
	@$(MAKE) --no-print-directory configure
	@cmake --build --preset release --target test_$(STAGE)
	@ctest --preset release -R '^$(STAGE)\.'

nightly: configure ## What takes hours: the analyzer, many cases of every property, mutants, coverage, packages
	@scripts/nightly.sh

bench: configure ## Print the figures of speed and recovery (docs/performance.md explains them)
	@cmake --build --preset release
	@scripts/bench.sh

instructions: configure ## Count the instructions of each step; fails when one takes many more than recorded
	@scripts/instructions.sh $(if $(RECORD),record)

reference: ## Write the C++ and Python references to build/reference
	@scripts/install_dependencies.sh reference
	@scripts/reference.sh

format: ## Format all sources in place
	@scripts/install_dependencies.sh lint
	@git ls-files '*.cpp' '*.hpp' | xargs clang-format -i

lint: configure ## clang-format, clang-tidy, sizes of files; any finding is an error
	@scripts/install_dependencies.sh lint
	@scripts/lint.sh

analyze: configure ## Follow the paths through every source with clang's analyzer: half an hour
	@scripts/install_dependencies.sh lint
	@test -f build/debug/build.ninja || cmake --preset debug >/dev/null
	@git ls-files 'src/*.cpp' 'apps/*.cpp' 'bench/*.cpp' 'python/*.cpp' | xargs scripts/tidy.py --each build/debug

install: configure ## Install program, library and headers under PREFIX
	@cmake --build --preset release --target all
	@cmake --install build/release --prefix $(PREFIX)

deb: configure ## Packages for Debian: the program, and the library
	@cmake --build --preset release --target all
	@cpack --config build/release/CPackConfig.cmake -B build/packages

hooks: ## Let git format the C++ files of each commit (scripts/pre-commit)
	@scripts/install_dependencies.sh lint
	@git config core.hooksPath scripts

clean: ## Remove what was built
	@rm -rf build out

dependencies:
	@scripts/install_dependencies.sh

configure: dependencies
	@mkdir -p build
	@test -f build/release/build.ninja || cmake --preset release >build/configure.log 2>&1 || \
	  { cat build/configure.log; exit 1; }
