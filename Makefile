# Etalon: see README.md. VARIANT=release|debug|san, CC=gcc|clang.
VARIANT ?= release
CC := $(if $(filter default,$(origin CC)),gcc,$(CC))
BUILD := build/$(VARIANT)

WARN := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion \
        -Wstrict-prototypes -Wmissing-prototypes -Wvla
OPT_release := -O3 -march=native -DNDEBUG
OPT_debug := -O0 -g3
OPT_san := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=undefined \
           -fno-omit-frame-pointer
CFLAGS := -std=c11 -D_GNU_SOURCE $(WARN) $(if $(CI),-Werror) -ffp-contract=off -g \
          $(OPT_$(VARIANT)) -fopenmp -Isrc -I$(BUILD)/gen -MMD -MP \
          -isystem /usr/include/OpenEXR -isystem /usr/include/Imath
LDLIBS := -lembree3 -lOpenEXRCore -lyaml -lstb -lz -lm

SRC := $(filter-out src/cli/main.c,$(wildcard src/*/*.c))
OBJ := $(SRC:src/%.c=$(BUILD)/obj/%.o)
LIB := $(BUILD)/libetalon.a
TEST_SRC := $(wildcard tests/unit/test_*.c tests/stat/test_*.c tests/num/test_*.c)
TESTS := $(TEST_SRC:tests/%.c=$(BUILD)/tests/%)

.PHONY: all clean test
all: $(BUILD)/etalon

$(BUILD)/obj/%.o: src/%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) -c $< -o $@

$(LIB): $(OBJ)
	@rm -f $@
	@ar rcs $@ $^

$(BUILD)/etalon: $(BUILD)/obj/cli/main.o $(LIB)
	$(CC) $(CFLAGS) $^ $(LDLIBS) -o $@

$(BUILD)/tests/%: tests/%.c $(LIB)
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) -Itests $< $(LIB) $(LDLIBS) -lcmocka -lgsl -lgslcblas -lm -o $@

test: $(TESTS)
	@for t in $(TESTS); do echo "== $$t"; $$t || exit 1; done

clean:
	rm -rf build

-include $(OBJ:.o=.d) $(TESTS:=.d)
