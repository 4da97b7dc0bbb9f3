#!/usr/bin/env bash
# Wrong input: the exit status, exactly one line "etalon: error: ..." that names the place,
# and no file left behind.
set -u
. "$(dirname "$0")/lib.bash"
mkdir in out

# refuse WHAT STATUS REGEX ARGS...: run in an empty folder that must stay empty.
refuse() {
    local what=$1 status=$2 regex=$3 got errors left
    shift 3
    local begin=$SECONDS
    (cd out && "$etalon" "$@" >../stdout 2>../stderr)
    got=$?
    check "$what: before any work" [ $((SECONDS - begin)) -le 20 ]
    errors=$(grep -c '^etalon: error: ' stderr)
    left=$(ls -A out)
    check "$what: status $status" [ "$got" -eq "$status" ]
    check "$what: one line" [ "$errors/$(wc -l <stderr)" = "1/1" ]
    check "$what: says what and where" grep -qE -- "^etalon: error: $regex" stderr
    check "$what: nothing on standard output" [ ! -s stdout ]
    check "$what: no file left" [ -z "$left" ]
    rm -rf out && mkdir out
}

scene() { # scene NAME SED: the good scene, changed
    write_scene | sed "$2" >"in/$1"
}

write_scene >in/good.yaml
"$etalon" render in/good.yaml -i pt --spp 1 -o in/good.exr >/dev/null || failures=1
"$etalon" render in/good.yaml -i pt --spp 1 --size 20x20 -o in/small.exr >/dev/null ||
    failures=1
# What is told only after a minute of rendering is told too late.
good="../in/good.yaml --seconds 60 -o x.exr"

# --- the command line --------------------------------------------------------------------
refuse "unknown option" 2 "unknown option '--secnds' \(did you mean '--seconds'" \
    render $good --secnds 3
refuse "unknown setting" 2 "unknown setting 'fo'.*settings are: integrator" \
    render $good --set fo=1
refuse "--set without =" 2 "--set wants KEY=VALUE" render $good --set seed
refuse "p_l above 1" 2 "large_step_probability: '2'.*\(0,1\]" render $good --large-step 2
refuse "p_l of 0" 2 "large_step_probability: 0 .*allow_zero" render $good --large-step 0
refuse "p_l not a number" 2 "large_step_probability: 'nan'" render $good --large-step nan
refuse "negative budget" 2 "seconds: '-1'" render $good --seconds -1
refuse "no budget" 2 "mutations_per_pixel: '0'" render $good --mpp 0
refuse "bad size" 2 "size: '0x5'" render $good --size 0x5
refuse "a size beyond all" 2 "size: '1000000x1000000'.*\[1,65536\]" \
    render $good --size 1000000x1000000
refuse "a film beyond all" 1 "../in/good.yaml:[0-9]+:[0-9]+: the film of 65536 x 65536 pixels is" \
    render $good --size 65536x65536
refuse "bad depth" 2 "max_depth: '65'" render $good --max-depth 65
refuse "unknown integrator" 2 "integrator: 'psmlt'.*pssmlt" render $good -i psmlt
refuse "s1 above s2" 2 "s1 .*less than s2" render $good --set s1=0.5
refuse "exact over a kernel without density" 2 "pfmlt in mode exact .*kernel=gaussian" \
    render $good -i pfmlt --set mode=exact --set kernel=exponential
refuse "exact by default too" 2 "pfmlt in mode exact .*kernel=gaussian, not exponential" \
    render $good -i pfmlt --set kernel=exponential
refuse "weights in mode paper" 2 "pfmlt in mode paper .*estimator=plain, not kelemen" \
    render $good -i pfmlt --set mode=paper --set estimator=kelemen
refuse "unknown mode" 2 "mode: 'wrong'.*exact, counted or paper" \
    render $good -i pfmlt --set mode=wrong
refuse "unknown per" 2 "per: 'wrong'.*all or length" render $good -i mmlt --set per=wrong
refuse "unknown allocation" 2 "allocation: 'wrong'.*error or brightness" \
    render $good -i mmlt --set allocation=wrong
refuse "unknown direct" 2 "direct: 'wrong'.*separate or joint" \
    render $good -i mmlt --set direct=wrong
refuse "no -o" 2 "render needs -o" render ../in/good.yaml
refuse "picture of another kind" 2 ".*ends in .exr" \
    render ../in/good.yaml --seconds 60 -o x.png
refuse "--errors alone" 2 "--errors needs.*--reference" render $good --errors e.csv
refuse "startup of pt" 2 "pt has no large steps" startup ../in/good.yaml -i pt
refuse "mean of compare" 2 "--mean 'm.png'" compare ../in/good.exr ../in/good.exr --mean m.png
refuse "range of compare" 2 "--range" compare ../in/good.exr ../in/good.exr --range -1

# --- outputs and references, before any work ---------------------------------------------
refuse "no output folder" 1 "cannot write 'no/x.exr': there is no such folder" \
    render ../in/good.yaml --seconds 60 -o no/x.exr
refuse "output in /proc" 1 "cannot write '/proc/x.exr'" \
    render ../in/good.yaml --seconds 60 -o /proc/x.exr
refuse "output is a folder" 1 "cannot write '../in': it is a directory" \
    render $good --stats ../in
refuse "no folder for statistics" 1 "cannot write 'no/s.yaml'" \
    render $good --stats no/s.yaml
refuse "no folder for errors" 1 "cannot write 'no/e.csv'" \
    render $good --reference ../in/good.exr --errors no/e.csv
refuse "missing reference" 1 ".*no.exr" \
    render $good --reference ../in/no.exr --errors e.csv
refuse "reference is no picture" 1 ".*good.yaml.*no OpenEXR" \
    render $good --reference ../in/good.yaml --errors e.csv
refuse "reference of another size" 1 ".*small.exr: .*20x20.*32x24" \
    render $good --reference ../in/small.exr --errors e.csv
refuse "a factor" 2 "--reduce" compare ../in/good.exr ../in/small.exr --reduce 1.5
refuse "a factor that does not divide" 2 "--reduce 7" compare ../in/good.exr ../in/small.exr --reduce 7
refuse "pictures of two sizes" 1 ".*20.*" compare ../in/good.exr ../in/small.exr -o d.png

# --- scene files -------------------------------------------------------------------------
refuse "missing scene" 1 "cannot open '../in/no.yaml'" render ../in/no.yaml -o x.exr
refuse "unknown kind of scene" 1 "../in/good.exr: .*\.pbrt" render ../in/good.exr -o x.exr
mkdir in/folder.yaml
refuse "folder as scene" 1 ".*folder.yaml.*directory" render ../in/folder.yaml -o x.exr
for command in "render -o x.exr" startup info; do
    scene key.yaml 's/^film/flim/'
    refuse "$command, unknown key" 1 "../in/key.yaml:2:1: .*flim.*film" \
        $command ../in/key.yaml
done
scene value.yaml 's/eta: 1.5/eta: [1, 2, 3, 4]/'
refuse "value of another type" 1 "../in/value.yaml:6:[0-9]+: " \
    render ../in/value.yaml -o x.exr
scene nan.yaml 's/eta: 1.5/eta: .nan/'
refuse "NaN in a material" 1 "../in/nan.yaml:6:[0-9]+: " render ../in/nan.yaml -o x.exr
scene material.yaml 's/type: dielectric/type: dielektric/'
refuse "unknown type of material" 1 "../in/material.yaml:6:[0-9]+: .*dielectric" \
    render ../in/material.yaml -o x.exr
scene name.yaml 's/material: glass/material: glas/'
refuse "unknown material" 1 "../in/name.yaml:16:[0-9]+: .*glas" \
    render ../in/name.yaml -o x.exr
scene twice.yaml 's/^max_depth: 6/max_depth: 6\nmax_depth: 7/'
refuse "a key twice" 1 "../in/twice.yaml:4:1: " render ../in/twice.yaml -o x.exr
scene setting.yaml 's/^max_depth: 6/max_depth: 6\nsettings:\n  sed: 1/'
refuse "unknown setting in a file" 2 "../in/setting.yaml:5:3: unknown setting 'sed'.*seed" \
    render ../in/setting.yaml -o x.exr
scene setting.yaml 's/^max_depth: 6/max_depth: 6\nsettings:\n  chains: -5/'
refuse "bad setting in a file" 2 "../in/setting.yaml:5:[0-9]+: chains: '-5'" \
    render ../in/setting.yaml -o x.exr
scene syntax.yaml 's/^film: {/film: {{/'
refuse "not YAML" 1 "../in/syntax.yaml:[0-9]+:[0-9]+: " render ../in/syntax.yaml -o x.exr
scene dark.yaml '/emission/d'
refuse "no emitter" 1 "../in/dark.yaml: no emitter" render ../in/dark.yaml -o x.exr

# --- meshes ------------------------------------------------------------------------------
ply() { # ply NAME VERTICES LAST: one triangle, ascii
    printf '%s\n' ply 'format ascii 1.0' "element vertex $2" 'property float x' \
        'property float y' 'property float z' 'element face 1' \
        'property list uchar int vertex_indices' end_header \
        '0 0 0' '1 0 0' "$3" '3 0 1 2' >"in/$1"
    write_scene | sed "s/^shapes:/shapes:\n  - {type: mesh, material: wall, file: $1}/" \
        >"in/${1%.ply}_mesh.yaml"
}
ply good.ply 3 '0 1 0'
check "a good mesh is read" "$etalon" info in/good_mesh.yaml >/dev/null
ply nan.ply 3 '0 nan 0'
refuse "NaN in a mesh" 1 "../in/nan.ply:12:3: .*number, got 'nan'" render ../in/nan_mesh.yaml -o x.exr
ply short.ply 300 '0 1 0'
refuse "truncated PLY" 1 "../in/short.ply" render ../in/short_mesh.yaml -o x.exr
ply huge.ply 2000000000 '0 1 0'
refuse "PLY that claims too much" 1 "../in/huge.ply" render ../in/huge_mesh.yaml -o x.exr
rm in/good.ply
refuse "missing mesh" 1 "../in/good_mesh.yaml:9:[0-9]+: .*good.ply" \
    render ../in/good_mesh.yaml -o x.exr

# --- pbrt --------------------------------------------------------------------------------
pbrt() { # pbrt LINE: what stands on the third line
    printf '%s\n' 'LookAt 0 0 5  0 0 0  0 1 0' 'Camera "perspective" "float fov" [40]' \
        "$1" 'WorldBegin' 'LightSource "point" "rgb I" [1 1 1]' \
        'Shape "sphere" "float radius" [1]' 'WorldEnd' >in/scene.pbrt
}
pbrt ''
check "a good pbrt scene is read" "$etalon" info in/scene.pbrt >/dev/null
pbrt '  Rotat 90 0 0 1'
refuse "unknown directive" 1 "../in/scene.pbrt:3:3: .*Rotat" render ../in/scene.pbrt -o x.exr
pbrt 'Rotate 90 0 zero 1'
refuse "word for a number" 1 "../in/scene.pbrt:3:13: " render ../in/scene.pbrt -o x.exr
pbrt 'Include "no.pbrt"'
refuse "missing include" 1 "../in/scene.pbrt:3:[0-9]+: .*no.pbrt" \
    render ../in/scene.pbrt -o x.exr
for i in $(seq 40); do
    echo "Include \"deep$((i + 1)).pbrt\"" >"in/deep$i.pbrt"
done
pbrt 'Include "deep1.pbrt"'
refuse "40 files deep" 1 ".*deep31.pbrt:1:9: more than 32 files include one another" \
    render ../in/scene.pbrt -o x.exr
pbrt 'Include "scene.pbrt"'
refuse "a file that includes itself" 1 "../in/scene.pbrt:3:9: .*includes itself" \
    render ../in/scene.pbrt -o x.exr

# --- files that are no files: folders, and links that lead round in a circle --------------
world() { # world LINE: what stands on the fourth line, after WorldBegin
    pbrt 'WorldBegin'
    sed -i "4s|.*|$1|" in/scene.pbrt
}
circle="Too many levels of symbolic links"
for ending in png exr ply pbrt spd; do
    mkdir "in/folder.$ending"
    ln -s "to.$ending" "in/from.$ending"
    ln -s "from.$ending" "in/to.$ending"
done
no_file() { # no_file WHAT ENDING LINE: LINE names a file NAME
    world "${3//NAME/folder.$2}"
    refuse "a folder as $1" 1 \
        "../in/scene.pbrt:4:[0-9]+: .*'../in/folder.$2': not a regular file but a directory" \
        render ../in/scene.pbrt -o x.exr
    world "${3//NAME/from.$2}"
    refuse "a circle of links as $1" 1 \
        "../in/scene.pbrt:4:[0-9]+: cannot open '../in/from.$2': $circle" \
        render ../in/scene.pbrt -o x.exr
}
no_file texture png 'Texture "t" "spectrum" "imagemap" "string filename" "NAME"'
no_file environment exr 'LightSource "infinite" "string mapname" "NAME"'
no_file mesh ply 'Shape "plymesh" "string filename" "NAME"'
no_file include pbrt 'Include "NAME"'
no_file spectrum spd 'Material "metal" "spectrum eta" "NAME"'
refuse "a circle of links as scene" 1 "cannot open '../in/from.pbrt': $circle" \
    render ../in/from.pbrt -o x.exr

# --- a kilobyte that claims a hundred million vertices ------------------------------------
for format in ascii binary_little_endian binary_big_endian; do
    { printf '%s\n' ply "format $format 1.0" 'element vertex 100000000' \
        'property float x' 'property float y' 'property float z' 'element face 1' \
        'property list uchar int vertex_indices' end_header
    printf '%900s' ''; } >in/claims.ply
    world 'Shape "plymesh" "string filename" "claims.ply"'
    refuse "PLY, $format" 1 "../in/claims.ply:3:16: .*promises 100000000 rows .* only 900 bytes" \
        render ../in/scene.pbrt -o x.exr
    gzip -c in/claims.ply >in/claims.ply.gz
    world 'Shape "plymesh" "string filename" "claims.ply.gz"'
    refuse "the same, packed" 1 "../in/claims.ply.gz:3:16: .*promises 100000000 rows" \
        render ../in/scene.pbrt -o x.exr
done
mitsuba() { # mitsuba LINE: what stands on the third line
    printf '%s\n' '<scene version="3.0.0">' '<sensor type="perspective"/>' "$1" \
        '<emitter type="constant"/>' '</scene>' >in/scene.xml
}
{ printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'f 1 2 100000000'; } >in/claims.obj
mitsuba '<shape type="obj"><string name="filename" value="claims.obj"/></shape>'
refuse "OBJ" 1 "../in/claims.obj:4:7: no vertex" render ../in/scene.xml -o x.exr
# Version 4: one mesh in single precision, named m, of 1e8 vertices and a triangle.
serialized='\x1c\x04\x04\x00\x78\xda\x63\x10\x60\x60\xc8\x65\x60\x78\xf8\x95\x95\x01'\
'\x08\x18\x19\x46\xc1\x28\x18\x05\x83\x01\x00\x00\x68\xce\x02\x5a\x00\x00'\
'\x00\x00\x00\x00\x00\x00\x01\x00\x00\x00'
printf "$serialized" >in/claims.serialized
mitsuba '<shape type="serialized"><string name="filename" value="claims.serialized"/></shape>'
refuse "Mitsuba's .serialized" 1 "../in/claims.serialized: .*claims more vertices" \
    render ../in/scene.xml -o x.exr
mitsuba '<include filename="scene.xml"/>'
refuse "a Mitsuba file that includes itself" 1 "../in/scene.xml:3:1: .*includes itself" \
    render ../in/scene.xml -o x.exr

# --- cameras -----------------------------------------------------------------------------
echo '<scene version="3.0.0"><emitter type="constant"/></scene>' >in/scene.xml
refuse "no camera" 1 "../in/scene.xml: the scene has no camera" \
    render ../in/scene.xml -o x.exr
pbrt 'Scale 1 2 1 Camera "perspective"'
refuse "a sheared camera" 1 "../in/scene.pbrt:3:20: the camera's transform" \
    render ../in/scene.pbrt -o x.exr
finish
