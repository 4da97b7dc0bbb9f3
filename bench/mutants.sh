#!/usr/bin/env bash
# What the quick tests see: every edit of bench/mutants/ plants one fault into a copy of the
# tree, is built there, and is given to the tests that it names, one by one until one fails;
# what they let pass is given to all others. Prints a line a mutant, writes
# results/mutants/table.csv and table.md. Ends with 1 if a mutant survives, or cannot be
# planted or built.
#
#   MUTANTS="03 40"   some of them only; the table is then printed and not written
#   BASELINE=no       does not see first that the unchanged copy passes the named tests
#   EXPECTED=no       goes to all tests at once; EXPECTED=only stops after the named ones
#
# bench/mutants.sh --check only looks whether every edit can still be planted.
#
# How sure a test is, is read from its lines that hold "(N sigmas)" (38: more than doubles
# can tell); what tests of exact statements see has none.
set -u
cd "$(dirname "$0")/.." || exit 1

edits=(bench/mutants/*.edit)
if [ "${1:-}" = --check ]; then
    failed=0
    for edit in "${edits[@]}"; do
        awk -v root=. -v check=1 -f bench/mutants/apply.awk "$edit" || failed=1
    done
    exit $failed
fi
scratch=build/mutants tree=build/mutants/tree out=results/mutants
TEST_TIMEOUT=${TEST_TIMEOUT:-600}
TIMEFORMAT='%U %S'

# The tree with its objects, so that a mutant costs what it changes. Scenes that tests look
# for beside the repository lie beside the copy too.
copy_tree() {
    mkdir -p "$scratch"
    rm -rf "$tree"
    mkdir -p "$tree/build"
    tar --exclude=./build --exclude=./results --exclude=./.git -cf - . | tar -xf - -C "$tree"
    mkdir -p "$tree/results"
    cp -a "build/release" "$tree/build/release"
    [ -e ../shared ] && ln -sfn "$(realpath ../shared)" "$scratch/shared"
}

# build NAME...: tests as the list names them: room/test_x, cli/x.sh
build() {
    local goals=() name
    for name; do
        [ "${name%.sh}" = "$name" ] && goals+=("build/release/tests/$name") || goals+=(all)
    done
    make -s -C "$tree" VARIANT=release CI= "${goals[@]}" >"$scratch/build.log" 2>&1
}

# run_test NAME: status in $status, CPU seconds added to $cpu, output in $scratch/out
run_test() {
    local program=build/release/tests/$1 used
    [ "${1%.sh}" = "$1" ] || program=tests/$1
    rm -rf "$scratch/tmp" "$scratch/status"
    mkdir -p "$scratch/tmp"
    used=$({ time (
        cd "$tree" || exit 1
        TEST_TMP=$(realpath ../tmp) ETALON=$PWD/build/release/etalon \
            timeout -k 5 "$TEST_TIMEOUT" "$program" >../out 2>&1 </dev/null
        echo $? >../status
    ); } 2>&1)
    status=$(cat "$scratch/status" 2>/dev/null)
    used=${used##*$'\n'} # what the shell says of a crash stands before it
    cpu=$(awk "BEGIN { split(\"$used\", u, \" \"); printf \"%.1f\", $cpu + u[1] + u[2] }")
}

# Runs tests until one fails: its name in $killer, how sure it is in $sigmas.
hunt() {
    local name
    for name; do
        case " $tried " in *" $name "*) continue ;; esac
        tried+=" $name"
        build "$name" || { killer=error; return; }
        run_test "$name"
        [ "$status" = 0 ] || [ "$status" = 77 ] && continue
        case ${status:-143} in
        137 | 143) # not the test's own doing
            echo "$name was killed from outside" >"$scratch/build.log"
            killer=error
            return
            ;;
        esac
        killer=$name
        [ "$status" != 124 ] || killer+=" (does not end)"
        sigmas=$(grep -o '([0-9.]* sigmas)' "$scratch/out" | tr -d '(' | sort -g | tail -n 1 |
            cut -d ' ' -f 1)
        return
    done
}

field() { # field KEY EDIT
    sed -n "s/^$1: *//p" "$2"
}

# All tests, the quick ones first.
all_tests() {
    (cd tests && ls unit/test_*.c num/test_*.c stat/test_*.c | sed 's/\.c$//' &&
        ls cli/*.sh | grep -v lib)
}

baseline() {
    local name failed=0
    for name in $(for edit in "${chosen[@]}"; do field expects "$edit"; done | tr ' ' '\n' | sort -u); do
        build "$name" && run_test "$name" && [ "$status" = 0 ] && continue
        echo "error: $name fails without a mutant (status $status)" >&2
        failed=1
    done
    return $failed
}

# Plants, hunts, and puts the files back, newer than what was built of them.
one() {
    local edit=$1 files file
    files=$(field file "$edit")
    killer= sigmas= tried= cpu=0
    if ! awk -v root="$tree" -f bench/mutants/apply.awk "$edit"; then
        killer=error
    else
        [ "${EXPECTED:-yes}" = no ] || hunt $(field expects "$edit")
        [ -n "$killer" ] || [ "${EXPECTED:-yes}" = only ] || hunt $(all_tests)
        [ "$killer" != error ] || sed 's/^/    | /' "$scratch/build.log" >&2
    fi
    for file in $files; do
        cp "$file" "$tree/$file"
    done
    printf '%s,"%s",%s,%s,%s\n' "$(basename "$edit" .edit)" "$(field breaks "$edit")" \
        "${killer:-survives}" "$sigmas" "$cpu"
}

# The table of a CSV of lines as `one` prints them.
markdown() {
    printf '# Mutants: what the quick tests see\n\n%s\n\n' "$2"
    echo "| mutant | what is wrong | killed by | sigmas | CPU s |"
    echo "|---|---|---|---|---|"
    sed '1d; s/^\([^,]*\),"\(.*\)",\([^,]*\),\([^,]*\),\([^,]*\)$/| \1 | \2 | \3 | \4 | \5 |/' "$1"
}

chosen=()
for edit in "${edits[@]}"; do
    number=$(basename "$edit" | cut -d - -f 1)
    case " ${MUTANTS:-$number} " in *" $number "*) chosen+=("$edit") ;; esac
done
copy_tree
cpu=0
if [ "${BASELINE:-yes}" = yes ]; then
    baseline || exit 1
fi
rows=$scratch/rows.csv
echo "mutant,breaks,killed_by,sigmas,cpu_s" >"$rows"
for edit in "${chosen[@]}"; do
    one "$edit" | tee -a "$rows"
done
killed=$(grep -cvE ',(survives|error),|^mutant,' "$rows")
errors=$(grep -cE ',error,' "$rows")
line="$killed killed of ${#chosen[@]} planted, $((${#chosen[@]} - killed - errors)) survive"
[ "$errors" = 0 ] || line+=", $errors could not be planted or built"
echo "$line"
if [ -z "${MUTANTS:-}" ]; then
    mkdir -p "$out"
    cp "$rows" "$out/table.csv"
    markdown "$rows" "$line." >"$out/table.md"
    echo "$out/table.md, $out/table.csv"
fi
[ "$killed" = ${#chosen[@]} ]
