# Meshes of every format, through a scene that names them.
ply() { # ply FORMAT VERTICES [LINE...]: the header of a triangle mesh, then LINEs
    printf '%s\n' ply "format $1 1.0" "element vertex $2" 'property float x' \
        'property float y' 'property float z' 'element face 1' \
        'property list uchar int vertex_indices' end_header "${@:3}"
}
meshed() { # meshed FILE: in/scene.yaml, with that mesh
    sed "s/^shapes:/&\n  - {type: mesh, material: wall, file: $1}/" in/good.yaml >in/scene.yaml
}
mesh() { # mesh WHAT FILE WORDS: in/FILE, which exists or not
    if [[ $2 == *.ply ]]; then
        meshed "$2"
        refuse "$1" 1 "$3" render ../in/scene.yaml --seconds 60 -o x.exr
    elif [[ $2 == *.ply.gz ]]; then
        pbrt_world "Shape \"plymesh\" \"string filename\" \"$2\""
        refuse "$1" 1 "$3" render ../in/scene.pbrt --seconds 60 -o x.exr
    else
        mitsuba "<shape type=\"${2##*.}\"><string name=\"filename\" value=\"$2\"/></shape>"
        refuse "$1" 1 "$3" render ../in/scene.xml --seconds 60 -o x.exr
    fi
}
triangle() { # triangle WHAT WORDS [V3 FACE]: an ascii triangle with that last vertex and face
    ply ascii 3 '0 0 0' '1 0 0' "${3:-0 1 0}" "${4:-3 0 1 2}" >in/mesh.ply
    mesh "$1" mesh.ply "$2"
}
kind=".ply"
mesh "missing file" no.ply '../in/scene.yaml:9:40: cannot open ?../in/no.ply?: No such file or directory'
mesh "a folder" folder.ply '../in/scene.yaml:9:40: cannot read ?../in/folder.ply?: not a regular file but a directory'
mesh "a circle of links" from.ply '../in/scene.yaml:9:40: cannot open ?../in/from.ply?: Too many levels of symbolic links'
: >in/mesh.ply && mesh "empty file" mesh.ply '../in/mesh.ply: not a PLY file: it does not begin with "ply"'
cp in/garbage in/mesh.ply && mesh "binary garbage" mesh.ply '../in/mesh.ply: not a PLY file: it does not begin with "ply"'
echo ply >in/mesh.ply && mesh "the first line alone" mesh.ply '../in/mesh.ply:2: the PLY header has no end_header'
triangle "NaN" '../in/mesh.ply:12:6: a vertex is not finite in single precision' '0 nan 0'
triangle "infinity" '../in/mesh.ply:12:6: a vertex is not finite in single precision' '0 inf 0'
triangle "1e39" '../in/mesh.ply:12:7: a vertex is not finite in single precision' '0 1e39 0'
triangle "3e38" '../in/scene.yaml: the largest shape spans 3e+38 units and coordinates reach 3e+38; rays in floats' '0 3e38 0'
triangle "a word" '../in/mesh.ply:12:3: expected a finite number, got ?one?' '0 one 0'
triangle "two coordinates" '../in/mesh.ply:13:5: more data than the header promises' '0 1'
triangle "an index out of range" '../in/mesh.ply:13:8: an index or a count is out of range' '0 1 0' '3 0 1 3'
triangle "an index below 0" '../in/mesh.ply:13:9: an index or a count is out of range' '0 1 0' '3 0 1 -1'
triangle "a fraction as index" '../in/mesh.ply:13:10: an index or a count is out of range' '0 1 0' '3 0 1 1.5'
ply ascii 3 '0 0 0' '1 0 0' '0 1 0' '2 0 1' >in/mesh.ply && meshed mesh.ply
warn "a face of two" '../in/scene.yaml:9:5: face of fewer than 3 corners left out' render ../in/scene.yaml -i pt --spp 1 --size 8x6 -o y.exr
ply ascii 3 '0 0 0' '1 0 0' '0 1 0' '0' >in/mesh.ply && meshed mesh.ply
warn "a face of none" '../in/scene.yaml:9:5: face of fewer than 3 corners left out' render ../in/scene.yaml -i pt --spp 1 --size 8x6 -o y.exr
triangle "a face that claims 255" '../in/mesh.ply:14:1: the file ends before its data' '0 1 0' '255 0 1 2'
ply ascii 3 '0 0 0' '1 0 0' '2 0 0' '3 0 1 2' >in/mesh.ply && meshed mesh.ply
warn "no area" '../in/scene.yaml:9:5: degenerate triangle left out' render ../in/scene.yaml -i pt --spp 1 --size 8x6 -o y.exr
triangle "an empty line in the middle" '../in/mesh.ply:13:3: expected a finite number, got ?x?' $'\n0 x 0'
triangle "more than it says" '../in/mesh.ply:14:1: more data than the header promises' '0 1 0' $'3 0 1 2\n3 0 1 2'
ply ascii 300 '0 0 0' '1 0 0' '0 1 0' '3 0 1 2' >in/mesh.ply && mesh "fewer than it says" mesh.ply '../in/mesh.ply:3:16: the header promises 300 rows of "vertex", but only 26 bytes follow it'
ply ascii 0 >in/mesh.ply && mesh "no vertices" mesh.ply '../in/mesh.ply:7:14: the header promises 1 rows of "face", but only 0 bytes follow it'
ply ascii -3 >in/mesh.ply && mesh "-3 vertices" mesh.ply '../in/mesh.ply:3: the element?s count is not a count'
ply ascii 1e3 >in/mesh.ply && mesh "1e3 vertices" mesh.ply '../in/mesh.ply:3: the element?s count is not a count'
ply ascii 99999999999999999999 >in/mesh.ply && mesh "1e20 vertices" mesh.ply '../in/mesh.ply:3: the element?s count is not a count'
ply ascii 2000000000 '0 0 0' >in/mesh.ply && mesh "2e9 vertices" mesh.ply '../in/mesh.ply:3:16: the header promises 2000000000 rows of "vertex", but only 6 bytes follow it'
ply binary 3 >in/mesh.ply && mesh "unknown format" mesh.ply '../in/mesh.ply:2: "format ascii|binary_little_endian|binary_big_endian 1.0" wanted'
ply ascii 3 | sed 's/float y/float128 y/' >in/mesh.ply && mesh "unknown type" mesh.ply '../in/mesh.ply:5: unknown PLY type "float128"'
ply ascii 3 | sed '/float y/d' >in/mesh.ply && mesh "no y" mesh.ply '../in/mesh.ply:3:16: the header promises 3 rows of "vertex", but only 0 bytes follow it'
ply ascii 3 | sed 's/float y/float x/' >in/mesh.ply && mesh "x twice" mesh.ply '../in/mesh.ply:5: a property of this name stands above'
ply ascii 3 | sed '/end_header/d' >in/mesh.ply && mesh "no end of the header" mesh.ply '../in/mesh.ply:9: the PLY header has no end_header'
ply ascii 3 | sed 's/list uchar/list float/' >in/mesh.ply && mesh "a list counted in fractions" mesh.ply '../in/mesh.ply:8: the length of a list must be of an integer type'
ply ascii 3 '0 0 0' '1 0 0' '0 1 0' '3 0 1 2' | sed 's/$/\r/' >in/mesh.ply && meshed mesh.ply &&
    accept "CRLF" info ../in/scene.yaml
words() { # words FORMAT BYTES...: the triangle in binary, little or big endian
    local z='\0\0\0\0' one='\0\0\x80\x3f'
    [ "$1" = big ] && one='\x3f\x80\0\0'
    printf "$z$z$z$one$z$z$z$one$z"
}
for order in little big; do
    { ply binary_${order}_endian 3 && words $order && printf '\3\0\0\0\0\1\0\0\0\2\0\0\0'; } >in/whole.ply
    [ $order = big ] &&
        { ply binary_${order}_endian 3 && words $order && printf '\3\0\0\0\0\0\0\0\1\0\0\0\2'; } >in/whole.ply
    meshed whole.ply && accept "$order endian" info ../in/scene.yaml
    size=$(stat -c %s in/whole.ply)
    for cut in 1 5 13 14 40 49; do
        head -c $((size - cut)) in/whole.ply >in/mesh.ply && mesh "$order endian, $cut bytes short" mesh.ply '../in/mesh.ply:'
    done
    { cat in/whole.ply && printf 'more'; } >in/mesh.ply && mesh "$order endian, bytes too many" mesh.ply '../in/mesh.ply: more data than the header promises, before byte 21'
    { head -c $((size - 1)) in/whole.ply && printf '\x7f'; } >in/mesh.ply && mesh "$order endian, an index out of range" mesh.ply '../in/mesh.ply: an index or a count is out of range, before byte 21'
    { head -c $((size - 13)) in/whole.ply && printf '\xff\0\0\0\0\0\0\0\1\0\0\0\2'; } >in/mesh.ply && mesh "$order endian, a face of 255" mesh.ply '../in/mesh.ply: '
    { head -c $((size - 17)) in/whole.ply && printf '\xff\xff\xff\xff' && tail -c 13 in/whole.ply; } >in/mesh.ply && mesh "$order endian, NaN" mesh.ply '../in/mesh.ply: a vertex is not finite in single precision, before byte 20'
done
kind=".ply.gz"
for format in ascii binary_little_endian binary_big_endian; do
    { ply $format 100000000 && printf '%900s' ''; } >in/mesh.ply
    mesh "$format claims 1e8 vertices, unpacked" mesh.ply '../in/mesh.ply:3:16: the header promises 100000000 rows of "vertex", but only 900 bytes follow it'
    gzip -c in/mesh.ply >in/mesh.ply.gz
    mesh "$format claims 1e8 vertices" mesh.ply.gz '../in/mesh.ply.gz:3:16: the header promises 100000000 rows of "vertex", but at most * bytes follow it'
done
mesh "missing file" no.ply.gz '../in/scene.pbrt:4:17: cannot open ?../in/no.ply.gz?: No such file or directory'
: >in/mesh.ply.gz && mesh "empty file" mesh.ply.gz '../in/scene.pbrt:4:17: cannot unpack ?../in/mesh.ply.gz?: it is cut short or no gzip file'
cp in/whole.ply in/mesh.ply.gz && mesh "not packed" mesh.ply.gz '../in/scene.pbrt:4:17: cannot unpack ?../in/mesh.ply.gz?: it is cut short or no gzip file'
cp in/garbage in/mesh.ply.gz && mesh "binary garbage" mesh.ply.gz '../in/scene.pbrt:4:17: cannot unpack ?../in/mesh.ply.gz?: it is cut short or no gzip file'
gzip -c in/whole.ply >in/whole.ply.gz
for cut in 1 4 8 9 40; do
    head -c -$cut in/whole.ply.gz >in/mesh.ply.gz && mesh "$cut bytes short" mesh.ply.gz '../in/scene.pbrt:4:17: cannot unpack ?../in/mesh.ply.gz?: it is cut short or no gzip file'
done
for at in 0 2 30 $(($(stat -c %s in/whole.ply.gz) - 6)); do
    cp in/whole.ply.gz in/mesh.ply.gz && flip in/mesh.ply.gz $at && mesh "a bit of byte $at" mesh.ply.gz '../in/scene.pbrt:4:17: cannot unpack ?../in/mesh.ply.gz?: it is cut short or no gzip file'
done
head -c 30000000 /dev/zero | gzip >in/mesh.ply.gz && mesh "zeros, 1000 to one" mesh.ply.gz '../in/mesh.ply.gz: not a PLY file: it does not begin with "ply"'
kind=".obj"
obj() { # obj WHAT WORDS LINE...
    printf '%s\n' "${@:3}" >in/mesh.obj
    mesh "$1" mesh.obj "$2"
}
good_obj=('v 0 0 0' 'v 1 0 0' 'v 0 1 0')
mesh "missing file" no.obj '../in/scene.xml:3:19: cannot open ?../in/no.obj?: No such file or directory'
mesh "a folder" folder.obj '../in/scene.xml:3:19: cannot read ?../in/folder.obj?: not a regular file but a directory'
: >in/mesh.obj && mesh "empty file" mesh.obj '../in/mesh.obj:1:1: the file has no faces (f)'
cp in/garbage in/mesh.obj && mesh "binary garbage" mesh.obj '../in/mesh.obj:1:1: unknown statement "\?\?\?\?\?\?\?y\?\?uES\?)" (known: v, vt, vn, f)'
obj "no faces" '../in/mesh.obj:4:9: the file has no faces (f)' "${good_obj[@]}"
obj "an index out of range" '../in/mesh.obj:4:7: no vertex (v) of that number so far' "${good_obj[@]}" 'f 1 2 100000000'
obj "an index of 0" '../in/mesh.obj:4:3: no vertex (v) of that number so far' "${good_obj[@]}" 'f 0 1 2'
obj "an index too far back" '../in/mesh.obj:4:9: no vertex (v) of that number so far' "${good_obj[@]}" 'f -1 -2 -4'
obj "an index beyond int" '../in/mesh.obj:4:7: no vertex (v) of that number so far' "${good_obj[@]}" 'f 1 2 99999999999999999999'
printf '%s\n' "${good_obj[@]}" 'f 1 2' >in/mesh.obj
mitsuba '<shape type="obj"><string name="filename" value="mesh.obj"/></shape>'
warn "a face of two" '../in/scene.xml:*face of fewer than 3 corners left out' render ../in/scene.xml -i pt --spp 1 --size 8x6 -o y.exr
obj "a word as index" '../in/mesh.obj:4:7: expected an index' "${good_obj[@]}" 'f 1 2 x'
obj "a normal that is not there" '../in/mesh.obj:4:6: no normal (vn) of that number so far' "${good_obj[@]}" 'f 1//1 2//1 3//1'
obj "NaN" '../in/mesh.obj:1:3: expected a number' 'v nan 0 0' "${good_obj[@]}" 'f 1 2 3'
obj "infinity" '../in/mesh.obj:1:3: expected a number' 'v inf 0 0' "${good_obj[@]}" 'f 1 2 3'
obj "1e39" '../in/mesh.obj:1:3: number beyond the range of float' 'v 1e39 0 0' "${good_obj[@]}" 'f 1 2 3'
obj "two coordinates" '../in/mesh.obj:1:6: too few numbers' 'v 1 0' "${good_obj[@]}" 'f 1 2 3'
obj "unknown directive" '../in/mesh.obj:5:1: unknown statement "vq"; did you mean "v"\?' "${good_obj[@]}" 'f 1 2 3' 'vq 1 2 3'
printf '\xef\xbb\xbf' >in/mesh.obj && printf '%s\n' "${good_obj[@]}" 'f 1 2 3' | sed 's/$/\r/' >>in/mesh.obj
mitsuba '<shape type="obj"><string name="filename" value="mesh.obj"/></shape>'
accept "CRLF and a byte order mark" info ../in/scene.xml
kind=".serialized"
# Version 4: one mesh in single precision, named m, of 1e8 vertices and a triangle.
serialized='\x1c\x04\x04\x00\x78\xda\x63\x10\x60\x60\xc8\x65\x60\x78\xf8\x95\x95\x01'\
'\x08\x18\x19\x46\xc1\x28\x18\x05\x83\x01\x00\x00\x68\xce\x02\x5a\x00\x00'\
'\x00\x00\x00\x00\x00\x00\x01\x00\x00\x00'
printf "$serialized" >in/claims.serialized && mesh "claims 1e8 vertices" claims.serialized '../in/claims.serialized: truncated: the header claims more vertices and triangles than the file can'
mesh "missing file" no.serialized '../in/scene.xml:3:26: cannot open ?../in/no.serialized?: No such file or directory'
mesh "a folder" folder.serialized '../in/scene.xml:3:26: cannot read ?../in/folder.serialized?: not a regular file but a directory'
: >in/mesh.serialized && mesh "empty file" mesh.serialized '../in/mesh.serialized: this is no .serialized mesh file'
cp in/garbage in/mesh.serialized && mesh "binary garbage" mesh.serialized '../in/mesh.serialized: this is no .serialized mesh file'
for cut in 1 4 12 30; do
    head -c -$cut in/claims.serialized >in/mesh.serialized && mesh "$cut bytes short" mesh.serialized '../in/mesh.serialized: truncated: the table of meshes at the end does not fit'
done
flipped() { # flipped BYTE WORDS
    cp in/claims.serialized in/mesh.serialized && flip in/mesh.serialized "$1"
    mesh "a bit of byte $1" mesh.serialized "../in/mesh.serialized: $2"
}
flipped 0 'this is no .serialized mesh file'
flipped 2 'only the versions 3 and 4 of .serialized are read'
flipped 4 'the compressed data is corrupt'
flipped 8 'truncated: the header claims more vertices and triangles than the file can hold'
flipped 20 'the mesh is empty'
flipped 44 'truncated: the table of meshes at the end does not fit'
