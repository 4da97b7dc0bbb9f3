kind=".xml"
xml() { # xml WHAT LINE WORDS
    mitsuba "$2"
    in_xml "$1" "$3"
}
told() { # worth a warning
    mitsuba "$2"
    warn "$1" "$3" render ../in/scene.xml -i pt --spp 1 --size 8x6 -o y.exr
}
refuse "missing file" 1 'cannot open ?../in/no.xml?: No such file or directory' render ../in/no.xml -o x.exr
refuse "a folder" 1 'cannot read ?../in/folder.xml?: not a regular file but a directory' render ../in/folder.xml -o x.exr
: >in/scene.xml && in_xml "empty file" '../in/scene.xml:1:1: not well-formed XML: no element found'
cp in/garbage in/scene.xml && in_xml "binary garbage" '../in/scene.xml:1:1: not well-formed XML: not well-formed (invalid token)'
echo '<html/>' >in/scene.xml && in_xml "another language" '../in/scene.xml:1:1: this is no Mitsuba scene: the outermost element is <html>, not <scene>'
echo '<scene version="next"/>' >in/scene.xml && in_xml "a version that is none" '../in/scene.xml:1:1: "next" is no version'
mitsuba '' && head -c 50 in/scene.xml >in/cut.xml && mv in/cut.xml in/scene.xml && in_xml "cut short" '../in/scene.xml:2:1: not well-formed XML: unclosed token'
mitsuba '' && tr '\n' '\0' <in/scene.xml >in/nul.xml && mv in/nul.xml in/scene.xml && in_xml "NUL bytes" '../in/scene.xml:1:24: not well-formed XML: not well-formed (invalid token)'
xml "invalid UTF-8" $'<shape type="\xff\xfe"/>' '../in/scene.xml:3:14: not well-formed XML: not well-formed (invalid token)'
xml "not closed" '<shape type="disk">' '../in/scene.xml:5:3: not well-formed XML: mismatched tag'
xml "unterminated string" '<shape type="disk/>' '../in/scene.xml:4:1: not well-formed XML: not well-formed (invalid token)'
xml "an entity" '&amor;' '../in/scene.xml:3:1: not well-formed XML: undefined entity'
xml "a file that includes itself" '<include filename="scene.xml"/>' '../in/scene.xml:3:1: "../in/scene.xml" includes itself'
xml "missing include" '<include filename="no.xml"/>' '../in/scene.xml:3:1: cannot open ?../in/no.xml?: No such file or directory'
xml "a folder as include" '<include filename="folder.xml"/>' '../in/scene.xml:3:1: cannot read ?../in/folder.xml?: not a regular file but a directory'
xml "an id twice" '<bsdf type="diffuse" id="a"/><bsdf type="diffuse" id="a"/>' '../in/scene.xml:3:30: the id "a" is taken (../in/scene.xml:3)'
xml "unknown id" '<shape type="disk"><ref id="a"/></shape>' '../in/scene.xml:3:20: unknown id "a" (known: none)'
xml "an id that refers to itself" '<bsdf type="twosided" id="a"><ref id="a"/></bsdf><shape type="disk"><ref id="a"/></shape>' '../in/scene.xml:3:1: this <bsdf> refers to itself'
told "unknown shape" '<shape type="dsk"/>' '../in/scene.xml:3:1: unknown shape "dsk" (did you mean "disk"?): left out'
told "unknown material" '<shape type="disk"><bsdf type="difuse"/></shape>' '../in/scene.xml:3:20: unknown bsdf "difuse" (did you mean "diffuse"?): taken as diffuse'
xml "a number of another type" '<shape type="sphere"><string name="radius" value="1"/></shape>' '../in/scene.xml:3:22: "radius" wants <float>, this is <string>'
xml "a word for a number" '<shape type="sphere"><float name="radius" value="one"/></shape>' '../in/scene.xml:3:22: "one" in the value of <float> is not a number'
xml "NaN" '<shape type="sphere"><float name="radius" value="nan"/></shape>' '../in/scene.xml:3:22: "nan" in the value of <float> is not a number'
xml "1e39" '<shape type="sphere"><float name="radius" value="1e39"/></shape>' '../in/scene.xml:3:22: a number in the value of <float> is beyond the range of float'
xml "1e999" '<shape type="sphere"><float name="radius" value="1e999"/></shape>' '../in/scene.xml:3:22: a number in the value of <float> is beyond the range of float'
xml "a radius of 0" '<shape type="sphere"><float name="radius" value="0"/></shape>' '../in/scene.xml:3:1: the radius 0 is not positive'
xml "a radius of -1" '<shape type="sphere"><float name="radius" value="-1"/></shape>' '../in/scene.xml:3:1: the radius -1 is not positive'
xml "a scale by 0" '<shape type="disk"><transform name="to_world"><scale value="0"/></transform></shape>' '../in/scene.xml:3:47: this <scale> has no inverse'
xml "a matrix of 15" '<shape type="disk"><transform name="to_world"><matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0"/></transform></shape>' '../in/scene.xml:3:47: <matrix> wants 16 numbers by rows (or 9), not 15'
xml "a singular matrix" '<shape type="disk"><transform name="to_world"><matrix value="1 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1"/></transform></shape>' '../in/scene.xml:3:47: this <matrix> has no inverse'
xml "an emitter of NaN" '<emitter type="point"><rgb name="intensity" value="nan"/></emitter>' '../in/scene.xml:3:23: "nan" in the value of <rgb> is not a number'
xml "two channels" '<emitter type="point"><rgb name="intensity" value="1, 1"/></emitter>' '../in/scene.xml:3:23: <rgb> wants 1 or 3 numbers, not 2'
told "a second camera" '<sensor type="perspective"/>' '../in/scene.xml:3:1: only the first sensor is used'
told "a second camera, of fov 180" '<sensor type="perspective"><float name="fov" value="180"/></sensor>' '../in/scene.xml:3:1: only the first sensor is used'
xml "unknown parameter" '<integrator type="path"><integer name="max_depth" value="$d"/></integrator>' '../in/scene.xml:3:25: unknown parameter "d" (known: none)'
xml "depth of a fraction" '<integrator type="path"><integer name="max_depth" value="1.5"/></integrator>' '../in/scene.xml:3:25: 1.5 is no integer of 32 bits'
told "missing texture" '<shape type="disk"><bsdf type="diffuse"><texture type="bitmap" name="reflectance"><string name="filename" value="no.png"/></texture></bsdf></shape>' '../in/scene.xml:3:83: there is no picture ?../in/no.png?; a constant takes its place'
told "missing environment" '<emitter type="envmap"><string name="filename" value="no.exr"/></emitter>' '../in/scene.xml:3:24: there is no picture ?../in/no.exr?; a constant takes its place'
echo '<scene version="3.0.0"><emitter type="constant"/></scene>' >in/scene.xml && in_xml "no camera" '../in/scene.xml: the scene has no camera'
echo '<scene version="3.0.0"><sensor type="perspective"/></scene>' >in/scene.xml && in_xml "no emitter" '../in/scene.xml: no emitter: the scene needs a light, or a shape that emits; what is black or'
echo '<scene version="3.0.0"><sensor type="perspective"/><emitter type="constant"><rgb name="radiance" value="0"/></emitter></scene>' >in/scene.xml && in_xml "a black emitter" '../in/scene.xml: no emitter: the scene needs a light, or a shape that emits; what is black or'
echo '<scene version="3.0.0"><sensor type="perspective"/><emitter type="projector"/></scene>' >in/scene.xml && in_xml "the only emitter is left out" '../in/scene.xml:1:52: emitter "projector" is not read, and there is no other'
xml "an instance of nothing" '<shape type="instance"/>' '../in/scene.xml:3:1: shape "instance" wants a shape "shapegroup"'
xml "an instance in its own group" '<shape type="shapegroup" id="g"><shape type="instance"><ref id="g"/></shape></shape><shape type="instance"><ref id="g"/></shape>' '../in/scene.xml:3:33: an instance within a shapegroup: Mitsuba nests none'
xml "lists of other lengths" '<emitter type="constant"><spectrum name="radiance" type="irregular"><string name="wavelengths" value="400 500"/><string name="values" value="1"/></spectrum></emitter>' '../in/scene.xml:3:26: 2 wavelengths for 1 values'
xml "a spectrum of falling wavelengths" '<emitter type="constant"><spectrum name="radiance" value="500:1, 400:1"/></emitter>' '../in/scene.xml:3:26: <spectrum> wants pairs of a rising wavelength and a value'
xml "a black body without a temperature" '<emitter type="constant"><spectrum name="radiance" type="blackbody"/></emitter>' '../in/scene.xml:3:26: "blackbody" wants a positive temperature'
xml "a temperature of -1" '<emitter type="constant"><blackbody name="radiance" temperature="-1K"/></emitter>' '../in/scene.xml:3:26: <blackbody> wants a temperature like "5000K"'
xml "a dialect's depth of 0" '<dpt><integer name="maxdepth" value="0"/></dpt>' '../in/scene.xml:3:1: max_depth 0 is out of range'
xml "a comment without an end" '<!-- a -- b' '../in/scene.xml:3:1: not well-formed XML: unclosed token'
mitsuba '' && refuse "a definition that is none" 2 "'depth' defines nothing: NAME=VALUE is wanted" info -D depth ../in/scene.xml
mitsuba '' && refuse "a definition that nobody asks for" 1 '../in/scene.xml: unknown parameter "depth" (known: none)' info -D depth=3 ../in/scene.xml
mitsuba '<!-- a -- b --->' && accept "-- within a comment" info ../in/scene.xml
mitsuba '' && sed -i 's/$/\r/' in/scene.xml && accept "CRLF" info ../in/scene.xml
mitsuba '' && { printf '\xef\xbb\xbf' && cat in/scene.xml; } >in/bom.xml && accept "a byte order mark" info ../in/bom.xml
