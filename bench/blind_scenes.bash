# Sourced by bench/verdict.sh: small scenes with light that some integrators cannot sample,
# into the folder $1. NAME.pbrt has lights without extent; NAME-true.pbrt, where there is
# one, has a small ball instead, which every path can hit, of the same power.

# blind_scene NAME LIGHT DEPTH CAMERA: the shapes come from standard input.
blind_scene() {
    cat >"$folder/$1.pbrt" <<PBRT
LookAt 0 1 4  0 .8 0  0 1 0
Camera "perspective" "float fov" [40] $4
Film "image" "integer xresolution" [32] "integer yresolution" [32]
PixelFilter "box"
Integrator "path" "integer maxdepth" [$3]
WorldBegin
$2
$(cat)
WorldEnd
PBRT
}

# point X Y Z I: a point light; ball X Y Z I [R]: a ball of radius R (.1) and intensity I.
point() {
    echo "LightSource \"point\" \"rgb I\" [$4 $4 $4] \"point from\" [$1 $2 $3]"
}
ball() {
    local radiance radius=${5:-.1}
    radiance=$(awk "BEGIN { print $4 / (3.14159265358979 * $radius ^ 2) }")
    echo "AttributeBegin Material \"matte\" \"rgb Kd\" [0 0 0] Translate $1 $2 $3"
    echo "AreaLightSource \"diffuse\" \"rgb L\" [$radiance $radiance $radiance]"
    echo "Shape \"sphere\" \"float radius\" [$radius] AttributeEnd"
}

# quad X0 X1 Y0 Y1 Z0 Z1: a floor or ceiling (Y0 = Y1), else a wall across z or along it.
quad() {
    local b="$2 $3 $5" d="$1 $4 $6"
    [ "$3" = "$4" ] && b="$2 $3 $5" && d="$1 $3 $6"
    local c="$2 $4 $6"
    [ "$1" = "$2" ] && b="$1 $3 $6" && c="$1 $4 $6" && d="$1 $4 $5"
    echo "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [$1 $3 $5 $b $c $d]"
}
matte() {
    echo 'Material "matte" "rgb Kd" [.7 .6 .5]'
}
room() {
    matte
    quad -2 2 0 0 -2 3
    quad -2 2 0 3 -2 -2
}

# both NAME DEPTH X Y Z I SHAPES [R]: with a point, and with a ball.
both() {
    echo "$7" | blind_scene "$1" "$(point "$3" "$4" "$5" "$6")" "$2" ""
    echo "$7" | blind_scene "$1-true" "$(ball "$3" "$4" "$5" "$6" "${8:-.1}")" "$2" ""
}

blind_scenes() {
    local folder=$1 mirror glass
    mirror='Material "mirror" "rgb Kr" [.9 .9 .9]'
    glass='Material "glass" "float eta" [1.5]'
    both mirror 5 -1 2.6 2.5 6 "$(room; echo "$mirror"; quad 1.8 1.8 0 2.5 -2 2)"
    both caustic 5 -1 2.6 2.5 6 "$(room; echo "$glass"
        echo 'AttributeBegin Translate 0 .6 0 Shape "sphere" "float radius" [.5] AttributeEnd')"
    both image 1 -.8 1.6 0 3 "$(room; echo "$mirror"; quad 1.4 1.4 0 2.5 -2 2)"
    # Glass before the eye: all that is seen on the floor is seen through it, and lit
    # through it.
    both tank 7 0 2.6 1 60 "$(room; echo "$glass"
        quad -2 2 1.9 1.9 -2 2; quad -2 2 0 3 2 2)" .4
    { room; echo "$glass"; quad -2 2 2 2 -2 3; } | blind_scene spotglass \
        'LightSource "spot" "rgb I" [9 9 9] "point from" [0 2.8 0] "point to" [0 0 -.5] "float coneangle" [35]' 5 ""
    { room; echo "$glass"; quad -2 2 2 2 -2 3; } | blind_scene sunglass \
        'LightSource "distant" "rgb L" [2 2 2] "point from" [.3 3 .8] "point to" [0 0 0]' 5 ""
    room | blind_scene lens "$(point -.3 1.2 1 .3)" 3 '"float lensradius" [.1] "float focaldistance" [5]'
    room | blind_scene lens-true "$(ball -.3 1.2 1 .3)" 3 '"float lensradius" [.1] "float focaldistance" [5]'
    { matte; quad -2 2 -1 3 -2 -2; } | blind_scene direct "$(point 0 1 0 3)" 5 ""
}
