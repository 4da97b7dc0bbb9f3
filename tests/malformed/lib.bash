# Sourced by tests/cli/malformed.sh: one list of malformed inputs, which the test asserts and
# `make bench-malformed` prints. A case is one call of `refuse` or `accept`; what it needs
# lies in in/, and it runs in out/, where older results lie that must stay as they are.

. "$root/tests/cli/lib.bash"
shopt -s nullglob dotglob globstar
runner=(${MALFORMED_RUNNER:-}) # before the program, such as valgrind
every=${MALFORMED_EVERY:-1}    # only each so many-th case
wait_at_most=${MALFORMED_WAIT:-60}
number=0 kind=none
: >rows
mkdir in

# What a user may have lying about from yesterday.
older() {
    rm -rf out && mkdir out
    for name in x.exr x.png x.failures.png s.yaml e.csv x.ck d.png; do
        echo "of yesterday" >out/$name
    done
    remember
}

# contents: sets state to the names and bytes of all files of out/. It starts no program,
# since each of some hundred cases needs it twice.
contents() {
    local file parts
    state=
    for file in out/**; do
        parts=()
        [ ! -f "$file" ] || mapfile -d '' parts <"$file"
        state+="$file ${#parts[@]} ${parts[*]}"$'\n'
    done
}

# remember: what lies in out/ now shall be there after the next case.
remember() {
    contents
    untouched=$state
}
older

# The watch kills a case that runs longer than $wait_at_most seconds. It reads the number of
# the process when a case begins, and an empty line when the case has ended. `timeout` would
# be one more program to start for each case.
exec {watch}> >(
    while read -r pid; do
        read -r -t "$wait_at_most" || { kill -KILL "$pid"; read -r; }
    done
)

# put FILE...: copies of files of in/ for the next case to lie among the older results.
put() {
    cp -r "${@/#/in/}" out/
    remember
}

# show ARGS...: sets shown, the command as one would type it.
show() {
    local arg
    shown=etalon
    for arg; do
        case $arg in
        '' | *[!A-Za-z0-9_./,:=@%^+-]*) arg=${arg@Q} ;;
        esac
        shown+=" $arg"
    done
}

# attempt ARGS...: runs etalon in out/; sets status, seconds, message, lines and kept.
attempt() {
    local begin=$EPOCHREALTIME now
    (cd out && echo $BASHPID >&$watch && exec {watch}>&- "${runner[@]}" "$etalon" "$@" \
        >"${stdout:-../stdout}" 2>../stderr </dev/null)
    status=$?
    echo >&$watch
    now=$EPOCHREALTIME
    seconds=$((${now/./} - ${begin/./})) # in us
    mapfile -t lines <stderr
    message=${lines[0]-}
    kept=no
    contents
    [ "$state" = "$untouched" ] && kept=yes
}

# conclude WHAT FAULT ARGS...: FAULT empty is a pass.
conclude() {
    local what=$1 fault=$2 files=$kept
    shift 2
    [ "$kept$status" = no0 ] && files=written
    show "$@"
    if [ -z "$fault" ]; then
        echo "ok    $kind: $what"
    else
        echo "FAIL  $kind: $what:$fault; $shown"
        printf '      | %s\n' "${lines[@]:0:8}"
        failures=$((failures + 1))
    fi
    printf '%s\t' "$kind" "$what" "$shown" "${message#etalon: error: }" "$status" \
        "$((seconds / 1000))" "$files" >>rows
    printf '%s\n' "${fault:-ok}" >>rows
    [ "$kept" = yes ] && [ "$untouched" = "$standard" ] || older
    : >stdout
}

chosen() {
    number=$((number + 1))
    [ $((number % every)) -eq 0 ] && return
    [ "$untouched" = "$standard" ] || older
    return 1
}

# Lines that are no warnings of what was read until then; message is their first.
errors() {
    local line
    set --
    for line in "${lines[@]}"; do
        [[ $line == "warning: "* ]] || set -- "$@" "$line"
    done
    message=${1-} count=$#
}

# refuse WHAT STATUS WORDS ARGS...: one line "etalon: error: WORDS", after warnings at most,
# the exit status, before any work, and no file written or changed.
refuse() {
    local what=$1 wanted=$2 words=$3 fault=
    shift 3
    chosen || return 0
    attempt "$@"
    errors
    [ "$status" -eq "$wanted" ] || fault+=" status $status, not $wanted;"
    [ $count -eq 1 ] || fault+=" $count errors;"
    [[ $message == "etalon: error: "$words* ]] || fault+=" other words;"
    [ -s stdout ] && fault+=" standard output;"
    [ $kept = yes ] || fault+=" files changed;"
    conclude "$what" "$fault" "$@"
}

# tell_late WHAT WORDS ARGS...: nobody could know it before; what could be delivered was.
tell_late() {
    local what=$1 words=$2 fault=
    shift 2
    chosen || return 0
    attempt "$@"
    errors
    [ "$status" -eq 1 ] || fault+=" status $status, not 1;"
    [ $count -eq 1 ] || fault+=" $count errors;"
    [[ $message == "etalon: error: "$words* ]] || fault+=" other words;"
    conclude "$what" "$fault" "$@"
}

# warn WHAT WORDS ARGS...: the work is done, and among the warnings is "warning: WORDS".
warn() {
    local what=$1 words=$2 fault=" other words;" line
    shift 2
    chosen || return 0
    attempt "$@"
    for line in "${lines[@]}"; do
        [[ $line == "warning: "$words* ]] && message=$line fault=
    done
    [ "$status" -eq 0 ] || fault+=" status $status;"
    conclude "$what" "$fault" "$@"
}

# accept WHAT ARGS...: looks malformed, and is not.
accept() {
    local what=$1 fault=
    shift
    chosen || return 0
    attempt "$@"
    [ "$status" -eq 0 ] || fault+=" status $status;"
    conclude "$what" "$fault" "$@"
}
standard=$untouched
