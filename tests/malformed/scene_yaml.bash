# Scenes in Etalon's own format: the good scene, changed by sed.
kind="scene .yaml"
yaml() { # yaml WHAT SED WORDS [STATUS]
    sed "$2" in/good.yaml >in/scene.yaml
    refuse "$1" "${4:-1}" "$3" render ../in/scene.yaml --seconds 60 -o x.exr
}
file() { # file WHAT WORDS, of what stands in in/scene.yaml
    refuse "$1" 1 "$2" render ../in/scene.yaml --seconds 60 -o x.exr
}
refuse "missing file" 1 'cannot open ?../in/no.yaml?: No such file or directory' render ../in/no.yaml -o x.exr
refuse "a folder" 1 'cannot read ?../in/folder.yaml?: not a regular file but a directory' render ../in/folder.yaml -o x.exr
refuse "a device" 1 '/dev/zero: the ending names no kind of scene that is read: .yaml (or .yml), .pbrt, .lxs, .xml' render /dev/zero -o x.exr
refuse "unknown kind of scene" 1 '../in/good.exr: the ending names no kind of scene that is read: .yaml (or .yml), .pbrt, .lxs, .xml' render ../in/good.exr -o x.exr
mkfifo in/pipe.yaml
refuse "a pipe" 1 'cannot read ?../in/pipe.yaml?: not a regular file' render ../in/pipe.yaml -o x.exr
refuse "a path too long" 1 'cannot open' render "$(printf '%05000d' 0).yaml" -o x.exr
refuse "a link to nowhere" 1 'cannot open ?../in/dangling.yaml?: No such file or directory' render ../in/dangling.yaml -o x.exr
for command in startup info; do
    sed 's/^film/flim/' in/good.yaml >in/scene.yaml
    refuse "$command, unknown key" 1 '../in/scene.yaml:2:1: unknown key ?flim? (did you mean ?film?\?); allowed' $command ../in/scene.yaml
done
: >in/scene.yaml && file "empty file" '../in/scene.yaml: the file is empty'
echo '# nothing' >in/scene.yaml && file "a comment alone" '../in/scene.yaml: the file is empty'
echo '42' >in/scene.yaml && file "a number" '../in/scene.yaml:1:1: a scene wants keys and values'
echo '- a' >in/scene.yaml && file "a list" '../in/scene.yaml:1:1: a scene wants keys and values'
head -c 4096 in/garbage >in/scene.yaml && file "binary garbage" '../in/scene.yaml:1:1: invalid leading UTF-8 octet'
cp in/good.exr in/scene.yaml && file "a picture under this name" '../in/scene.yaml:1:4: control characters are not allowed'
head -c 400 in/good.yaml >in/scene.yaml && file "cut short" '../in/scene.yaml:18:1: while scanning a simple key: could not find expected ?:?'
head -n 4 in/good.yaml >in/scene.yaml && file "cut after a key" '../in/scene.yaml:4:11: materials wants names and materials'
tr '\n' '\0' <in/good.yaml >in/scene.yaml && file "NUL bytes" '../in/scene.yaml:1:60: control characters are not allowed'
printf 'description: "\xff\xfe\x80"\n' >in/scene.yaml && file "invalid UTF-8" '../in/scene.yaml:1:15: invalid leading UTF-8 octet'
printf 'description: "unended\n' >in/scene.yaml && file "unterminated string" '../in/scene.yaml:2:1: while scanning a quoted scalar: found unexpected end of stream'
iconv -t UTF-16LE in/good.yaml >in/scene.yaml && file "UTF-16 without a mark" '../in/scene.yaml:1:2: control characters are not allowed'
printf '%0200000d' 0 | tr 0 '[' >in/scene.yaml && file "200000 brackets" '../in/scene.yaml:1:65: nested deeper than 64 levels'
{ echo 'a: &a [x,x,x,x,x,x,x,x,x]' && for i in b c d e f g h i j k; do
    echo "$i: &$i [*a,*a,*a,*a,*a,*a,*a,*a,*a]"; done; } >in/scene.yaml && file "a billion laughs" '../in/scene.yaml:1:1: unknown key ?a?; allowed'
yaml "cyclic anchor" 's/^film.*/film: \&f {width: *f, height: 3}/' '../in/scene.yaml:2:7: this node contains itself by an alias'
yaml "two documents" '$a---\nfilm: 3' '../in/scene.yaml:32:1: a second document begins here'
yaml "a tab for indentation" 's/^  wall/\twall/' '../in/scene.yaml:5:1: while scanning for the next token: found character that cannot start any token'
yaml "unknown key" 's/^film/flim/' '../in/scene.yaml:2:1: unknown key ?flim? (did you mean ?film?\?); allowed'
yaml "unknown key of a shape" 's/radius/radios/' '../in/scene.yaml:17:5: unknown key ?radios? (did you mean ?radius?\?); allowed'
yaml "a key of another shape" 's/radius: 0.35/z_min: 1/' '../in/scene.yaml:17:5: unknown key ?z_min?; allowed'
yaml "a key twice" 's/^max_depth: 6/max_depth: 6\nmax_depth: 7/' '../in/scene.yaml:4:1: key ?max_depth? is already given at line 3'
yaml "a material twice" 's/^  lamp.*/&\n  wall: {type: black}/' '../in/scene.yaml:8:3: key ?wall? is already given at line 5'
yaml "not YAML" 's/^film: {/film: {{/' '../in/scene.yaml:3:1: while parsing a flow mapping: did not find expected ?,? or ?}?'
yaml "no camera" '/^camera/d' '../in/scene.yaml:1:1: "camera" is missing here'
yaml "no film" '/^film/d' '../in/scene.yaml:1:1: "film" is missing here'
yaml "no height" 's/, height: 24//' '../in/scene.yaml:2:7: "height" is missing here'
yaml "camera is a number" 's/^camera.*/camera: 3/' '../in/scene.yaml:1:9: camera wants keys and values'
yaml "film is a list" 's/^film.*/film: [32, 24]/' '../in/scene.yaml:2:7: film wants keys and values'
yaml "shapes is a word" '/^shapes/,$cshapes: none' '../in/scene.yaml:8:9: shapes wants a list'
yaml "a shape is a word" 's/^shapes:/&\n  - none/' '../in/scene.yaml:9:5: a shape wants keys and values'
yaml "value of another type" 's/eta: 1.5/eta: [1, 2, 3, 4]/' '../in/scene.yaml:6:34: expected a finite number, got a list'
yaml "a word for a number" 's/fov: 56/fov: wide/' '../in/scene.yaml:1:57: expected a finite number, got ?wide?'
yaml "a unit" 's/fov: 56/fov: 56deg/' '../in/scene.yaml:1:57: expected a finite number, got ?56deg?'
yaml "nothing for a number" 's/fov: 56/fov: /' '../in/scene.yaml:1:57: expected a finite number, got nothing'
yaml "a list for a word" 's/type: diffuse/type: [diffuse]/' '../in/scene.yaml:5:16: expected text, got a list'
yaml "NaN in a material" 's/eta: 1.5/eta: .nan/' '../in/scene.yaml:6:34: expected a finite number, got ?.nan?'
yaml "eta of 0" 's/eta: 1.5/eta: 0/' '../in/scene.yaml:6:34: dielectric: eta = 0 must be from 0.05 to 20'
yaml "eta below 0" 's/eta: 1.5/eta: -1.5/' '../in/scene.yaml:6:34: dielectric: eta = -1.5 must be from 0.05 to 20'
yaml "eta of infinity" 's/eta: 1.5/eta: .inf/' '../in/scene.yaml:6:34: expected a finite number, got ?.inf?'
yaml "eta beyond float" 's/eta: 1.5/eta: 1e39/' '../in/scene.yaml:6:34: dielectric: eta = 1e+39 must be from 0.05 to 20'
yaml "a reflectance of NaN" 's/0.7, 0.6/.nan, 0.6/' '../in/scene.yaml:5:39: expected a finite number, got ?.nan?'
yaml "a reflectance of 2" 's/0.7, 0.6/2, 0.6/' '../in/scene.yaml:5:38: diffuse: reflectance = 2 must be from 0 to 1'
yaml "a reflectance beyond float" 's/0.7, 0.6/1e39, 0.6/' '../in/scene.yaml:5:38: diffuse: reflectance = 1e+39 must be from 0 to 1'
yaml "a roughness of 0" 's/type: diffuse, .*/type: roughconductor, alpha: 0}/' '../in/scene.yaml:5:39: roughconductor: alpha = 0 must be from 1e-05 to 10'
yaml "a roughness of -1" 's/type: diffuse, .*/type: roughconductor, alpha: -1}/' '../in/scene.yaml:5:39: roughconductor: alpha = -1 must be from 1e-05 to 10'
yaml "unknown distribution" 's/type: diffuse, .*/type: roughconductor, distribution: phong}/' '../in/scene.yaml:5:46: expected a finite number, got ?phong?'
yaml "unknown type of material" 's/type: dielectric/type: dielektric/' '../in/scene.yaml:6:17: unknown type of material "dielektric"; did you mean "dielectric"\?'
yaml "unknown material" 's/material: glass/material: glas/' '../in/scene.yaml:16:15: unknown material "glas"; did you mean "glass"\?'
yaml "unknown type of shape" 's/type: sphere/type: spere/' '../in/scene.yaml:15:11: unknown type of shape "spere"; did you mean "sphere"\?'
yaml "unknown type of light" '$alights: [{type: sun}]' '../in/scene.yaml:32:17: unknown type of light "sun" (known: point)'
yaml "a shape without material" '/material: glass/d' '../in/scene.yaml:15:5: "material" is missing here'
yaml "a shape without type" 's/- type: sphere/- reverse: true/' '../in/scene.yaml:15:5: "type" is missing here'
yaml "a radius of 0" 's/radius: 0.35/radius: 0/' '../in/scene.yaml:15:5: the radius 0 is not positive'
yaml "a radius of -1" 's/radius: 0.35/radius: -1/' '../in/scene.yaml:15:5: the radius -1 is not positive'
yaml "a radius of NaN" 's/radius: 0.35/radius: .nan/' '../in/scene.yaml:17:13: expected a finite number, got ?.nan?'
yaml "a radius beyond float" 's/radius: 0.35/radius: 1e39/' '../in/scene.yaml: the largest shape spans inf units and coordinates reach inf; rays in floats work'
yaml "a radius of 1e-300" 's/radius: 0.35/radius: 1e-300/' '../in/scene.yaml:15:5: a shape?s size must be finite, its radius a positive float and z_max above'
yaml "a transform by 0" 's/scale: \[1, 1, 2\]/scale: [1, 0, 2]/' '../in/scene.yaml:13:16: a scale of 0 has no inverse'
yaml "a transform by 1e39" 's/scale: \[1, 1, 2\]/scale: [1, 1e39, 2]/' '../in/scene.yaml:9:5: the position of vertex 0 is not finite (counted from 0)'
yaml "a place of 1e39" 's/translate: \[0.4/translate: [1e39/' '../in/scene.yaml: the largest shape spans 4 units and coordinates reach inf; rays in floats work'
yaml "a place of 1e300" 's/translate: \[0.4/translate: [1e300/' '../in/scene.yaml: the largest shape spans 4 units and coordinates reach inf; rays in floats work'
yaml "a rotation about nothing" 's/axis: \[1, 0, 0\]/axis: [0, 0, 0]/' '../in/scene.yaml:30:24: the axis is zero'
yaml "a rotation by NaN" 's/degrees: 90/degrees: .nan/' '../in/scene.yaml:30:44: expected a finite number, got ?.nan?'
yaml "a singular matrix" 's/scale: \[1, 1, 2\]/matrix: [1,0,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1]/' '../in/scene.yaml:13:17: the matrix has no inverse'
yaml "a matrix of 15" 's/scale: \[1, 1, 2\]/matrix: [1,0,0,0, 1,0,0,0, 0,0,1,0, 0,0,0]/' '../in/scene.yaml:13:17: expected a list of 16 numbers, got 15'
yaml "a projective matrix" 's/scale: \[1, 1, 2\]/matrix: [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,1,1]/' '../in/scene.yaml:13:17: the last row of the matrix is not 0 0 0 1'
yaml "two steps in one" 's/scale: \[1, 1, 2\]/scale: 1, rotate: 2/' '../in/scene.yaml:13:25: mapping values are not allowed in this context'
yaml "unknown step" 's/scale: \[1, 1, 2\]/scael: 1/' '../in/scene.yaml:13:9: unknown key ?scael? (did you mean ?scale?\?); allowed'
yaml "a camera that looks at itself" 's/target: \[0, 1, 0\]/target: [0, 1, 1.9]/' '../in/scene.yaml:1:9: position and target coincide, or up points along the view'
yaml "a camera at NaN" 's/position: \[0/position: [.nan/' '../in/scene.yaml:1:21: expected a finite number, got ?.nan?'
yaml "a camera at 1e39" 's/position: \[0/position: [1e39/' '../in/scene.yaml:1:9: the camera lies 1e+39 units from the origin; rays in floats work up to 1e+12:'
yaml "a camera at 1e20" 's/position: \[0/position: [1e20/' '../in/scene.yaml:1:9: the camera lies 1e+20 units from the origin; rays in floats work up to 1e+12:'
yaml "a camera at 1e300" 's/position: \[0/position: [1e300/' '../in/scene.yaml:1:9: the camera lies 1e+300 units from the origin; rays in floats work up to'
yaml "a camera of a singular matrix" 's/^camera.*/camera: {matrix: [1,0,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1]}/' '../in/scene.yaml:1:18: the matrix has no inverse'
yaml "a sheared camera" 's/^camera.*/camera: {matrix: [1,0.5,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}/' '../in/scene.yaml:1:9: the camera?s transform must be finite and free of shear and uneven scale'
yaml "fov of 0" 's/fov: 56/fov: 0/' '../in/scene.yaml:1:9: fov 0 is not between 0 and 180 degrees'
yaml "extent of 0" 's/fov: 56/extent: 0/' '../in/scene.yaml:1:9: the extent of an orthographic camera is positive, and leaves no room for a fov'
yaml "extent beside fov" 's/fov: 56/fov: 56, extent: 2/' '../in/scene.yaml:1:9: the extent of an orthographic camera is positive'
yaml "objects that are a list" '$aobjects: [1]' '../in/scene.yaml:32:10: objects wants names and objects'
yaml "an object that is a number" '$aobjects: {a: 1}' '../in/scene.yaml:32:14: an object wants keys and values'
yaml "an unknown key of an object" '$aobjects: {a: {shape: []}}' '../in/scene.yaml:32:15: unknown key ?shape? (did you mean ?shapes?\?); allowed'
yaml "an object within itself" '$aobjects: {a: {instances: [{object: a}]}}' '../in/scene.yaml:32:'
yaml "instances that are a map" '$ainstances: {object: a}' '../in/scene.yaml:32:12: instances wants a list'
yaml "an instance of nothing" '$ainstances: [{}]' '../in/scene.yaml:32:13: "object" is missing here'
yaml "an instance of an unknown object" '$ainstances: [{object: a}]' '../in/scene.yaml:32:22: unknown object "a" (known: none)'
yaml "an instance with a scale of 0" '$aobjects: {a: {shapes: []}}\ninstances: [{object: a, transform: {scale: 0}}]' '../in/scene.yaml:33:44: a scale of 0 has no inverse'
yaml "fov of 180" 's/fov: 56/fov: 180/' '../in/scene.yaml:1:9: fov 180 is not between 0 and 180 degrees'
yaml "fov of 1e-300" 's/fov: 56/fov: 1e-300/' '../in/scene.yaml:1:9: a field of view of 1e-300 degrees is too narrow for numbers'
yaml "fov of -30" 's/fov: 56/fov: -30/' '../in/scene.yaml:1:9: fov -30 is not between 0 and 180 degrees'
yaml "unknown fov_axis" 's/fov: 56/fov_axis: up/' '../in/scene.yaml:1:62: unknown fov_axis "up" (known: smaller, larger, x, y, diagonal)'
yaml "a lens without focus" 's/fov: 56/lens_radius: 1/' '../in/scene.yaml:1:9: a lens wants a focus_distance'
yaml "a lens of 1e30" 's/fov: 56/lens_radius: 1e30, focus_distance: 1/' '../in/scene.yaml:1:9: the camera lies 1e+30 units from the origin; rays in floats work up to 1e+12:'
yaml "a lens of -1" 's/fov: 56/lens_radius: -1/' '../in/scene.yaml:1:9: lens_radius must not be negative, focus_distance must be positive'
yaml "a crop of nothing" 's/height: 24/height: 24, crop: [0.5, 0.5, 0, 1]/' '../in/scene.yaml:2:37: crop wants \[x0, x1, y0, y1] rising within \[0, 1]'
yaml "a crop outside" 's/height: 24/height: 24, crop: [0, 2, 0, 1]/' '../in/scene.yaml:2:37: crop wants \[x0, x1, y0, y1] rising within \[0, 1]'
yaml "film of 0" 's/width: 32/width: 0/' '../in/scene.yaml:2:15: width must lie between 1 and 65536, not 0'
yaml "film of -1" 's/width: 32/width: -1/' '../in/scene.yaml:2:15: width must lie between 1 and 65536, not -1'
yaml "film of 1e6" 's/width: 32/width: 1000000/' '../in/scene.yaml:2:15: width must lie between 1 and 65536, not 1000000'
yaml "film of 4e9 pixels" 's/^film.*/film: {width: 65536, height: 65536}/' '../in/scene.yaml:1:9: the film of 65536 x 65536 pixels is too large'
yaml "depth of 0" 's/max_depth: 6/max_depth: 0/' '../in/scene.yaml:3:12: max_depth must lie between 1 and 100000, not 0'
yaml "depth of 1e9" 's/max_depth: 6/max_depth: 1e9/' '../in/scene.yaml:3:12: expected a whole number, got ?1e9?'
yaml "no emitter" '/emission/d' '../in/scene.yaml: no emitter: the scene needs a light, or a shape that emits; what is black or'
yaml "a black emitter" 's/emission: 8/emission: 0/' '../in/scene.yaml: no emitter: the scene needs a light, or a shape that emits; what is black or'
yaml "a negative emitter" 's/emission: 8/emission: -8/' '../in/scene.yaml: no emitter: the scene needs a light, or a shape that emits; what is black or'
yaml "an emitter of NaN" 's/emission: 8/emission: .nan/' '../in/scene.yaml:27:15: expected a finite number, got ?.nan?'
yaml "an emitter of 1e39" 's/emission: 8/emission: 1e39/' '../in/scene.yaml: the brightest light emits 1e+39; pictures in floats hold 8e-34 to 2e+37: scale'
yaml "an emitter of 1e300" 's/emission: 8/emission: 1e300/' '../in/scene.yaml: the brightest light emits 1e+300; pictures in floats hold 8e-34 to 2e+37: scale'
yaml "an emitter of no area" 's/scale: \[0.3, 0.3, 1\]/scale: [1e-30, 1e-30, 1]/' '../in/scene.yaml: no emitter: the scene needs a light, or a shape that emits; what is black or'
yaml "two_sided without emission" 's/radius: 0.35/two_sided: true/' '../in/scene.yaml:15:5: two_sided is said of emission; none here'
yaml "no shapes, no lights" '/^shapes/,$d' '../in/scene.yaml: no emitter: the scene needs a light, or a shape that emits; what is black or'
yaml "a light of NaN" '$alights: [{type: point, position: [0, 1, 0], intensity: .nan}]' '../in/scene.yaml:32:56: expected a finite number, got ?.nan?'
yaml "a light at 1e300" '$alights: [{type: point, position: [0, 1e300, 0], intensity: 1}]' '../in/scene.yaml:32:10: the position of a point light must be finite'
yaml "a light at 1e20" '$alights: [{type: point, position: [0, 1e20, 0], intensity: 1}]' '../in/scene.yaml:32:10: a light lies 1e+20 units from the origin; rays in floats work up to 1e+12:'
yaml "a light without a place" '$alights: [{type: point, intensity: 1}]' '../in/scene.yaml:32:10: "position" is missing here'
yaml "a profile of one point" '$a\  - {type: lathe, material: wall, profile: [[1, 0]]}' '../in/scene.yaml:32:44: a profile is a list of at least two \[radius, height]'
yaml "a profile of negative radius" '$a\  - {type: lathe, material: wall, profile: [[1, 0], [-1, 1]]}' '../in/scene.yaml:32:53: a radius of the profile is negative'
yaml "a profile of no area" '$a\  - {type: lathe, material: wall, profile: [[0, 0], [0, 1]]}' '../in/scene.yaml:32:44: nothing can be turned of this profile'
yaml "a lathe of 1e9 segments" '$a\  - {type: lathe, material: wall, segments: 1e9, profile: [[1, 0], [1, 1]]}' '../in/scene.yaml:32:45: expected a whole number, got ?1e9?'
yaml "a cylinder upside down" '$a\  - {type: cylinder, material: wall, z_min: 1, z_max: 0}' '../in/scene.yaml:32:5: z_min is not below z_max'
yaml "unknown setting in a file" 's/^max_depth: 6/&\nsettings:\n  sed: 1/' '../in/scene.yaml:5:3: unknown setting ?sed? (did you mean ?seed?\?); settings are' 2
yaml "bad setting in a file" 's/^max_depth: 6/&\nsettings:\n  chains: -5/' '../in/scene.yaml:5:3: chains: ?-5? is not possible; give a count in \[1,1e6]: ' 2
yaml "settings that exclude one another" 's/^max_depth: 6/&\nsettings: {integrator: pfmlt, kernel: exponential}/' 'pfmlt in mode exact needs a kernel whose density is known: kernel=gaussian, not exponential' 2
yaml "a list for a setting" 's/^max_depth: 6/&\nsettings: {seed: [1, 2]}/' '../in/scene.yaml:4:18: expected text, got a list'
yaml "a line break in a name" 's/material: glass/material: "gl\\nass\\e[31m"/' '../in/scene.yaml:16:15: unknown material "gl\?ass\?\[31m" (known: wall, glass, lamp)'
works() { # works WHAT: what stands in in/scene.yaml
    accept "$1" render ../in/scene.yaml -i pt --spp 1 -o y.exr
}
sed 's/$/\r/' in/good.yaml >in/scene.yaml && works "CRLF"
{ printf '\xef\xbb\xbf' && cat in/good.yaml; } >in/scene.yaml && works "a byte order mark"
{ printf '\xff\xfe' && iconv -t UTF-16LE in/good.yaml; } >in/scene.yaml && works "UTF-16 with its mark"
head -c -1 in/good.yaml >in/scene.yaml && works "no line break at the end"
sed 's/position: \[0, 1, 1.9\]/position: [0.4, 0.36, 0.2]/' in/good.yaml >in/scene.yaml && works "a camera inside glass"
once() { # once WHAT SED WORDS: worth a warning
    sed "$2" in/good.yaml >in/scene.yaml
    warn "$1" "$3" render ../in/scene.yaml -i pt --spp 1 -o y.exr
}
once "a transform by 1e-39" 's/scale: \[1, 1, 2\]/scale: 1e-39/' '../in/scene.yaml:9:5: degenerate triangle left out (12 times)'
once "a negative reflectance" 's/0.7, 0.6/-0.7, 0.6/' '../in/scene.yaml:5:38: a negative colour component was clamped to 0'
