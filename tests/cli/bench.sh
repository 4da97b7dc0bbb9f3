#!/usr/bin/env bash
# Experiments as a user runs them: the jobs, the tables, pictures and references; a batch
# that is killed at any moment ends as an undisturbed one does; a second batch is refused;
# an interrupt; what is wrong is told before any work (more in
# tests/malformed/tables.bash).
set -u
. "$(dirname "$0")/lib.bash"
. "$root/tests/cli/bench.bash" || exit 1
write_scene >scene.yaml

# --- a whole batch -----------------------------------------------------------------------
experiment 'scenes: [scene.yaml]' \
    'integrators: [pt, {integrator: pssmlt, kernel: [exponential, gaussian]}]' \
    'budget: {mutations_per_pixel: 48}' 'seeds: 2' \
    'reference: {integrator: bdpt, mutations_per_pixel: 32}' >e.yaml
"$etalon" bench e.yaml --list >list.out 2>list.err
check "the list" [ "$(sed 's/.*  //' list.out | head -n 6 | tr '\n' ';')" = \
    "scene pt mpp=48 seed=1;scene pssmlt kernel=exponential mpp=48 seed=1;\
scene pssmlt kernel=gaussian mpp=48 seed=1;scene pt mpp=48 seed=2;\
scene pssmlt kernel=exponential mpp=48 seed=2;scene pssmlt kernel=gaussian mpp=48 seed=2;" ]
check "nothing is done" grep -q '^6 jobs, 0 done; to do: .* 6 of unknown length' list.out
check "a list leaves nothing" [ ! -e results ]

check "a batch" bench whole
check "nothing on stderr" [ ! -s whole.err ]
check "a line a job" [ "$(grep -cE '^\[[1-6]/6\] scene .*: [0-9.]+ s, relmse [0-9.e-]+ '\
'\([0-9.e-]+ of it the reference.s own\)$' whole.out)" = 6 ]
check "the last line" grep -qx '6 of 6 jobs done, 6 of them now: whole/runs.csv' whole.out
check "first columns" [ "$(head -n 1 whole/runs.csv | cut -d, -f 1-6)" = \
    job,label,scene_label,scene,integrator,mode ]
check "last columns" [ "$(last_columns 1 whole/runs.csv)" = "rmse,relmse,relmse_trimmed,\
mean_ratio,reference,reference_rmse,reference_relmse,rmse_corrected,relmse_corrected,\
reference_relmse_trimmed,relmse_trimmed_corrected,relmse_trim,smape,flip" ]
check "jobs in the order of the list" [ "$(column job whole/runs.csv)" = \
    "$(head -n 6 list.out | awk '{ print $2 }')" ]
check "labels" [ "$(column label whole/runs.csv | sort -u | tr '\n' ';')" = \
    "pssmlt kernel=exponential;pssmlt kernel=gaussian;pt;" ]
check "seeds" [ "$(column seed whole/runs.csv | tr '\n' ' ')" = "1 1 1 2 2 2 " ]
check "columns of curves" [ "$(head -n 1 whole/curves.csv)" = "job,wall_s,cpu_s,paths,\
mutations_per_pixel,rmse,relmse,relmse_trimmed,mean_ratio,b,b_se,eta_s_run,eta_l_run,eta_0_run,\
acceptance,failure_rate,n_nonfinite,n_saturated" ]
check "a curve a job" [ "$(column job whole/curves.csv | uniq | tr '\n' ' ')" = \
    "$(column job whole/runs.csv | tr '\n' ' ')" ]

job=$(column job whole/runs.csv | sed -n 2p)
reference=$(echo results/references/scene-*)
"$etalon" compare "whole/images/$job.exr" "$reference/mean.exr" >compare.out
check "metrics as compare measures them" [ "$(errors_of 3 whole/runs.csv)" = \
    "$(echo $(for key in rmse relmse relmse_trimmed mean_ratio; do
        value $key compare.out
    done) | tr ' ' ,)" ]
check "SMAPE and FLIP likewise" [ "$(last_columns 3 whole/runs.csv | cut -d, -f 13-14)" = \
    "$(value smape compare.out),$(value flip compare.out)" ]
"$etalon" compare "whole/images/$job.exr" "$reference/mean.exr" --no-flip >short.out
check "FLIP can be left out, the rest stays" cmp -s short.out <(grep -v '^flip' compare.out)
check "the curve ends there" [ "$(grep "^$job," whole/curves.csv | tail -n 1 |
    cut -d, -f 6-9)" = "$(errors_of 3 whole/runs.csv)" ]
for key in experiment job label p_l seed; do
    check "attribute etalon:$key" grep -qaF "etalon:$key" "whole/images/$job.exr"
done
"$etalon" render scene.yaml -i pssmlt --mpp 48 --threads 2 --set bootstrap=2000 \
    -o alone.exr >/dev/null 2>&1
"$etalon" compare alone.exr "whole/images/$job.exr" >compare.out
check "the same bits as render's" grep -qx "rmse: 0" compare.out

"$etalon" compare "$reference/half1.exr" "$reference/mean.exr" >compare.out
check "noise of the reference" [ "$(value rmse "$reference/noise.yaml")" = \
    "$(value rmse compare.out)" ]
noise=$(value rmse "$reference/noise.yaml"),$(value relmse "$reference/noise.yaml")
check "which is in the rows" [ "$(last_columns 3 whole/runs.csv | cut -d, -f 5-7)" = \
    "../$reference/mean.exr,$noise" ]
last_columns 3 whole/runs.csv | tr , ' ' | {
    read -r rmse relmse trimmed _ _ noise_rmse noise_relmse rmse_corrected relmse_corrected \
        noise_trimmed trimmed_corrected trim _
    awk "BEGIN { s = $rmse ^ 2 - $noise_rmse ^ 2; s = s < 0 ? -sqrt(-s) : sqrt(s)
        d = $relmse - $noise_relmse; t = $trimmed - $noise_trimmed
        exit !((s - $rmse_corrected) ^ 2 < 1e-24 && (d - $relmse_corrected) ^ 2 < 1e-24 &&
            (t - $trimmed_corrected) ^ 2 < 1e-24 && $trim == 0.01) }"
}
check "and subtracted from the errors" [ $? -eq 0 ]
"$etalon" compare "$reference/half1.exr" "$reference/half2.exr" >compare.out
check "halves are independent" [ "$(value rmse compare.out)" != 0 ]

# A noise.yaml of an older program: its figures leave out another share of the pixels.
cp "$reference/noise.yaml" today.yaml
printf 'mean_ratio: 1\nrmse: 9\nrelmse: 9\nrelmse_trimmed: 9\n' >"$reference/noise.yaml"
check "older noise" bench other
check "is taken anew from the halves" cmp "$reference/noise.yaml" today.yaml
check "which is in the rows" [ "$(last_columns 3 other/runs.csv | cut -d, -f 5-7)" = \
    "$(last_columns 3 whole/runs.csv | cut -d, -f 5-7)" ]
touch -d '2001-01-01' "$reference"/*

check "again" bench whole
check "nothing is done twice" [ "$(cat whole.out)" = \
    "6 of 6 jobs done, 0 of them now: whole/runs.csv" ]
sed -i 's/seeds: 2/seeds: 3/' e.yaml
check "one seed more" bench whole
check "three jobs more" grep -qx '9 of 9 jobs done, 3 of them now: whole/runs.csv' whole.out
"$etalon" bench e.yaml -o whole --list --only '*gaussian*' >list.out
check "the list of what is done" grep -qx \
    '3 jobs, 3 done; to do: 0.0 s (rendering alone, without references)' list.out
check "the reference is used again" [ -z "$(find "$reference" -name '*.exr' -newermt \
    2002-01-01)" ]
check "a part of the jobs" bench part --only 'pt mpp'
check "by name" grep -qx '3 of 3 jobs done, 3 of them now: part/runs.csv' part.out
echo '# another scene now' >>scene.yaml
"$etalon" bench e.yaml -o whole --list >list.out
check "another scene, other jobs" grep -q '^9 jobs, 0 done' list.out

# --- killed at any moment ----------------------------------------------------------------
rm -r results
bench calm || failures=$((failures + 1))
base=$PWD/calm/images
outcome calm >calm.outcome
rm -r results
killed=0
for moment in .03 .06 .1 .15 .2 .05 .25 .08 .3 .12; do
    "$etalon" bench e.yaml -o wild >/dev/null 2>&1 &
    sleep $moment
    kill -9 $! 2>/dev/null && killed=$((killed + 1))
    wait $! 2>/dev/null
    echo "          $(rows wild) of 9 after ${moment} s"
done
# However slow the machine: in the midst of the rows.
for wanted in 2 5 7; do
    "$etalon" bench e.yaml -o wild >/dev/null 2>&1 &
    while [ "$(rows wild)" -lt $wanted ] && kill -0 $! 2>/dev/null; do
        sleep .01
    done
    kill -9 $! 2>/dev/null && killed=$((killed + 1))
    wait $! 2>/dev/null
    echo "          $(rows wild) of 9 at $wanted rows"
done
check "killed five times or more" [ $killed -ge 5 ]
check "the batch goes on" bench wild
outcome wild >wild.outcome
check "as if nothing had been" cmp calm.outcome wild.outcome
check "nine rows" [ "$(rows wild)" = 9 ]
check "nothing half-written" [ -z "$(find wild results -name '*.part*')" ]

# --- two batches, an interrupt -----------------------------------------------------------
experiment 'scenes: [scene.yaml]' 'integrators: [pt]' 'seeds: 2' \
    'budget: [{mutations_per_pixel: 4}, {seconds: 60}]' >e.yaml
"$etalon" bench e.yaml -o slow >first.out 2>first.err &
batch=$!
for ((i = 0; i < 200; i++)); do
    [ "$(rows slow)" -lt 1 ] || break
    sleep .05
done
bench slow --only 'seed=2'
status=$?
check "a second batch is refused" [ $status -eq 1 ]
check "in one line" [ "$(wc -l <slow.err)" = 1 ]
check "that says why" grep -qx \
    "etalon: error: another batch is at work in 'slow'; wait for it, .*-o DIR" slow.err
kill -INT $batch
wait $batch
check "an interrupt: status 130" [ $? -eq 130 ]
check "the abandoned job has no row" [ "$(rows slow)" = 1 ]
check "nor a picture" [ "$(ls slow/images | wc -l)" = 1 ]
bench slow --only 'mpp=4 seed=2'
check "the lock is free again" grep -qx '1 of 1 jobs done, 1 of them now: slow/runs.csv' \
    slow.out
experiment 'scenes: [scene.yaml]' 'integrators: [pt]' \
    'reference: {seconds: 100}' >e.yaml
"$etalon" bench e.yaml -o slow >first.out 2>first.err &
batch=$!
for ((i = 0; i < 200; i++)); do
    ! grep -q 'half 1 of 2' first.out || break
    sleep .05
done
kill -INT $batch
wait $batch
check "an interrupt of a reference: status 130" [ $? -eq 130 ]
check "that says how to go on" [ "$(cat first.err)" = \
    "interrupted: the running job was abandoned; the same command goes on from there" ]

# --- what is wrong -----------------------------------------------------------------------
refuse() { # refuse WHAT STATUS REGEX LINE...: an experiment of these lines, no folder left
    local what=$1 status=$2 regex=$3 got
    shift 3
    experiment "$@" >e.yaml
    bench bad
    got=$?
    check "$what: status $status" [ $got -eq "$status" ]
    check "$what: one line" [ "$(wc -l <bad.err)" = 1 ]
    check "$what: says what and where" grep -qE -- "^etalon: error: $regex" bad.err
    check "$what: nothing on standard output" [ ! -s bad.out ]
    check "$what: no folder left" [ ! -e bad ]
    rm -rf bad
}
good=('integrators: [pt]' 'budget: {seconds: 60}')
# References that would flatter: by the attributes of a picture, of the halves of a mean, and
# of one that is to be rendered.
picture() { # picture FILE ARGS...
    local file=$1
    shift
    "$etalon" render scene.yaml --spp 1 --set bootstrap=2000 "$@" -o "$file" >/dev/null 2>&1
}
picture method.exr -i pssmlt --seed 9
picture seed.exr -i bdpt --seed 1
picture depth.exr -i bdpt --seed 9 --max-depth 3
picture half.exr -i pssmlt --seed 8
picture fair.exr -i bdpt --seed 9
"$etalon" compare method.exr half.exr --mean method_mean.exr >/dev/null
"$etalon" compare fair.exr seed.exr --mean seed_mean.exr >/dev/null
chains=('integrators: [pssmlt]' 'budget: {seconds: 60}')
for file in method.exr method_mean.exr; do
    refuse "a reference of the method under test" 1 "e.yaml:7:12: the reference \($file\) is of \
the method under test, pssmlt with estimator kelemen, as 'scene pssmlt 60s seed=1': .*--force" \
        'scenes: [scene.yaml]' "${chains[@]}" "reference: $file"
done
refuse "one that is to be rendered by it" 1 "e.yaml:7:12: the reference \(to be rendered\) is \
of the method under test, mmlt with estimator plain, as 'scene pfmlt mode=paper 60s seed=1'" \
    'scenes: [scene.yaml]' 'integrators: [{integrator: pfmlt, mode: paper}]' \
    'budget: {seconds: 60}' 'reference: {integrator: mmlt, estimator: plain, seconds: 60}'
for file in seed.exr seed_mean.exr; do
    refuse "a reference of the job's seed" 1 "e.yaml:7:12: the reference \($file\) has seed 1, \
as 'scene pt 60s seed=1': .*--force" 'scenes: [scene.yaml]' "${good[@]}" "reference: $file"
done
refuse "a seed that a half has" 1 "e.yaml:7:12: the reference \(to be rendered\) has seed \
1000000002, as 'scene pt 60s seed=1000000002'" 'scenes: [scene.yaml]' "${good[@]}" \
    'reference: {seconds: 60}' 'seeds: [1000000002]'
refuse "a reference of another depth" 1 "e.yaml:7:12: the reference \(depth.exr\) holds paths \
of up to 3 edges, the picture of 'scene pt 60s seed=1' of up to 6; .*--force" \
    'scenes: [scene.yaml]' "${good[@]}" 'reference: depth.exr'
{ write_scene; echo 'lights: [{type: point, position: [0, 1, 1], intensity: [1, 1, 1]}]'; } >point.yaml
blind=('scenes: [point.yaml]' 'integrators: [mmlt]' 'budget: {mutations_per_pixel: 2}')
"$etalon" render point.yaml --spp 1 -i pt --seed 9 -o blind.exr >/dev/null 2>&1
refuse "a reference by pt, of a point light and glass" 1 "e.yaml:7:12: the reference \(blind.exr\) is by \
pt, which is blind to light that the scene of 'point mmlt mpp=2 seed=1' may have: LS\+E, .*LS\(S\|D\)\*DE, .*; \
take another, or --force" "${blind[@]}" 'reference: blind.exr'
refuse "one that is to be rendered over pt" 1 "e.yaml:7:12: the reference \(to be rendered\) is by \
pssmlt over pt, which is blind" "${blind[@]}" 'reference: {integrator: pssmlt, builder: pt, seconds: 60}'
refuse "one by bdpt" 1 "e.yaml:7:12: the reference \(to be rendered\) is by bdpt, which is blind .*: \
LS\+E, LS\+\(DS\+\)\+E; no integrator samples it: .*or --force" "${blind[@]}" 'reference: {seconds: 60}'
experiment "${blind[@]}" 'reference: blind.exr' >e.yaml
check "a blind one by force" bench blind --force
quick=('scenes: [scene.yaml]' 'integrators: [pssmlt]' 'budget: {mutations_per_pixel: 2}')
experiment "${quick[@]}" 'reference: method.exr' >e.yaml
check "by force" bench forced --force
check "by force: the noise of a single picture is not known" [ "$(last_columns 2 \
    forced/runs.csv | cut -d, -f 5-12)" = "../method.exr,.nan,.nan,.nan,.nan,.nan,.nan,0.01" ]
check "by force: the list says so" grep -q \
    '^reference of scene: ../method.exr, its own noise is not known$' <("$etalon" bench \
    e.yaml -o forced --list)
experiment "${quick[@]}" 'estimator: plain' 'reference: method.exr' >e.yaml
check "another estimator is another method" bench estimator
experiment "${quick[@]}" 'reference: fair.exr' >e.yaml
check "another method and seed" bench fair
rm -rf results && experiment "${quick[@]}" \
    'reference: {integrator: bdpt, mutations_per_pixel: 2}' >e.yaml
bench made
experiment "${quick[@]}" "reference: $(echo results/references/scene-*/mean.exr)" >e.yaml
check "a mean of an earlier batch, as a file" bench given
check "its noise is known" [ "$(last_columns 2 given/runs.csv)" = \
    "$(last_columns 2 made/runs.csv)" ]

cp -r made old
sed -i 's/,[^,]*,[^,]*$//; s/^job,label/label,job/; s/^\([0-9a-f]\{16\}\),\([^,]*\)/\2,\1/' old/runs.csv
experiment "${quick[@]}" 'reference: {integrator: bdpt, mutations_per_pixel: 2}' 'seeds: 2' >e.yaml
check "an older table" bench old
check "an older table is told" grep -q "^warning: the tables in 'old' were of an older version" \
    old.err
check "an older table keeps what it says" [ "$(sed -n 2p old/runs.csv)" = \
    "$(sed -n 2p made/runs.csv | sed 's/,[^,]*,[^,]*$/,.nan,.nan/')" ]
rm -r old
mkdir old && echo "job,label,other" >old/runs.csv
bench old
check "a table of other columns" grep -qE \
    "^etalon: error: old/runs.csv:1: its columns are not those of this program" old.err

# --- what the repository ships -----------------------------------------------------------
# Scenes that are not here excuse an experiment, slips in it do not.
for file in "$root"/config/*.yaml; do
    "$etalon" bench "$file" --list >list.out 2>list.err ||
        grep -q "cannot open '.*/shared/scenes/" list.err
    check "config/${file##*/}" [ $? -eq 0 ]
done
finish
