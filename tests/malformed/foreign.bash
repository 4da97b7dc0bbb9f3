# Scenes of others: pbrt, LuxRender, Mitsuba.
pbrt() { # pbrt LINE: what stands on the third line
    printf '%s\n' 'LookAt 0 0 5  0 0 0  0 1 0' 'Camera "perspective" "float fov" [40]' \
        "$1" 'WorldBegin' 'LightSource "point" "rgb I" [1 1 1]' \
        'Shape "sphere" "float radius" [1]' 'WorldEnd' >in/scene.pbrt
}
pbrt_world() { # pbrt_world LINE: what stands on the fourth line, after WorldBegin
    printf '%s\n' 'LookAt 0 0 5  0 0 0  0 1 0' 'Camera "perspective" "float fov" [40]' \
        'WorldBegin' "$1" 'LightSource "point" "rgb I" [1 1 1]' 'WorldEnd' >in/scene.pbrt
}
mitsuba() { # mitsuba LINE: what stands on the third line
    printf '%s\n' '<scene version="3.0.0">' '<sensor type="perspective"/>' "$1" \
        '<emitter type="constant"/>' '</scene>' >in/scene.xml
}
in_pbrt() { # in_pbrt WHAT WORDS, of what stands in in/scene.pbrt
    refuse "$1" 1 "$2" render ../in/scene.pbrt --seconds 60 -o x.exr
}
in_xml() {
    refuse "$1" 1 "$2" render ../in/scene.xml --seconds 60 -o x.exr
}
