# Checkpoints: in/good.ck is of `pt --spp 8` on good.yaml at its end.
kind="checkpoint"
resume() { # resume WHAT FILE WORDS ARGS...
    refuse "$1" 1 "$3" render ../in/good.yaml -i pt --spp 100000 -o x.exr --resume "../in/$2" "${@:4}"
}
resume "missing file" no.ck 'cannot open ?../in/no.ck?: No such file or directory'
resume "a folder" folder.yaml 'cannot read ?../in/folder.yaml?: not a regular file but a directory'
refuse "a device" 1 'cannot read ?/dev/zero?: not a regular file' render ../in/good.yaml -i pt --spp 100000 -o x.exr --resume /dev/zero
: >in/bad.ck && resume "empty file" bad.ck '../in/bad.ck: this is no checkpoint'
cp in/garbage in/bad.ck && resume "binary garbage" bad.ck '../in/bad.ck: this is no checkpoint'
resume "another file" good.yaml '../in/good.yaml: this is no checkpoint'
size=$(stat -c %s in/good.ck)
for part in 1 8 15 16 24; do
    head -c $part in/good.ck >in/bad.ck && resume "the first $part bytes" bad.ck '../in/bad.ck: this is no checkpoint'
done
for part in 100 1000 $((size / 2)) $((size - 8)) $((size - 1)); do
    head -c $part in/good.ck >in/bad.ck && resume "the first $part bytes" bad.ck '../in/bad.ck: the checkpoint is damaged or cut short; give another, or begin anew'
done
cp in/good.ck in/bad.ck && flip in/bad.ck 0 && resume "a bit of byte 0" bad.ck '../in/bad.ck: this is no checkpoint'
for at in 9 16 40 200 $((size / 3)) $((size / 2)) $((size - 12)) $((size - 1)); do
    cp in/good.ck in/bad.ck && flip in/bad.ck $at && resume "a bit of byte $at" bad.ck '../in/bad.ck: the checkpoint is damaged or cut short; give another, or begin anew'
done
{ cat in/good.ck && printf 'more of it'; } >in/bad.ck && resume "bytes too many" bad.ck '../in/bad.ck: the checkpoint is damaged or cut short; give another, or begin anew'
cat in/good.ck in/good.ck >in/bad.ck && resume "twice itself" bad.ck '../in/bad.ck: the checkpoint is damaged or cut short; give another, or begin anew'
resume "another seed" good.ck '../in/good.ck: seed: the checkpoint was made with 1, this run has 2' --seed 2
resume "another size" good.ck '../in/good.ck: size: the checkpoint was made with 32x24, this run has 20x20' --size 20x20
resume "another depth" good.ck '../in/good.ck: max_depth: the checkpoint was made with 6, this run has 5' --max-depth 5
resume "another integrator" good.ck '../in/good.ck: integrator: the checkpoint was made with pt, this run has bdpt' -i bdpt
resume "other chains" good.ck '../in/good.ck: integrator: the checkpoint was made with pt, this run has pssmlt' -i pssmlt
resume "other replicas" good.ck '../in/good.ck: replicas: the checkpoint was made with 8, this run has 4' --set replicas=4
resume "two differences" good.ck '../in/good.ck: s1: the checkpoint was made with 0.0009765625, this run has 0.00048828125; seed: the checkpoint was made with 1, this run has' --seed 2 --set s1=0.00048828125
resume "work that is kept in" good.ck '../in/good.ck: keep_all: the checkpoint was made with false, this run has true' --set keep_all=true
resume "a budget below what is done" good.ck '../in/good.ck: budget: the checkpoint has made 8 mutations per pixel, this run has' --spp 4
resume "a log that it did not keep" good.ck '../in/good.ck: reference of the error log: the checkpoint was made with none, this run has' --reference ../in/good.exr --errors e.csv
write_scene 9 >in/other.yaml
refuse "another scene" 1 '../in/good.ck: content of the scene: the checkpoint was made with 5126f9b13dd01f91, this run has' render ../in/other.yaml -i pt --spp 9 -o x.exr --resume ../in/good.ck
put good.ck
refuse "cannot go on into a folder that is not there" 1 'cannot write ?no/x.ck?: there is no such folder' render ../in/good.yaml -i pt --spp 100000 -o x.exr --resume good.ck --checkpoint no/x.ck
put good.ck
accept "the same file to go on from and to write" render ../in/good.yaml -i pt --spp 9 -o x.exr --resume good.ck --checkpoint good.ck
