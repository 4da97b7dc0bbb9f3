kind=".pbrt"
before() { # before WHAT LINE WORDS
    pbrt "$2"
    in_pbrt "$1" "$3"
}
within() { # within WHAT LINE WORDS: after WorldBegin
    pbrt_world "$2"
    in_pbrt "$1" "$3"
}
told_before() { # worth a warning
    pbrt "$2"
    warn "$1" "$3" render ../in/scene.pbrt -i pt --spp 1 --size 8x6 -o y.exr
}
told_within() {
    pbrt_world "$2"
    warn "$1" "$3" render ../in/scene.pbrt -i pt --spp 1 --size 8x6 -o y.exr
}
refuse "missing file" 1 'cannot open ?../in/no.pbrt?: No such file or directory' render ../in/no.pbrt -o x.exr
refuse "a circle of links" 1 'cannot open ?../in/from.pbrt?: Too many levels of symbolic links' render ../in/from.pbrt -o x.exr
refuse "a folder" 1 'cannot read ?../in/folder.pbrt?: not a regular file but a directory' render ../in/folder.pbrt -o x.exr
: >in/scene.pbrt && in_pbrt "empty file" '../in/scene.pbrt:1:1: the file has no WorldBegin'
cp in/garbage in/scene.pbrt && in_pbrt "binary garbage" '../in/scene.pbrt:1:1: unexpected byte 0xa7'
pbrt '' && head -c 60 in/scene.pbrt >in/cut.pbrt && mv in/cut.pbrt in/scene.pbrt && in_pbrt "cut short" '../in/scene.pbrt:2:34: expected a number, got the end of the file'
pbrt 'Film "image"' && sed -i '$d' in/scene.pbrt && in_pbrt "cut before WorldEnd" '../in/scene.pbrt:7:1: the file ends before the WorldEnd of the WorldBegin in line 4'
pbrt '' && tr '\n' '\0' <in/scene.pbrt >in/nul.pbrt && mv in/nul.pbrt in/scene.pbrt && in_pbrt "NUL bytes" '../in/scene.pbrt:1:27: unexpected byte 0x00'
before "invalid UTF-8" $'Rot\xff\xfeate' '../in/scene.pbrt:3:1: unknown directive "Rot\?\?ate"; did you mean "Rotate"\?'
before "unknown directive" '  Rotat 90 0 0 1' '../in/scene.pbrt:3:3: unknown directive "Rotat"; did you mean "Rotate"\?'
before "word for a number" 'Rotate 90 0 zero 1' '../in/scene.pbrt:3:13: expected number 3 of 4, got zero'
before "unterminated string" 'Film "image' '../in/scene.pbrt:3:6: string without a closing quote on its line'
before "unterminated list" 'Film "image" "integer xresolution" [ 3' '../in/scene.pbrt:4:1: expected a number, got WorldBegin'
before "a number too many" 'Rotate 90 0 0 1 1' '../in/scene.pbrt:3:17: expected a directive, got 1'
before "NaN" 'Translate nan 0 0' '../in/scene.pbrt:3:11: expected number 1 of 3, got nan'
before "1e39" 'Translate 1e39 0 0' '../in/scene.pbrt:3:11: number beyond the range of float (3.4028235e+38)'
before "1e999" 'Translate 1e999 0 0' '../in/scene.pbrt:3:11: number beyond the range of float (3.4028235e+38)'
within "a scale by 0" 'Scale 1 0 1 Shape "sphere"' '../in/scene.pbrt:4:1: this transform has no inverse, and a sphere stands under it in line 4'
before "a singular matrix" 'Transform [1 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1] Camera "perspective"' '../in/scene.pbrt:3:1: this transform has no inverse, and a perspective stands'
before "unknown option" 'Option "bool disablepixeljiter" true' '../in/scene.pbrt:3:8: unknown option "disablepixeljiter"; did you mean "disablepixeljitter"\?'
before "unknown colour space" 'ColorSpace "rgb"' '../in/scene.pbrt:3:12: unknown colour space "rgb"'
before "unknown attribute" 'Attribute "shap"' '../in/scene.pbrt:3:11: unknown kind of Attribute "shap"; did you mean "shape"\?'
before "unknown active transform" 'ActiveTransform Never' '../in/scene.pbrt:3:17: expected StartTime, EndTime or All, got Never'
before "one transform time" 'TransformTimes 1' '../in/scene.pbrt:4:1: expected number 2 of 2, got WorldBegin'
before "an interface of no medium" 'MediumInterface 1' '../in/scene.pbrt:3:17: expected a quoted name, got 1'
before "a shutter that stays closed" 'Film "rgb" Camera "perspective" "float shutteropen" 1' '../in/scene.pbrt:3:19: the shutter does not open'
before "iso of -1" 'Film "rgb" "float iso" -1' '../in/scene.pbrt:3:1: iso and exposuretime must be positive'
cp in/garbage in/noise.pbrt.gz && before "garbage as packed include" 'Include "noise.pbrt.gz"' '../in/scene.pbrt:3:9: cannot unpack ?../in/noise.pbrt.gz?: it is cut short or no gzip file'
within "a black body of three numbers" 'LightSource "point" "blackbody I" [1 2 3]' '../in/scene.pbrt:4:21: "blackbody I" holds 3 numbers, 2 are wanted'
before "missing include" 'Include "no.pbrt"' '../in/scene.pbrt:3:9: cannot open ?../in/no.pbrt?: No such file or directory'
before "a folder as include" 'Include "folder.pbrt"' '../in/scene.pbrt:3:9: cannot read ?../in/folder.pbrt?: not a regular file but a directory'
before "a circle of links as include" 'Include "from.pbrt"' '../in/scene.pbrt:3:9: cannot open ?../in/from.pbrt?: Too many levels of symbolic links'
before "a file that includes itself" 'Include "scene.pbrt"' '../in/scene.pbrt:3:9: "../in/scene.pbrt" includes itself'
echo 'Include "b.pbrt"' >in/a.pbrt && echo 'Include "a.pbrt"' >in/b.pbrt
before "two files that include each other" 'Include "a.pbrt"' '../in/b.pbrt:1:9: "../in/a.pbrt" includes itself'
for i in {1..40}; do
    echo "Include \"deep$((i + 1)).pbrt\"" >"in/deep$i.pbrt"
done
before "40 files deep" 'Include "deep1.pbrt"' '../in/deep31.pbrt:1:9: more than 32 files include one another'
told_before "a camera twice" 'Camera "perspective"' '../in/scene.pbrt:3:1: a second Camera: it takes the place of the first'
before "unknown camera" 'Camera "perspectiv"' '../in/scene.pbrt:3:8: unknown camera "perspectiv"; did you mean "perspective"\?'
before "a lens that is no disk" 'Scale 1 2 1 Camera "orthographic" "float lensradius" .1' '../in/scene.pbrt:3:20: the camera?s transform must be finite and free of shear and uneven scale'
before "an orthographic camera of no width" 'Camera "orthographic" "float screenwindow" [0 0 -1 1]' '../in/scene.pbrt:3:23: "float screenwindow" wants x0 < x1 and y0 < y1'
before "a sheared camera" 'Scale 1 2 1 Camera "perspective"' '../in/scene.pbrt:3:20: the camera?s transform must be finite and free of shear and uneven scale'
before "film of 0" 'Film "image" "integer xresolution" 0' '../in/scene.pbrt:3:1: a film of 0 x 720 pixels holds nothing'
before "film of 1e9" 'Film "image" "integer xresolution" 1000000000' '../in/scene.pbrt:2:8: the film of 1000000000 x 720 pixels is too large'
before "film of -1" 'Film "image" "integer xresolution" -1' '../in/scene.pbrt:3:1: a film of -1 x 720 pixels holds nothing'
before "fov of a word" 'Camera "perspective" "float fov" "wide"' '../in/scene.pbrt:3:34: expected a number, got "wide"'
before "depth of -1" 'Integrator "path" "integer maxdepth" -1' '../in/scene.pbrt:3:12: maxdepth -1 is out of range'
before "a begin that nobody ends" 'AttributeBegin' '../in/scene.pbrt:3:1: this Begin is still open at WorldBegin'
before "an end that nobody began" 'AttributeEnd' '../in/scene.pbrt:3:1: AttributeEnd without AttributeBegin'
before "a shape too early" 'Shape "sphere"' '../in/scene.pbrt:3:1: Shape belongs after WorldBegin'
within "a sphere of radius 0" 'Shape "sphere" "float radius" 0' '../in/scene.pbrt:4:1: the radius is not positive'
within "a sphere of NaN" 'Shape "sphere" "float radius" nan' '../in/scene.pbrt:4:31: expected a number, got nan'
within "nothing of a sphere" 'Shape "sphere" "float zmin" 2' '../in/scene.pbrt:4:1: zmin and zmax leave nothing of the sphere'
within "a ring without a breadth" 'Shape "disk" "float innerradius" 1' '../in/scene.pbrt:4:1: innerradius is not below the radius'
within "a curve of three points" 'Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0]' '../in/scene.pbrt:4:1: Shape "curve" wants "point3 P": of a Bezier curve degree x n + 1 points'
within "a patch of three corners" 'Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 1 1 0]' '../in/scene.pbrt:4:1: Shape "bilinearmesh" wants "point3 P" and "integer indices" in fours'
within "a field of the wrong size" 'Shape "heightfield" "integer nu" 2 "integer nv" 2 "float Pz" [1 2 3]' '../in/scene.pbrt:4:1: Shape "heightfield" wants nu, nv of 2 or more and nu x nv numbers Pz'
within "an unknown shape" 'Shape "spere"' '../in/scene.pbrt:4:7: unknown shape "spere"; did you mean "sphere"\?'
within "a parameter without a value" 'Shape "sphere" "float radius"' '../in/scene.pbrt:5:1: expected a number, got LightSource'
told_within "a parameter of another type" 'Shape "sphere" "string radius" "1"' '../in/scene.pbrt:4:16: unused parameter "string radius" of Shape "sphere"'
within "a parameter without a type" 'Shape "sphere" "radius" 1' '../in/scene.pbrt:4:16: parameter "radius" is not of the form "type name"'
told_within "a parameter twice" 'Shape "sphere" "float radius" 1 "float radius" 2' '../in/scene.pbrt:4:16: unused parameter "float radius" of Shape "sphere"'
within "an index out of range" 'Shape "trianglemesh" "integer indices" [0 1 3] "point P" [0 0 0 1 0 0 0 1 0]' '../in/scene.pbrt:4:22: index 3 is outside the mesh?s 3 points'
within "an index below 0" 'Shape "trianglemesh" "integer indices" [0 1 -1] "point P" [0 0 0 1 0 0 0 1 0]' '../in/scene.pbrt:4:22: index -1 is outside the mesh?s 3 points'
within "a mesh without points" 'Shape "trianglemesh" "integer indices" [0 1 2]' '../in/scene.pbrt:4:1: Shape "trianglemesh" wants "integer indices" and "point P"'
within "two thirds of a point" 'Shape "trianglemesh" "integer indices" [0 1 2] "point P" [0 0 0 1 0 0 0 1]' '../in/scene.pbrt:4:48: "point P" holds 8 numbers, which is no multiple of 3'
within "two thirds of a triangle" 'Shape "trianglemesh" "integer indices" [0 1] "point P" [0 0 0 1 0 0 0 1 0]' '../in/scene.pbrt:4:22: 2 indices make no whole triangles'
within "a subdivision of 1e9 levels" 'Shape "loopsubdiv" "integer levels" 1000000000 "integer indices" [0 1 2] "point P" [0 0 0 1 0 0 0 1 0]' '../in/scene.pbrt:4:1: Shape "loopsubdiv" wants "integer indices" in threes, "point P" and from 0 to'
within "a sphere at 1e20" 'Translate 1e20 0 0 Shape "sphere"' '../in/scene.pbrt:5:1: a light lies 1e+20 units from the origin; rays in floats work up to 1e+12:'
within "unknown material" 'Material "mat"' '../in/scene.pbrt:4:10: unknown material "mat"; did you mean "matte"\?'
told_within "a material not made" 'NamedMaterial "steel"' '../in/scene.pbrt:4:15: unknown named material "steel" (known: none); the material before'
within "unknown texture" 'Material "matte" "texture Kd" "wood"' '../in/scene.pbrt:4:18: unknown texture "wood" (known: none)'
within "an object not made" 'ObjectInstance "tree"' '../in/scene.pbrt:4:16: unknown object "tree" (known: none)'
within "an object within itself" 'ObjectBegin "o" ObjectInstance "o" ObjectEnd ObjectInstance "o"' '../in/scene.pbrt:4:17: ObjectInstance inside of an object'
within "a light of NaN" 'LightSource "point" "rgb I" [nan 1 1]' '../in/scene.pbrt:4:30: expected a number, got nan'
within "a light of two channels" 'LightSource "point" "rgb I" [1 1]' '../in/scene.pbrt:4:21: "rgb I" holds 2 numbers, which is no multiple of 3'
printf '%s\n' 'Camera "perspective"' WorldBegin 'Shape "sphere"' WorldEnd >in/scene.pbrt && in_pbrt "no emitter" '../in/scene.pbrt: no emitter: the scene needs a light, or a shape that emits; what is black or'
printf '%s\n' 'Camera "perspective"' WorldBegin 'AreaLightSource "diffuse" "rgb L" [0 0 0]' 'Shape "sphere"' WorldEnd >in/scene.pbrt && in_pbrt "a black emitter" '../in/scene.pbrt: no emitter: the scene needs a light, or a shape that emits; what is black or'
printf '%s\n' 'Camera "perspective"' WorldBegin 'AreaLightSource "diffuse" "rgb L" [-1 -1 -1]' 'Shape "sphere"' WorldEnd >in/scene.pbrt && in_pbrt "a negative emitter" '../in/scene.pbrt: no emitter: the scene needs a light, or a shape that emits; what is black or'
printf '%s\n' WorldBegin 'LightSource "point"' WorldEnd >in/scene.pbrt
warn "no camera" '../in/scene.pbrt:1:1: no Camera before this: pbrt?s own is taken' render ../in/scene.pbrt -i pt --spp 1 --size 8x6 -o y.exr
no_file() { # no_file WHAT ENDING LINE: LINE names a file NAME
    within "a folder as $1" "${3//NAME/folder.$2}" "../in/scene.pbrt:4:*: cannot read '../in/folder.$2': not a regular file but a directory"
    within "a circle of links as $1" "${3//NAME/from.$2}" "../in/scene.pbrt:4:*: cannot open '../in/from.$2': Too many levels of symbolic links"
}
no_file texture png 'Texture "t" "spectrum" "imagemap" "string filename" "NAME"'
no_file environment exr 'LightSource "infinite" "string mapname" "NAME"'
no_file mesh ply 'Shape "plymesh" "string filename" "NAME"'
no_file spectrum spd 'Material "metal" "spectrum eta" "NAME"'
cp in/garbage in/noise.spd && within "binary garbage as spectrum" 'Material "metal" "spectrum eta" "noise.spd"' '../in/scene.pbrt:4:18: "../in/noise.spd" is not a list of pairs (rising wavelength, value)'
: >in/empty.spd && within "an empty spectrum" 'Material "metal" "spectrum eta" "empty.spd"' '../in/scene.pbrt:4:18: "../in/empty.spd" is not a list of pairs (rising wavelength, value)'
echo '400 nan' >in/nan.spd && within "a spectrum of NaN" 'Material "metal" "spectrum eta" "nan.spd"' '../in/scene.pbrt:4:18: "../in/nan.spd" is not a list of pairs (rising wavelength, value)'
echo '400' >in/half.spd && within "half a pair of a spectrum" 'Material "metal" "spectrum eta" "half.spd"' '../in/scene.pbrt:4:18: "../in/half.spd" is not a list of pairs (rising wavelength, value)'
pbrt '' && sed -i 's/$/\r/' in/scene.pbrt && accept "CRLF" info ../in/scene.pbrt
pbrt '' && { printf '\xef\xbb\xbf' && cat in/scene.pbrt; } >in/bom.pbrt && accept "a byte order mark" info ../in/bom.pbrt
pbrt '' && tr '\n' '\r' <in/scene.pbrt >in/mac.pbrt && accept "CR" info ../in/mac.pbrt

kind=".lxs"
lxs() { # lxs WHAT LINE WORDS
    printf '%s\n' 'Camera "perspective"' WorldBegin "$2" 'LightSource "point"' WorldEnd >in/scene.lxs
    refuse "$1" 1 "$3" render ../in/scene.lxs --seconds 60 -o x.exr
}
refuse "missing file" 1 'cannot open ?../in/no.lxs?: No such file or directory' render ../in/no.lxs -o x.exr
: >in/empty.lxs && refuse "empty file" 1 '../in/empty.lxs:1:1: the file has no WorldBegin' render ../in/empty.lxs -o x.exr
cp in/garbage in/noise.lxs && refuse "binary garbage" 1 '../in/noise.lxs:1:1: unexpected byte 0xa7' render ../in/noise.lxs -o x.exr
told_lxs() {
    printf '%s\n' 'Camera "perspective"' WorldBegin "$2" 'LightSource "point"' WorldEnd >in/scene.lxs
    warn "$1" "$3" render ../in/scene.lxs -i pt --spp 1 --size 8x6 -o y.exr
}
lxs "unknown directive" 'Sahpe "sphere"' '../in/scene.lxs:3:1: unknown directive "Sahpe"; did you mean "Shape"\?'
told_lxs "a material not made" 'NamedMaterial "steel"' '../in/scene.lxs:3:15: unknown named material "steel" (known: none); the material before it'
lxs "missing mesh" 'Shape "plymesh" "string filename" ["no.ply"]' '../in/scene.lxs:3:17: cannot open ?../in/no.ply?: No such file or directory'
lxs "unterminated string" 'Shape "plymesh' '../in/scene.lxs:3:7: string without a closing quote on its line'
lxs "a mesh without points" 'Shape "mesh" "integer triindices" [0 1 2]' '../in/scene.lxs:3:7: unknown shape "mesh" (known: trianglemesh, plymesh, sphere, disk, cylinder,'
