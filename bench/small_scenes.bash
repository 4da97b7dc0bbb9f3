# Sourced by scripts that set methods beside each other on small pictures, at about equal
# CPU time. They set etalon, out, and seconds: of CPU time, a run.

shared=../shared/scenes

# scenes NAME...: name, file, size, integrator and samples a pixel of the reference; a
# scene that is not there is left out. SCENES chooses some of them.
scenes() {
    local name row
    for name in ${SCENES:-$*}; do
        while read -r row; do
            read -r _ file _ <<<"$row"
            if [[ $row == "$name "* && -e $file ]]; then echo "$row"; fi
        done <<END
box $shared/peer-box/diffuse.pbrt 60x48 bdpt 2500
glass $shared/peer-box/glass.pbrt 60x48 bdpt 2500
coffee $shared/coffee-pbrt3/scene.pbrt 48x60 pt 8000
living-room $shared/living-room-pbrt3/scene.pbrt 64x36 bdpt 2500
veach-bidir $shared/veach-bidir-mitsuba/scene.xml 64x36 bdpt 2500
veach-ajar $shared/veach-ajar-mitsuba/scene.xml 64x36 mmlt 16000
torus $shared/torus-dpt/h2mc.xml 48x48 mmlt 16000
door scenes/door/scene.yaml 60x45 mmlt 20000
glass-caustic scenes/glass-caustic/scene.yaml 60x45 mmlt 20000
staircase $shared/staircase-pbrt4/staircase.pbrt 36x64 bdpt 2500
cornell scenes/cornell/scene.yaml 48x48 bdpt 2500
bathroom $shared/contemporary-bathroom-pbrt3/contemporary-bathroom.pbrt 64x36 bdpt 2500
pool scenes/pool/scene.yaml 64x40 mmlt 20000
interior scenes/interior/scene.yaml 64x40 bdpt 2500
splash scenes/splash/scene.yaml 64x40 bdpt 2500
light-tube scenes/light-tube/scene.yaml 64x40 bdpt 4000
glass-ball scenes/glass-ball/scene.yaml 64x40 bdpt 4000
shells scenes/shells/scene.yaml 64x40 pt 8000
water-glass scenes/water-glass/scene.yaml 64x40 bdpt 4000
chess scenes/chess/scene.yaml 64x40 bdpt 2500
twin-lamps scenes/twin-lamps/scene.yaml 64x40 pt 8000
END
    done
}

# render_small FILE SIZE MPP SEED METHOD...: picture and statistics, $out/run.exr and .yaml
render_small() {
    local file=$1 size=$2 mpp=$3 seed=$4
    shift 4
    "$etalon" render "$file" --size "$size" --threads 1 --mpp "$mpp" --seed "$seed" "$@" \
        --stats "$out/run.yaml" -o "$out/run.exr" >/dev/null 2>&1
}

# budget FILE SIZE METHOD...: mutations a pixel that take so many seconds, by a short run;
# auto takes a second one, as its choice depends on the budget
budget() {
    local file=$1 size=$2 mpp
    shift 2
    render_small "$file" "$size" 32 99 "$@" --set bootstrap=4000
    mpp=$(paced 32)
    if [[ $* == *auto* ]]; then
        render_small "$file" "$size" "$mpp" 99 "$@"
        mpp=$(paced "$mpp")
    fi
    echo "$mpp"
}

# paced MPP: what the last run, of so many, would have had in the time of a run
paced() {
    awk "BEGIN { m = $1 * $seconds / $(value seconds_cpu "$out/run.yaml")
        print m < 16 ? 16 : m }"
}

# make_reference NAME FILE SIZE INTEGRATOR SPP: in $out/references, if it is not there
make_reference() {
    local made=$out/references/$1.exr
    mkdir -p "$out/references"
    [ -s "$made" ] || "$etalon" render "$2" --size "$3" --threads 1 --seed 777 \
        -i "$4" --mpp "$5" -o "$made" >/dev/null 2>&1
}

# compare_small NAME: errors of the last picture, $out/compare.yaml
compare_small() {
    "$etalon" compare "$out/run.exr" "$out/references/$1.exr" >"$out/compare.yaml"
}
