#!/usr/bin/env bash
# `etalon info --check` by its exit status and its list; and what is told where loading
# fails: notes until then, and all errors at once.
set -u
. "$(dirname "$0")/lib.bash"

scene() { # scene BODY
    printf '<scene version="3.0.0">\n<sensor type="perspective"><film type="hdrfilm">%s\n' \
        '<rfilter type="gaussian"/></film></sensor>' >scene.xml
    printf '<emitter type="constant"/>\n%s\n</scene>\n' "$1" >>scene.xml
}
info() { # info STATUS ARGS...
    local wanted=$1
    shift
    "$etalon" info scene.xml "$@" >out 2>err
    [ $? -eq "$wanted" ]
}

scene '<shape type="sphere"/>'
check "all is read" info 0 --check
check "which is said" [ "$(cat out)" = "nothing is left out" ]
check "a filter is no part of the scene" [ ! -s err ]
check "as JSON" info 0 --check --json
check "complete" grep -q '"complete": true' out

scene '<shape type="hair"/><shape type="hair"/><shape type="sphere"/>'
check "something is left out" info 4 --check
check "the list" [ "$(cat out)" = \
    'warning: scene.xml:4:1: shape "hair" is not read yet and left out (2 times)' ]
check "as JSON, too" info 4 --check --json
check "not complete" grep -q '"complete": false' out
check "without --check that is no failure" info 0

scene '<shape type="hair"/>
<shape type="sphere"><float name="radius" value="-1"/></shape>
<shape type="sphere"><ref id="a"/></shape><shape type="sphere"><ref id="a"/></shape>
<shape type="sphere"><float name="radius" value="-2"/></shape>'
check "what is wrong" info 1
check "all of it, after the notes" diff err - <<END
warning: scene.xml:2:49: the filter "gaussian" is not used: reconstruction is a box of one pixel, always
warning: scene.xml:4:1: shape "hair" is not read yet and left out
etalon: error: scene.xml:5:1: the radius -1 is not positive
etalon: error: scene.xml:6:22: unknown id "a" (known: none)
etalon: error: scene.xml:6:64: unknown id "a" (known: none)
etalon: error: scene.xml:7:1: the radius -2 is not positive
END

wrong='<shape type="sphere"><float name="radius" value="-1"/></shape>'
scene "$(for ((i = 0; i < 30; i++)); do echo "$wrong"; done)"
check "far too much is wrong" info 1
check "ten of it" [ "$(grep -c '^etalon: error' err)" = 10 ]
finish
