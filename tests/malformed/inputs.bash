# What the lists have in common: good inputs to be spoilt, and things that are no files.
good="../in/good.yaml --seconds 60 -o x.exr"
write_scene >in/good.yaml
"$etalon" render in/good.yaml -i pt --spp 8 -o in/good.exr --checkpoint in/good.ck >/dev/null || exit 1
"$etalon" render in/good.yaml -i pt --spp 1 --size 20x20 -o in/small.exr >/dev/null || exit 1
cat >in/tiny.yaml <<'END'
experiment: tiny
scenes: [good.yaml]
integrators: [pt, bdpt]
seeds: 2
budget: {mutations_per_pixel: 1}
END
{ cat in/tiny.yaml && echo 'reference: good.exr'; } >in/measured.yaml
"$etalon" bench in/measured.yaml -o in/results --force >/dev/null || exit 1
"$etalon" regress in/results --baseline in/baseline.csv --update >/dev/null || exit 1
for i in {1..512}; do
    printf -v byte '\\x%02x' $(((i * i * 31 + i * 7 + 129) % 256))
    printf "$byte"
done >in/garbage
for ending in yaml png exr ply obj serialized pbrt xml spd; do
    mkdir "in/folder.$ending"
    ln -s "to.$ending" "in/from.$ending"
    ln -s "from.$ending" "in/to.$ending"
done
# A picture of 45x37 whose last value is NaN: pixels stand uncompressed at the end.
cp "$root/tests/data/exr/none_float.exr" in/nan.exr
printf '\0\0\xc0\x7f' | dd of=in/nan.exr bs=1 seek=$(($(stat -c %s in/nan.exr) - 4)) conv=notrunc \
    status=none
ln -s nowhere/at/all in/dangling.yaml
mkdir in/fold.png
cp in/good.png in/chess.png
printf '%s\n' ply 'format ascii 1.0' 'element vertex 3' 'property float x' \
    'property float y' 'property float z' 'element face 1' \
    'property list uchar int vertex_indices' end_header '0 0 0' '1 0 0' '0 1 0' '3 0 1 2' \
    >in/tri.ply
sed 's/^shapes:/&\n  - {type: mesh, material: wall, file: tri.ply}/' in/good.yaml >in/meshed.yaml
flip() { # flip FILE OFFSET: one bit of that byte
    local byte
    byte=$(od -An -tu1 -j "$2" -N 1 "$1")
    printf "\\x$(printf %02x $((byte ^ 1)))" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}
. "$root/tests/malformed/foreign.bash"
pbrt_world 'Texture "t" "spectrum" "imagemap" "string filename" "chess.png"'
cp in/scene.pbrt in/textured.pbrt
