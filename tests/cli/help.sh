#!/usr/bin/env bash
# Every command has --help on standard output with status 0; wrong ones are told with the
# nearest name.
set -u
. "$(dirname "$0")/lib.bash"

says() { # says REGEX ARGS...: status 0, on standard output, nothing on stderr
    local regex=$1
    shift
    "$etalon" "$@" >out 2>err && grep -qE -- "$regex" out && [ ! -s err ]
}

fails_with() { # fails_with STATUS REGEX ARGS...
    local status=$1 regex=$2
    shift 2
    "$etalon" "$@" >out 2>err
    [ $? -eq "$status" ] && [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ] &&
        grep -qE -- "$regex" err
}

check "etalon --help" says '^usage: etalon COMMAND' --help
check "etalon -h" says '^usage: etalon COMMAND' -h
check "etalon --version" says '^etalon [0-9a-z]' --version

commands=$("$etalon" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
check "the commands are listed" [ "$(echo $commands)" = "render startup info bench compare report regress merge" ]
for command in $commands; do
    check "$command --help" says "^usage: etalon $command " "$command" --help
    check "$command --help shows --help" grep -q -- '--help' out
    check "$command --help fits 90 columns" awk 'length > 90 { exit 1 }' out
    check "$command, help wins over nonsense" says '^usage' "$command" --zzz -h
    check "$command, unknown option" fails_with 2 "unknown option '--zzzzz'" "$command" \
        --zzzzz
    check "$command without operands" fails_with 2 "usage: etalon $command" "$command"
done

# Every setting that an unknown key is told of is in the help of render.
"$etalon" render x.yaml -o x.exr --set zzzzzzzzz=1 2>err
settings=$(sed 's/.*settings are: //; s/,//g' err)
check "settings are listed on a slip" [ "$(echo "$settings" | wc -w)" -ge 20 ]
"$etalon" render --help >out
for setting in $settings; do
    check "render --help has $setting" grep -qE "^  $setting " out
    check "docs/settings.md has $setting" grep -q "^| \`$setting\` |" "$root/docs/settings.md"
done
for file in "$root"/config/*.yaml; do
    check "docs/experiments.md has $(basename "$file")" \
        grep -qF "\`$(basename "$file")\`" "$root/docs/experiments.md"
done

check "no command" fails_with 2 "no command"
check "nearest command" fails_with 2 "did you mean 'render'" rendr
check "nearest option" fails_with 2 "did you mean '--seconds'" render a --secnds 3
check "missing value" fails_with 2 "--seed needs a value" render a -o b.exr --seed
if [ -w /dev/full ]; then
    "$etalon" --help >/dev/full 2>err
    check "a full standard output is an error" [ $? -eq 1 ]
fi
finish
