# Sourced by the tests of the command line: the program, a folder of their own, verdicts.
# Not executable on its own.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
etalon=${ETALON:-$root/build/${VARIANT:-release}/etalon}
if [ ! -x "$etalon" ]; then
    echo "no program $etalon"
    exit 77
fi

tmp=$(mktemp -d "${TEST_TMP:-${TMPDIR:-/tmp}}/etalon-cli.XXXXXX") || exit 1
trap 'rm -rf "$tmp"' EXIT
cd "$tmp" || exit 1

. "$root/bench/lib.bash" # value and the like

failures=0

# check WHAT COMMAND...: one line a check.
check() {
    local what=$1
    shift
    if "$@"; then
        echo "ok    $what"
    else
        echo "FAIL  $what: $*"
        failures=$((failures + 1))
    fi
}

finish() {
    echo "$failures failed"
    [ "$failures" -eq 0 ]
    exit
}

# A box with a lamp, a matt block and a glass ball: every kind of path, in milliseconds.
# The radiance of the lamp is $1 (default 8).
write_scene() {
    cat <<END
camera: {position: [0, 1, 1.9], target: [0, 1, 0], fov: 56}
film: {width: 32, height: 24}
max_depth: 6
materials:
  wall: {type: diffuse, reflectance: [0.7, 0.6, 0.5]}
  glass: {type: dielectric, eta: 1.5}
  lamp: {type: black}
shapes:
  - type: box
    material: wall
    reverse: true
    transform:
      - scale: [1, 1, 2]
      - translate: [0, 1, 0]
  - type: sphere
    material: glass
    radius: 0.35
    transform:
      - translate: [0.4, 0.36, 0.2]
  - type: box
    material: wall
    transform:
      - scale: [0.25, 0.4, 0.25]
      - translate: [-0.45, 0.41, -0.2]
  - type: rectangle
    material: lamp
    emission: ${1:-8}
    transform:
      - scale: [0.3, 0.3, 1]
      - rotate: {axis: [1, 0, 0], degrees: 90}
      - translate: [0, 1.98, 0]
END
}
