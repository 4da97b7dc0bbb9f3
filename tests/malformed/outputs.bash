# Where results should go.
kind="outputs"
refuse "no -o" 2 'render needs -o OUT.exr' render ../in/good.yaml
refuse "a picture of another kind" 2 '-o ?x.png?: the picture?s name ends in .exr' render ../in/good.yaml --seconds 60 -o x.png
refuse "an empty name" 2 '-o ??: the picture?s name ends in .exr' render ../in/good.yaml --seconds 60 -o ''
refuse "no folder" 1 'cannot write ?no/x.exr?: there is no such folder' render ../in/good.yaml --seconds 60 -o no/x.exr
refuse "a file as folder" 1 'cannot write ?x.exr/x.exr?: there is no such folder' render ../in/good.yaml --seconds 60 -o x.exr/x.exr
refuse "in /proc" 1 'cannot write ?/proc/x.exr?: No such file or directory' render ../in/good.yaml --seconds 60 -o /proc/x.exr
refuse "a name too long" 1 'cannot write' render ../in/good.yaml --seconds 60 -o "$(printf '%0300d' 0).exr"
refuse "a folder as picture" 1 'cannot write ?../in/folder.exr?: it is a directory' render ../in/good.yaml --seconds 60 -o ../in/folder.exr
refuse "a folder as the picture to look at" 1 'cannot write ?../in/fold.png?: it is a directory' render ../in/good.yaml --seconds 60 -o ../in/fold.exr
refuse "a folder as statistics" 1 'cannot write ?../in?: it is a directory' render $good --stats ../in
refuse "no folder for statistics" 1 'cannot write ?no/s.yaml?: there is no such folder' render $good --stats no/s.yaml
tell_late "statistics to a full disk" 'cannot write ?/dev/full?: No space left on device' render ../in/good.yaml -i pt --spp 1 -o x.exr --stats /dev/full
refuse "no folder for errors" 1 'cannot write ?no/e.csv?: there is no such folder' render $good --reference ../in/good.exr --errors no/e.csv
refuse "errors to a full disk" 1 'cannot write ?/dev/full?: No space left on device' render $good --reference ../in/good.exr --errors /dev/full
refuse "a folder as errors" 1 'cannot write ?../in?: it is a directory' render $good --reference ../in/good.exr --errors ../in
refuse "errors against nothing" 2 '--errors needs a picture to measure against: --reference REF.exr' render $good --errors e.csv
refuse "rows of no error log" 2 '--errors-every needs a file to write: --errors OUT.csv' render $good --errors-every 3
for value in 0 -1 nan often; do
    refuse "--errors-every $value" 2 "--errors-every '$value': give a number of seconds above 0" render $good --reference ../in/good.exr --errors e.csv --errors-every $value
done
refuse "a checkpoint in no folder" 1 'cannot write ?no/x.ck?: there is no such folder' render $good --checkpoint no/x.ck
refuse "a folder as checkpoint" 1 'cannot write ?../in?: it is a directory' render $good --checkpoint ../in
refuse "a checkpoint to a device" 1 'cannot write ?/dev/null?: it is no regular file' render $good --checkpoint /dev/null
refuse "--every without a file" 2 '--every needs a file to write: --checkpoint FILE' render $good --every 3
for value in -1 nan inf often; do
    refuse "--every $value" 2 "--every '$value': give a number of seconds, 0 or more" render $good --checkpoint x.ck --every $value
done
refuse "startup: no folder for statistics" 1 'cannot write ?no/s.yaml?: there is no such folder' startup ../in/good.yaml --seconds 60 --stats no/s.yaml
tell_late "statistics to a full disk, of startup" 'cannot write ?/dev/full?: No space left on device' startup ../in/good.yaml --mpp 1 --stats /dev/full

kind="one file for two"
put good.yaml good.exr good.ck
refuse "statistics over the scene" 2 '--stats ?good.yaml? would overwrite the scene: give another name' render good.yaml --seconds 60 -o x.exr --stats good.yaml
put good.yaml good.exr good.ck
refuse "over the scene by another name" 2 '--stats ?../out/./good.yaml? would overwrite the scene: give another name' render good.yaml --seconds 60 -o x.exr --stats ../out/./good.yaml
put good.yaml && ln out/good.yaml out/hard.yaml && remember
refuse "over the scene by a link" 2 '--stats ?hard.yaml? would overwrite the scene: give another name' render good.yaml --seconds 60 -o x.exr --stats hard.yaml
put good.yaml && ln -s good.yaml out/soft.yaml && remember
refuse "over the scene by a symbolic link" 2 '--stats ?soft.yaml? would overwrite the scene: give another name' render good.yaml --seconds 60 -o x.exr --stats soft.yaml
put good.yaml
refuse "startup over the scene" 2 '--stats ?good.yaml? would overwrite the scene: give another name' startup good.yaml --seconds 60 --stats good.yaml
put good.yaml good.exr
refuse "errors over the scene" 2 '--errors ?good.yaml? would overwrite the scene: give another name' render good.yaml --seconds 60 -o x.exr --reference good.exr --errors good.yaml
put good.yaml
refuse "a checkpoint over the scene" 2 '--checkpoint ?good.yaml? would overwrite the scene: give another name' render good.yaml --seconds 60 -o x.exr --checkpoint good.yaml
put good.yaml && cp out/good.yaml out/scene.exr && remember
refuse "a scene with the picture's name" 2 '-o ?scene.exr? would overwrite the scene: give another name' render scene.exr --seconds 60 -o scene.exr
put good.exr
refuse "the picture over its reference" 2 '-o ?good.exr? would overwrite the reference: give another name' render ../in/good.yaml --seconds 60 -o good.exr --reference good.exr
put good.exr
refuse "errors over the reference" 2 '--errors ?good.exr? would overwrite the reference: give another name' render $good --reference good.exr --errors good.exr
put textured.pbrt chess.png
refuse "the picture over a texture" 2 'the picture to look at beside -o ?chess.png? would overwrite a file that the scene names: give' render textured.pbrt --seconds 60 -o chess.exr
put meshed.yaml tri.ply
refuse "statistics over a mesh" 2 '--stats ?tri.ply? would overwrite a file that the scene names: give another name' render meshed.yaml --seconds 60 -o x.exr --stats tri.ply
refuse "statistics over the picture" 2 '-o and --stats are one file, ?x.exr?: give each its own' render $good --stats x.exr
refuse "statistics over the picture to look at" 2 'the picture to look at beside -o and --stats are one file, ?x.png?: give each its own' render $good --stats x.png
refuse "statistics over the map of failures" 2 'the map of failures beside -o and --stats are one file, ?x.failures.png?: give each its own' render $good -i pfmlt --stats x.failures.png
refuse "errors over the picture" 2 '-o and --errors are one file, ?x.exr?: give each its own' render $good --reference ../in/good.exr --errors x.exr
refuse "errors over statistics" 2 '--stats and --errors are one file, ?s.yaml?: give each its own' render $good --reference ../in/good.exr --errors s.yaml --stats s.yaml
refuse "errors over statistics, by another name" 2 '--stats and --errors are one file, ?./s.yaml?: give each its own' render $good --reference ../in/good.exr --errors ./s.yaml --stats s.yaml
refuse "errors over statistics, not there yet" 2 '--stats and --errors are one file, ?./new?: give each its own' render $good --reference ../in/good.exr --errors ./new --stats ../out/new
refuse "a checkpoint over the picture" 2 '-o and --checkpoint are one file, ?x.exr?: give each its own' render $good --checkpoint x.exr
refuse "a checkpoint over statistics" 2 '--stats and --checkpoint are one file, ?s.yaml?: give each its own' render $good --checkpoint s.yaml --stats s.yaml
refuse "all of one name" 2 '-o and --stats are one file, ?x.exr?: give each its own' render $good --checkpoint x.exr --stats x.exr --reference ../in/good.exr --errors x.exr
put good.ck
refuse "the picture over the checkpoint to go on from" 2 '--stats ?good.ck? would overwrite --resume: give another name' render ../in/good.yaml -i pt --spp 8 -o good.exr --resume good.ck --stats good.ck
put good.exr
refuse "compare over A" 2 '-o ?good.exr? would overwrite A: give another name' compare good.exr ../in/good.exr -o good.exr
put good.exr
refuse "compare over B" 2 '--mean ?./good.exr? would overwrite B: give another name' compare ../in/good.exr good.exr --mean ./good.exr
refuse "a mean over the difference" 2 '-o and --mean are one file, ?x.exr?: give each its own' compare ../in/good.exr ../in/good.exr -o x.exr --mean x.exr

kind="compare"
refuse "one picture" 2 'usage: etalon compare A.exr B.exr \[options]' compare ../in/good.exr
refuse "pictures of two sizes" 1 'the pictures differ in size: 32x24 against 20x20' compare ../in/good.exr ../in/small.exr -o d.png
refuse "mean of another kind" 2 '--mean ?m.png?: the picture?s name ends in .exr' compare ../in/good.exr ../in/good.exr --mean m.png
refuse "difference of another kind" 2 '-o ?d.jpg?: a difference picture?s name ends in .png or .exr' compare ../in/good.exr ../in/good.exr -o d.jpg
for value in -1 0 nan inf wide; do
    refuse "--range $value" 2 "--range: '$value' is not possible; give a number above 0" compare ../in/good.exr ../in/good.exr --range $value
done
for value in 1.5 0 -2 65 nan two; do
    refuse "--reduce $value" 2 "--reduce: '$value' is not possible; give a whole number from 1 to 64" compare ../in/good.exr ../in/small.exr --reduce $value
done
refuse "a factor that does not divide" 2 '--reduce 7: ?../in/small.exr? has 20x20 pixels, no multiple' compare ../in/good.exr ../in/small.exr --reduce 7
refuse "no folder for a difference" 1 'cannot write ?no/d.png?: there is no such folder' compare ../in/good.exr ../in/good.exr -o no/d.png
