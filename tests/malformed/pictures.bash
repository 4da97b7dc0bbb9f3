# Pictures: as a reference, to compare, as environment and as texture.
kind=".exr"
exr() { # exr WHAT FILE WORDS: in/FILE in four places
    refuse "$1, as reference" 1 "$3" render $good --reference "../in/$2" --errors e.csv
    refuse "$1, to compare" 1 "$3" compare ../in/good.exr "../in/$2" -o d.png
    pbrt_world "LightSource \"infinite\" \"string mapname\" \"$2\""
    in_pbrt "$1, as environment" "${4:-$3}"
}
refuse "missing file, as reference" 1 'cannot open ?../in/no.exr?: No such file or directory' render $good --reference ../in/no.exr --errors e.csv
refuse "missing file, to compare" 1 'cannot open ?../in/no.exr?: No such file or directory' compare ../in/good.exr ../in/no.exr -o d.png
pbrt_world 'LightSource "infinite" "string mapname" "no.exr"' && warn "missing file, as environment" '../in/scene.pbrt:4:24: there is no picture ?../in/no.exr?; a constant takes its place' render ../in/scene.pbrt -i pt --spp 1 --size 8x6 -o y.exr
exr "a folder" folder.exr '*cannot read ?../in/folder.exr?: not a regular file but a directory'
exr "a circle of links" from.exr '*cannot open ?../in/from.exr?: Too many levels of symbolic links'
: >in/bad.exr && exr "empty file" bad.exr '*cannot read ?../in/bad.exr?: it is no OpenEXR file'
cp in/garbage in/bad.exr && exr "binary garbage" bad.exr '*cannot read ?../in/bad.exr?: it is no OpenEXR file'
{ printf '\x76\x2f\x31\x01' && cat in/garbage; } >in/bad.exr && exr "garbage behind the first word" bad.exr '*cannot read ?../in/bad.exr?: File is of an unsupported version'
cp in/good.png in/bad.exr && exr "a PNG by this name" bad.exr '*cannot read ?../in/bad.exr?: it is no OpenEXR file'
size=$(stat -c %s in/good.exr)
for part in 4 9 $((size / 8)) $((size / 2)) $((size - 1)); do
    head -c $part in/good.exr >in/bad.exr && exr "the first $part bytes" bad.exr '*cannot read ?../in/bad.exr?: '
done
cp "$root/tests/data/exr/deep.exr" in/bad.exr && exr "deep data" bad.exr '*cannot read ?../in/bad.exr?: deep data'
cp "$root/tests/data/exr/subsampled.exr" in/bad.exr && exr "subsampled channels" bad.exr '*cannot read ?../in/bad.exr?: subsampled channels'
cp "$root/tests/data/exr/uint.exr" in/bad.exr && exr "whole numbers" bad.exr '*cannot read ?../in/bad.exr?: channels must be half or float'
refuse "reference of another size" 1 '../in/small.exr: the reference has 20x20 pixels, the picture 32x24: give another, or another --size' render $good --reference ../in/small.exr --errors e.csv
refuse "reference of the same size as that of the file, another --size" 1 '../in/good.exr: the reference has 32x24 pixels, the picture 20x20: give another, or another --size' render $good --size 20x20 --reference ../in/good.exr --errors e.csv
refuse "reference of NaN" 1 '../in/nan.exr: 1 pixels of the reference are not finite: give another' render $good --size 45x37 --reference ../in/nan.exr --errors e.csv
refuse "reference of NaN, of the final error alone" 1 '../in/nan.exr: 1 pixels of the reference are not finite: give another' render $good --size 45x37 --reference ../in/nan.exr
pbrt_world 'LightSource "infinite" "string mapname" "nan.exr"' && warn "NaN, as environment" '../in/scene.pbrt:4:24: 667 values of the picture ?../in/nan.exr? are negative or not' render ../in/scene.pbrt -i pt --spp 1 --size 8x6 -o y.exr
pbrt_world 'Texture "t" "spectrum" "imagemap" "string filename" "nan.exr"' && warn "NaN, as texture" '../in/scene.pbrt:4:35: 667 values of the picture ?../in/nan.exr? are negative or not' render ../in/scene.pbrt -i pt --spp 1 --size 8x6 -o y.exr
accept "NaN is counted by compare" compare ../in/nan.exr ../in/nan.exr
kind=".png"
png() { # png WHAT FILE WORDS
    pbrt_world "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"$2\""
    in_pbrt "$1" "$3"
}
: >in/bad.png && png "empty file" bad.png '../in/scene.pbrt:4:35: cannot read the picture ?../in/bad.png?: it is damaged, or none of .png,'
cp in/garbage in/bad.png && png "binary garbage" bad.png '../in/scene.pbrt:4:35: cannot read the picture ?../in/bad.png?: it is damaged, or none of .png,'
cp in/good.exr in/bad.png && png "an EXR by this name" bad.png '../in/scene.pbrt:4:35: cannot read the picture ?../in/bad.png?: it is damaged, or none of .png,'
size=$(stat -c %s in/good.png)
for part in 8 20 40 $((size / 2)); do
    head -c $part in/good.png >in/bad.png && png "the first $part bytes" bad.png '../in/scene.pbrt:4:35: cannot read the picture ?../in/bad.png?: it is cut short'
done
for at in 1 13 18 25 50; do
    cp in/good.png in/bad.png && flip in/bad.png $at && png "a bit of byte $at" bad.png '../in/scene.pbrt:4:35: cannot read the picture ?../in/bad.png?: it'
done
{ head -c 16 in/good.png && printf '\0\1\0\0\0\1\0\0' && tail -c +25 in/good.png; } >in/bad.png && png "claims 65536x65536" bad.png '../in/scene.pbrt:4:35: cannot read the picture ?../in/bad.png?: its checksum tells that it is'
refuse "as reference" 1 'cannot read ?../in/good.png?: it is no OpenEXR file' render $good --reference ../in/good.png --errors e.csv
