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
check "which is said" grep -qx 'etalon: the first 10 errors; there may be more:' err

# The other formats; what only follows from an error is not told.
wrong() { # wrong WHAT FILE: of the lines of standard input
    sed 's/^E /etalon: error: /; s/^W /warning: /; s/^M/etalon: the first 10 errors; there may be more:/' >expected
    "$etalon" info "$2" >out 2>err
    check "$1" [ $? -eq 1 ]
    check "$1, all of it" diff err expected
}
cat >scene.pbrt <<'END'
Camera "perspective" "float fov" 200
CoordSysTransform "camera"
PixelFilter "gaussian"
WorldBegin
MakeNamedMaterial "a" "string type" "mat"
Texture "t" "spectrum" "imagemap"
Translate 1e39 0 0
NamedMaterial "a"
Material "matte" "texture Kd" "t"
Matrial "matte" "bool x" [true] "rgb Kd" [1 0 0]
Shape "sphere" "float radius" [-1]
Shape "plymesh" "string filename" "none.ply"
Shape "sphere" "texture alpha" "u"
ObjectInstance "o"
Shape "sphere" "flot radius" 1
AttributeEnd
Shape "spere"
END
wrong "pbrt" scene.pbrt <<'END'
W scene.pbrt:3:13: the filter "gaussian" is not used: reconstruction is a box of one pixel, always
M
E scene.pbrt:1:8: fov 200 is not between 0 and 180 degrees
E scene.pbrt:5:23: unknown material "mat"; did you mean "matte"?
E scene.pbrt:6:1: Texture "imagemap" wants "string filename"
E scene.pbrt:7:11: number beyond the range of float (3.4028235e+38)
E scene.pbrt:10:1: unknown directive "Matrial"; did you mean "Material"?
E scene.pbrt:11:1: the radius is not positive
E scene.pbrt:12:17: cannot open 'none.ply': No such file or directory
E scene.pbrt:13:16: unknown texture "u" (known: t)
E scene.pbrt:14:16: unknown object "o" (known: none)
E scene.pbrt:15:16: unknown parameter type "flot"; did you mean "float"?
END
printf '%s\n' 'Include "none.pbrt"' 'Include "neither.pbrt"' WorldBegin \
    'ObjectInstance "o" CoordSysTransform "s"' 'Shape "sphere" "float radius" 0' \
    'Import "bad.pbrt" AttributeEnd' >scene.pbrt
printf '%s\n' 'Shape "disk" "float radius" 0' 'Translate 1 2' 'Shape "spere"' >bad.pbrt
wrong "files" scene.pbrt <<'END'
E scene.pbrt:1:9: cannot open 'none.pbrt': No such file or directory
E scene.pbrt:2:9: cannot open 'neither.pbrt': No such file or directory
E scene.pbrt:5:1: the radius is not positive
E bad.pbrt:1:1: the radius is not positive
END
printf '%s\n' 'Translate 1 2 3 4x' 'Camera "perspective" "float fov" [1.5.5 2y]' \
    'WorldBegin Shape "disk" "float radius" [0 1e39 1e39]' 'Shape "spere"' >scene.pbrt
wrong "numbers that are none" scene.pbrt <<'END'
E scene.pbrt:1:17: "4x" is not a number
E scene.pbrt:2:35: "1.5.5" is not a number
E scene.pbrt:3:43: number beyond the range of float (3.4028235e+38)
E scene.pbrt:4:7: unknown shape "spere"; did you mean "sphere"?
END
cat >scene.yaml <<'END'
camera: {position: [0, 0, 5], target: [0, 0, 0], fov: 200}
film: {width: 0, height: 2}
max_depth: 0
materials:
  a: {type: diffus}
  b: {type: diffuse, reflectance: 2}
  c: {type: diffuse}
objects:
  o: {shapes: [{type: sphere, material: a, radius: -1}, {type: spere}], instances: 3}
  p: {instances: [{object: q}]}
shapes:
- {type: sphere, material: a}
- {type: sphere, material: d}
- {type: sphere, material: c, radius: -1}
instances: [{object: o}, {object: q, transform: {scale: 0}}, {object: p, transform: {scale: 0}}]
END
wrong "yaml" scene.yaml <<'END'
M
E scene.yaml:1:9: fov 200 is not between 0 and 180 degrees
E scene.yaml:2:15: width must lie between 1 and 65536, not 0
E scene.yaml:3:12: max_depth must lie between 1 and 100000, not 0
E scene.yaml:5:13: unknown type of material "diffus"; did you mean "diffuse"?
E scene.yaml:6:35: diffuse: reflectance = 2 must be from 0 to 1
E scene.yaml:9:64: unknown type of shape "spere"; did you mean "sphere"?
E scene.yaml:9:84: instances wants a list
E scene.yaml:10:28: unknown object "q" (known: o, p)
E scene.yaml:13:28: unknown material "d" (known: a, b, c)
E scene.yaml:14:3: the radius -1 is not positive
END
finish
