# Etalon: see README.md and docs/development.md.
#
#   make [all]      build/$(VARIANT)/etalon
#   make tests      the same and all programs of tests and bench/, not run
#   make test       every unit, statistical, numerical and command-line test
#   make test-long  the same with ETALON_LONG=1
#   make test-unit  the unit tests alone; test-stat: statistical and numerical ones; test-cli
#   make test-nightly   lint, all with asserts on, then test-stat under the sanitizers
#   make test-page  the pages of `etalon report` and --live in a browser, if there is one
#   make demo       automatic against manual p_l: a picture, plots and the outcome in words,
#                   in results/demo/
#   make bench      automatic against manual p_l in short, 2 minutes: a table and a page
#   make bench-speed    mutations per CPU second, beside bare Embree on the same rays
#   make bench-throughput   the same for a table of scenes, kept in results/throughput.csv
#                   by commit, and beside the last commit there
#   make bench-NAME correctness beside others: peer_box, coffee, living_room, startup_table,
#                   same_bits, keep_all, efficiency, pfmcmc, zsolnai13_table1, zeng19_table3,
#                   zeng19_figure5, zeng19_figure6, startup_length, regress_power, regress_baseline, stability,
#                   verdict, until, tungsten, malformed, long_run, budgets, mutants, smlt, mlt,
#                   jumps, p_curve, race
#   make lint       format, layers, references, cppcheck, clang-tidy
#   make valgrind   every command on small inputs under memcheck
#   make fuzz       libFuzzer on the readers: FUZZ_SECONDS=600 each, FUZZ="pbrt ply" for some
#   make docs       the table of docs/settings.md anew
#   make shape      files and lines per room, lengths of functions
#   make deps       install what is missing (Debian packages)
#   make install    PREFIX=/usr/local, DESTDIR=
#   make clean      removes build/
#
# VARIANT=release|checked|debug|san   CC=gcc|clang   CI=1 makes warnings errors
# MPI=1 makes a second program for mpirun, build/$(VARIANT)-mpi/etalon, from the same
# objects but one (Debian: libopenmpi-dev, openmpi-bin). Tests make it where these are.
# checked: release with asserts. ndebug: compiles the files with asserts without them, for
# the warnings.
# CFLAGS and LDFLAGS of the caller are added to ours.

VARIANT ?= release
ifeq ($(filter release checked debug san,$(VARIANT)),)
$(error VARIANT is '$(VARIANT)'; it must be release, checked, debug or san)
endif
CC := $(if $(filter default,$(origin CC)),gcc,$(CC))
PREFIX ?= /usr/local
BUILD := build/$(VARIANT)$(if $(findstring clang,$(notdir $(CC))),-clang)

WARN := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion \
        -Wstrict-prototypes -Wmissing-prototypes -Wvla $(if $(CI),-Werror)
OPT_checked := -O2 -march=native
OPT_release := $(OPT_checked) -DNDEBUG
OPT_debug := -O0 -g3
OPT_san := -O1 -fsanitize=address,undefined -fno-sanitize-recover=undefined \
           -fno-omit-frame-pointer
FLAGS := -std=c11 -D_GNU_SOURCE -ffp-contract=off -g -fopenmp $(OPT_$(VARIANT)) $(CFLAGS)
INCLUDES := -Isrc -I$(BUILD)/gen \
            -isystem /usr/include/OpenEXR -isystem /usr/include/Imath
COMPILE = $(CC) $(FLAGS) $(WARN) $(INCLUDES) -MMD -MP
LDLIBS := -lembree3 -lOpenEXRCore -lyaml -lexpat -lmicrohttpd -lstb -lz -lm
# One file knows of MPI. mpi_if_there: the program, where Open MPI is installed.
MPI_BUILD := $(BUILD)-mpi
mpi_if_there = $(if $(shell pkg-config --modversion ompi-c 2>/dev/null),$(MPI_BUILD)/etalon)
TEST_LDLIBS := -lcmocka -lgsl -lgslcblas -lm

MAIN := $(wildcard src/cli/main.c)
SRC := $(filter-out $(MAIN),$(wildcard src/*/*.c src/*/*/*.c))
TEST_SRC := $(wildcard tests/unit/test_*.c tests/stat/test_*.c tests/num/test_*.c)
OBJ := $(SRC:src/%.c=$(BUILD)/obj/%.o) $(BUILD)/obj/gen/report_assets.o
MAIN_OBJ := $(MAIN:src/%.c=$(BUILD)/obj/%.o)
LIB := $(BUILD)/libetalon.a
PROGRAM := $(if $(MAIN),$(BUILD)/etalon)
TESTS := $(TEST_SRC:tests/%.c=$(BUILD)/tests/%)
UNIT_TESTS := $(filter $(BUILD)/tests/unit/%,$(TESTS))
STAT_TESTS := $(filter-out $(UNIT_TESTS),$(TESTS))
CLI_TESTS := $(wildcard tests/cli/*.sh)
EVIDENCE := peer_box coffee living_room startup_table same_bits keep_all efficiency pfmcmc \
            zeng19_table3 zeng19_figure5 zeng19_figure6 startup_length regress_baseline regress_power \
            stability verdict until standard_errors tungsten malformed long_run budgets \
            mutants zsolnai13_table1 smlt mlt jumps p_curve race
BENCH_SRC := $(filter-out bench/heap_count.c,$(wildcard bench/*.c))
FUZZ_SRC := $(wildcard tests/fuzz/*.c)
BENCHES := $(BENCH_SRC:%.c=$(BUILD)/%) $(BUILD)/bench/heap_count.so
INFO := $(BUILD)/gen/build_info.h
PAGE := report_style src/report/report.css report_comparer src/report/report.html \
        report_script src/report/report_page.js report_script src/report/report_pictures.js \
        report_script src/report/report_comparer.js \
        report_live_body src/report/report_live.html \
        report_live_script src/report/report_live_plot.js \
        report_live_script src/report/report_live.js

.PHONY: all tests test run-tests test-unit test-stat test-cli test-long test-nightly
.PHONY: bench bench-speed bench-throughput demo lint docs valgrind shape deps install
.PHONY: fuzz clean FORCE
.PHONY: $(EVIDENCE:%=bench-%)
.SECONDARY: # objects of tests stay
.DELETE_ON_ERROR:

all: $(LIB) $(PROGRAM) $(if $(MPI),$(MPI_BUILD)/etalon)
tests: all $(TESTS) $(BENCHES) $(mpi_if_there)

# Rewritten only when something changed, so that nothing is rebuilt for nothing.
$(INFO): FORCE
	@mkdir -p $(@D)
	@.ci/build_info '$(CC)' '$(VARIANT)' '$(FLAGS)' >$@.new
	@if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi

# What the page of `etalon report` is made of, as a table of lines.
$(BUILD)/gen/report_assets.c: $(filter src/%,$(PAGE)) .ci/embed
	@mkdir -p $(@D)
	@.ci/embed report/report_assets.h $(PAGE) >$@

$(BUILD)/obj/gen/%.o: $(BUILD)/gen/%.c
	@mkdir -p $(@D)
	@$(COMPILE) -c $< -o $@

$(BUILD)/obj/%.o: src/%.c | $(INFO)
	@mkdir -p $(@D)
	@echo "CC $<"
	@$(COMPILE) -c $< -o $@

$(BUILD)/obj/tests/%.o: tests/%.c | $(INFO)
	@mkdir -p $(@D)
	@echo "CC $<"
	@$(COMPILE) -Itests -c $< -o $@

$(BUILD)/obj/bench/%.o: bench/%.c | $(INFO)
	@mkdir -p $(@D)
	@echo "CC $<"
	@$(COMPILE) -Itests -c $< -o $@

$(LIB): $(OBJ)
	@rm -f $@
	@ar rcs $@ $^

$(BUILD)/etalon: $(MAIN_OBJ) $(LIB)
	@echo "LD $@"
	@$(CC) $(FLAGS) $^ $(LDFLAGS) $(LDLIBS) -o $@

$(MPI_BUILD)/obj/base/ranks.o: src/base/ranks.c
	@mkdir -p $(@D)
	@echo "CC $< (MPI)"
	@$(COMPILE) -DWITH_MPI $$(pkg-config --cflags ompi-c | sed 's/-I/-isystem /g') -c $< -o $@

# Its object stands before the library, which is then not asked for the other.
$(MPI_BUILD)/etalon: $(MAIN_OBJ) $(MPI_BUILD)/obj/base/ranks.o $(LIB)
	@echo "LD $@"
	@$(CC) $(FLAGS) $^ $(LDFLAGS) $(LDLIBS) $$(pkg-config --libs ompi-c) -o $@

$(BUILD)/tests/%: $(BUILD)/obj/tests/%.o $(LIB)
	@mkdir -p $(@D)
	@$(CC) $(FLAGS) $^ $(LDFLAGS) $(LDLIBS) $(TEST_LDLIBS) -o $@

# The two commands of the README see to the packages first.
test:
	@.ci/deps --if-debian
	@$(MAKE) --no-print-directory tests
	@$(MAKE) --no-print-directory run-tests

# The long ones first, so that no core waits for the last one.
run-tests: all $(TESTS) $(BUILD)/bench/settings_table $(mpi_if_there)
	@ETALON=$(CURDIR)/$(BUILD)/etalon tests/run_tests.sh $(CLI_TESTS) $(STAT_TESTS) $(UNIT_TESTS)

test-unit: all $(UNIT_TESTS)
	@ETALON=$(CURDIR)/$(BUILD)/etalon tests/run_tests.sh $(UNIT_TESTS)

test-stat: all $(STAT_TESTS)
	@ETALON=$(CURDIR)/$(BUILD)/etalon tests/run_tests.sh $(STAT_TESTS)

test-cli: all $(BUILD)/bench/settings_table $(mpi_if_there)
	@ETALON=$(CURDIR)/$(BUILD)/etalon tests/run_tests.sh $(CLI_TESTS)

test-long:
	@ETALON_LONG=1 $(MAKE) test

# The sanitizers make everything three to four times as slow.
test-nightly:
	@$(MAKE) --no-print-directory lint
	@$(MAKE) --no-print-directory VARIANT=checked tests
	@$(MAKE) --no-print-directory VARIANT=checked run-tests
	@TEST_TIMEOUT=3600 $(MAKE) --no-print-directory CC=clang VARIANT=san test-stat

.PHONY: ndebug
ndebug: $(patsubst src/%.c,$(BUILD)/obj/%.o,$(shell grep -lw assert $(SRC)))

.PHONY: test-page
test-page: all
	@ETALON=$(CURDIR)/$(BUILD)/etalon tests/run_tests.sh $(wildcard tests/page/test_*.sh)

# The wraps record the rays, for bare Embree to replay.
$(BUILD)/bench/speed: private LDFLAGS += -Wl,--wrap=rtcIntersect1,--wrap=rtcOccluded1

$(BUILD)/bench/%: $(BUILD)/obj/bench/%.o $(LIB)
	@mkdir -p $(@D)
	@$(CC) $(FLAGS) $^ $(LDFLAGS) $(LDLIBS) $(TEST_LDLIBS) -o $@

# For LD_PRELOAD: without the sanitizers, which have allocators of their own.
$(BUILD)/bench/heap_count.so: bench/heap_count.c bench/heap_count.h
	@mkdir -p $(@D)
	@$(CC) -std=c11 -D_GNU_SOURCE -O2 $(WARN) -fPIC -shared $< -o $@

bench: all
	@ETALON=$(BUILD)/etalon bench/auto_vs_manual.sh

bench-speed: $(BUILD)/bench/speed
	@SPEED=$< bench/speed.sh

bench-throughput: $(BUILD)/bench/speed
	@SPEED=$< bench/throughput.sh

# Against pictures and figures of others: bench-peer_box, bench-coffee, ...
$(EVIDENCE:%=bench-%): bench-%: all $(BUILD)/bench/regions
	@ETALON=$(BUILD)/etalon REGIONS=$(BUILD)/bench/regions BENCH=$(BUILD)/bench bench/$*.sh
bench-stability: $(BUILD)/bench/stability
bench-pfmcmc: $(BUILD)/bench/pfmcmc $(BUILD)/bench/pfbias
bench-verdict bench-until: $(BUILD)/bench/coverage
bench-mutants: $(TESTS)
bench-standard_errors: $(BUILD)/bench/standard_errors
bench-p_curve: $(BUILD)/bench/p_curve
bench-race: $(BUILD)/bench/race
bench-long_run: $(BUILD)/bench/drift $(BUILD)/bench/heap_watch $(BUILD)/bench/heap_count.so

demo:
	@.ci/deps --if-debian
	@$(MAKE) --no-print-directory all
	@ETALON=$(BUILD)/etalon bench/demo.sh

# Valgrind knows no AVX-512.
valgrind:
	@$(MAKE) VARIANT=debug BUILD=build/valgrind CFLAGS='-O1 -march=x86-64-v2'
	@tests/valgrind.sh build/valgrind/etalon

# Everything is built anew for it, by clang.
FUZZ ?= pbrt mitsuba yaml ply obj serialized exr
FUZZ_SECONDS ?= 600
fuzz:
	@$(MAKE) CC=clang VARIANT=san BUILD=build/fuzz \
	    CFLAGS='-fsanitize=fuzzer-no-link,float-cast-overflow' $(FUZZ:%=build/fuzz/fuzz/%)
	@FUZZ_SECONDS=$(FUZZ_SECONDS) tests/fuzz/run.sh build/fuzz $(FUZZ)

$(BUILD)/fuzz/%: $(BUILD)/obj/tests/fuzz/fuzz_%.o $(LIB)
	@mkdir -p $(@D)
	@$(CC) $(FLAGS) $^ -fsanitize=fuzzer $(LDFLAGS) $(LDLIBS) -o $@

lint: | $(INFO)
	@ANALYZE=$(ANALYZE) tests/lint.sh

docs: $(BUILD)/bench/settings_table
	@.ci/docs $< docs/settings.md

shape:
	@tests/shape.sh

deps:
	@.ci/deps

install: all
	install -D -m 755 $(BUILD)/etalon $(DESTDIR)$(PREFIX)/bin/etalon

clean:
	rm -rf build

-include $(OBJ:.o=.d) $(MAIN_OBJ:.o=.d) $(MPI_BUILD)/obj/base/ranks.d
-include $(patsubst %.c,$(BUILD)/obj/%.d,$(TEST_SRC) $(BENCH_SRC) $(FUZZ_SRC))
