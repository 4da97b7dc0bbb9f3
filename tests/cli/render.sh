#!/usr/bin/env bash
# Rendering as a user does it: the files, the same bits for any number of threads, an
# interrupt, emission by powers of two, a scene without light.
set -u
. "$(dirname "$0")/lib.bash"
write_scene >scene.yaml

# A tenth of the default, which takes half a second on this scene: where b is not looked at.
few=(--set bootstrap=10000)
run() { # run NAME ARGS...: renders scene.yaml
    local name=$1
    shift
    rm -f "$name".*
    "$etalon" render scene.yaml -o "$name.exr" --stats "$name.yaml" "${few[@]}" "$@" \
        >"$name.out" 2>"$name.err" || { cat "$name.err" && false; }
}
same() { # same A B: not one pixel differs
    "$etalon" compare "$1.exr" "$2.exr" >compare.out && grep -qx "rmse: 0" compare.out &&
        grep -qx "mean_ratio: 1" compare.out && grep -qx "n_nonfinite: 0" compare.out
}
starts_with() { # starts_with FILE BYTES
    [ "$(head -c "${#2}" "$1" | tr -d '\0')" = "$2" ]
}

# --- what is written ---------------------------------------------------------------------
check "a reference" run reference -i bdpt --spp 32
check "a render" run full --mpp 64 --set bootstrap=100000 --reference reference.exr --errors full.csv
check "nothing on stderr" [ ! -s full.err ]
check "EXR" starts_with full.exr $'\x76\x2f\x31\x01'
check "PNG" starts_with full.png $'\x89PNG'
check "no temporary files" [ -z "$(ls | grep part)" ]
check "header of the error log" [ "$(head -n 1 full.csv)" = \
    "wall_s,cpu_s,paths,mutations_per_pixel,rmse,relmse,relmse_trimmed,mean_ratio,b,b_se,\
eta_s_run,eta_l_run,eta_0_run,acceptance,failure_rate,n_nonfinite,n_saturated" ]
check "rows of numbers" awk -F, 'NR > 1 { for (i = 1; i <= 17; i++) if ($i !~ /^[0-9.e+-]+$/)
    exit 1; if (NF != 17) exit 1 } END { if (NR < 2) exit 1 }' full.csv
check "last row as the statistics have it" [ "$(tail -n 1 full.csv | cut -d, -f 9-)" = \
    "$(echo $(for key in $(head -n 1 full.csv | cut -d, -f 9- | tr , ' '); do
        value $key full.yaml
    done) | tr ' ' ,)" ]
check "last row at the budget" awk -F, 'END { exit !($3 == 49152 && $4 == 64) }' full.csv
"$etalon" compare full.exr reference.exr >compare.out
check "last row as compare measures it" [ "$(tail -n 1 full.csv | cut -d, -f 5-8)" = \
    "$(echo $(for key in rmse relmse relmse_trimmed mean_ratio; do
        value $key compare.out
    done) | tr ' ' ,)" ]
check "a row a round" run rounds --mpp 64 --set chains=16 --reference reference.exr \
    --errors rounds.csv --errors-every 1e-9
check "as many, of 16 chains and 128 mutations" awk -F, 'NR > 2 && $3 - last != 2048 { odd++ }
    { last = $3 } END { exit !(NR >= 20 && odd <= 1) }' rounds.csv
check "rows every hour: the last" run hour --mpp 64 --set chains=16 --reference reference.exr \
    --errors hour.csv --errors-every 3600
check "alone" [ "$(wc -l <hour.csv)" = 2 ]
# b comes from independent paths and is normal; 4.89 is a false alarm in 10^6 other seeds.
check "b of pssmlt is bdpt's" awk "BEGIN { d = $(value b full.yaml) - $(value b reference.yaml)
    exit !(d ^ 2 < 4.89 ^ 2 * ($(value b_se full.yaml) ^ 2 + $(value b_se reference.yaml) ^ 2)) }"
"$etalon" compare full.exr reference.exr --mean mean.exr >/dev/null
"$etalon" compare full.exr mean.exr >half.out
check "half of the difference from the mean" awk "BEGIN {
    x = $(value rmse half.out) / $(value rmse compare.out); exit !(x > .499999 && x < .500001) }"
check "the mean tells of what" grep -qaF "etalon:mean_of" mean.exr

keys="scene integrator mode kernel estimator builder max_depth chains bootstrap_paths seed
threads commit width height seconds_total seconds_cpu seconds_startup paths
mutations_per_pixel b b_se eta_s eta_s_se eta_l eta_l_se eta_0 eta_0_se r r_lo r_hi p_l p_l_lo
p_l_hi p_l_source p_l_reason acceptance failure_rate excluded n_nonfinite n_saturated left_out"
check "statistics in their order" [ "$(echo $keys)" = \
    "$(echo $(sed 's/:.*//' full.yaml | head -n "$(echo $keys | wc -w)"))" ]
check "no statistic without a value" [ -z "$(grep -E ':\s*$' full.yaml)" ]
for key in $keys; do
    check "attribute etalon:$key" grep -qaF "etalon:$key" full.exr
done
check "statistics of this run" [ "$(value paths full.yaml) $(value width full.yaml) \
$(value max_depth full.yaml) $(value seed full.yaml) $(value p_l_source full.yaml)" = \
    "49152 32 6 1 auto" ]
check "eta_l <= eta_0 and eta_l <= eta_s" awk -F': ' '{ v[$1] = $2 } END {
    exit !(v["eta_l"] > 0 && v["eta_l"] <= v["eta_0"] && v["eta_l"] <= v["eta_s"]) }' full.yaml
for word in eta_s eta_l eta_0 "p_l .*auto" acceptance "relmse" "full.exr, full.png"; do
    check "the summary tells $word" grep -qE "$word" full.out
done

# --- settings: defaults < file < command line --------------------------------------------
write_scene | sed 's/^max_depth: 6/max_depth: 6\nsettings: {seed: 5, chains: 32}/' >file.yaml
"$etalon" render file.yaml --mpp 8 "${few[@]}" --set chains=16 --seed=7 -o file.exr --stats file.yaml.out \
    >/dev/null
check "command line over file over default" [ "$(value seed file.yaml.out) \
$(value chains file.yaml.out) $(value estimator file.yaml.out)" = "7 16 kelemen" ]
"$etalon" startup file.yaml --mpp 8 "${few[@]}" >startup.yaml
check "startup prints what render writes" [ "$(sed '/^#/d; s/:.*//' startup.yaml)" = \
    "$(sed 's/:.*//' full.yaml)" ]
check "startup takes the file's settings" [ "$(value seed startup.yaml) \
$(value chains startup.yaml)" = "5 32" ]
check "startup and render measure the same" [ "$("$etalon" startup scene.yaml --mpp 64 |
    grep -E '^(eta|p_l|r)(_[sl0])?(_se|_lo|_hi)?:')" = \
    "$(grep -E '^(eta|p_l|r)(_[sl0])?(_se|_lo|_hi)?:' full.yaml)" ]
check "pt has no p_l" run none -i pt --spp 1
check "what pt has not is .nan" [ "$(value p_l none.yaml) $(value kernel none.yaml)" = \
    '.nan ' ]
check "info counts" [ "$("$etalon" info scene.yaml | grep -cE \
    '^(shapes +4, mesh 3, sphere 1;|film +32x24|max depth +6|lights +1, area 1)')" = 4 ]

check "info tells of memory and time" [ "$("$etalon" info scene.yaml | grep -cE \
    '^(memory +geometry .* BVH .* textures|  +pssmlt: at most films|  +a render at most|loading +[0-9.]+ s)')" = 4 ]
check "info --json is one object" [ "$("$etalon" info scene.yaml --json |
    sed -n '1p; $p' | tr -d '\n')" = "{}" ]

# --- the same bits for any number of threads ---------------------------------------------
for builder in bdpt pt; do
    for estimator in kelemen plain; do
        for threads in 1 2 3; do
            run "t$threads" --mpp 24 --threads $threads --set bootstrap=5000 \
                --set builder=$builder --set estimator=$estimator
        done
        check "pssmlt over $builder, $estimator: 1 = 2 threads" same t1 t2
        check "pssmlt over $builder, $estimator: 1 = 3 threads" same t1 t3
        check "pssmlt over $builder, $estimator: same statistics" [ \
            "$(grep -E '^(b|eta_._run|acceptance|longest_stay)' t1.yaml)" = \
            "$(grep -E '^(b|eta_._run|acceptance|longest_stay)' t3.yaml)" ]
    done
done
for integrator in pt bdpt; do
    for threads in 1 2 3; do
        run "t$threads" --spp 8 --threads $threads -i $integrator
    done
    check "$integrator: 1 = 2 threads" same t1 t2
    check "$integrator: 1 = 3 threads" same t1 t3
done
(unset GOMP_SPINCOUNT KMP_BLOCKTIME && run again --spp 8 --threads 2 -i bdpt)
check "started twice, as it sets how threads wait: the same bits" same t1 again
run other --spp 8 -i bdpt --seed 2
check "another seed is another picture" [ -z "$(same t1 other && echo same)" ]

for design in "mmlt estimator=plain" "mmlt direct=separate" "pfmlt mode=exact" "pfmlt mode=paper"; do
    for threads in 1 2 3; do
        run "t$threads" --mpp 24 --threads $threads --set bootstrap=5000 \
            -i "${design% *}" --set "${design#* }"
    done
    check "$design: 1 = 2 threads" same t1 t2
    check "$design: 1 = 3 threads" same t1 t3
    check "$design: same statistics" [ \
        "$(grep -E '^(b|eta_._run|acceptance|failure|.*by_length)' t1.yaml)" = \
        "$(grep -E '^(b|eta_._run|acceptance|failure|.*by_length)' t3.yaml)" ]
done

# --- mmlt and pfmlt ----------------------------------------------------------------------
list() { # list KEY FILE: how many numbers
    value "$1" "$2" | tr -d '"' | wc -w
}
run paper -i pfmlt --set mode=paper --mpp 32
check "the summary calls mode=paper biased" grep -qE "^integrator +pfmlt paper \(biased" paper.out
check "so do the statistics" [ "$(value biased paper.yaml) $(value mode paper.yaml)" = \
    "true paper" ]
check "and the picture itself" grep -qaP "etalon:biased\x00string\x00....true" paper.exr
check "excluded proposals are counted" awk "BEGIN { exit !($(value excluded paper.yaml) > 0 &&
    $(value excluded paper.yaml) == $(value excluded_paths paper.yaml)) }"
check "the summary tells of them" grep -qE "^excluded +[1-9]" paper.out
check "a map of failures in the picture's file" grep -qaP "failures\.Y\x00" paper.exr
for design in "pfmlt mode=exact" "pfmlt mode=counted" "mmlt per=length" \
    "pssmlt estimator=kelemen"; do
    run unbiased --mpp 32 -i "${design% *}" --set direct=joint --set "${design#* }"
    check "$design is not called biased" [ \
        "$(grep -c '(biased' unbiased.out) $(value biased unbiased.yaml)" = "0 false" ]
    check "$design: nothing is excluded" [ "$(value excluded unbiased.yaml)" = 0 ]
    check "$design: a map of failures only of pfmlt" [ \
        "$(grep -caP 'failures\.Y\x00' unbiased.exr)" = \
        "$([ "${design% *}" = pfmlt ] && echo 1 || echo 0)" ]
    lengths=$([ "${design% *}" = pssmlt ] && echo 0 || echo 6)
    for key in by_length chains_by_length b_by_length p_l_by_length eta_0_run_by_length; do
        check "$design: $key" [ "$(list $key unbiased.yaml)" = "$lengths" ]
    done
done
run exact -i pfmlt --mpp 32
check "pfmlt is exact unless told otherwise" [ "$(value mode exact.yaml) \
$(value kernel exact.yaml)" = "exact gaussian" ]
# Causes count the second proposals too, one of which follows on each failure of a first.
check "failures by cause are all failures" awk -F': ' '/^failures_/ { failed += $2 }
    { v[$1] = $2 } END {
    second = v["second_stage_paths"]
    rate = second / (v["total_paths"] - second)
    exit !(second > 0 && failed > second && failed < 2 * second &&
        (rate - v["failure_rate"]) ^ 2 < 1e-20) }' exact.yaml
check "no second proposal in mode=counted" [ "$(run counted -i pfmlt --set mode=counted --mpp 32
    value second_stage_paths counted.yaml)" = 0 ]
# As above; mmlt's b_se comes from few long paths, and is not quite as normal.
run mmlt -i mmlt --mpp 256 --set bootstrap=100000
check "b of mmlt is bdpt's" awk "BEGIN { d = $(value b mmlt.yaml) - $(value b reference.yaml)
    exit !(d ^ 2 < 4.89 ^ 2 * ($(value b_se mmlt.yaml) ^ 2 + $(value b_se reference.yaml) ^ 2)) }"

# --- emission times 2^10 -----------------------------------------------------------------
for integrator in pssmlt mmlt pfmlt bdpt pt; do
    budget="--mpp 16 --set bootstrap=5000"
    run one $budget -i $integrator
    write_scene 8192 >bright.yaml
    rm -f bright.exr
    "$etalon" render bright.yaml $budget -i $integrator -o bright.exr \
        --stats bright_stats.yaml >/dev/null
    "$etalon" compare bright.exr one.exr >compare.out
    check "$integrator: exactly 2^10 times as bright" [ \
        "$(grep -cE '^mean_ratio(_[rgb])?: 1024$' compare.out)" = 4 ]
    check "$integrator: the same decisions" [ \
        "$(grep -E '^(eta|acceptance|p_l|r[^e]|failure|longest)' one.yaml)" = \
        "$(grep -E '^(eta|acceptance|p_l|r[^e]|failure|longest)' bright_stats.yaml)" ]
    check "$integrator: b too" awk "BEGIN { exit !($(value b bright_stats.yaml) == \
        1024 * $(value b one.yaml)) }"
done

# --- an interrupt ------------------------------------------------------------------------
manual=(--large-step .5) # automatically it would depend on the time
for signal in INT TERM; do
    "$etalon" render scene.yaml "${manual[@]}" "${few[@]}" --seconds 60 --reference reference.exr --errors stop.csv \
        --stats stop.yaml -o stop.exr >stop.out 2>stop.err &
    pid=$!
    for _ in $(seq 300); do
        [ "$(cat stop.csv 2>/dev/null | wc -l)" -ge 3 ] && break
        sleep 0.1
    done
    begin=$SECONDS
    kill -$signal $pid
    wait $pid
    status=$?
    check "SIG$signal: status 0" [ $status -eq 0 ]
    check "SIG$signal: at once" [ $((SECONDS - begin)) -le 20 ]
    check "SIG$signal: says so" grep -q interrupted stop.err
    check "SIG$signal: the statistics too" [ "$(value interrupted stop.yaml)" = true ]
    # An interrupted run is a run of that length, but for the rounding of splats: the rounds
    # of a time budget end elsewhere. Two independent runs would differ by 1e-2 or more.
    run again "${manual[@]}" --mpp "$(value mutations_per_pixel stop.yaml)"
    "$etalon" compare stop.exr again.exr >compare.out
    check "SIG$signal: a whole picture" awk "BEGIN { exit !($(value relmse compare.out) < 1e-6) }"
    rm -f stop.*
done

# --- an older picture is replaced whole, or kept -----------------------------------------
cp full.exr kept.exr
"$etalon" render scene.yaml --set fo=1 -o kept.exr 2>/dev/null
check "a refused run keeps the older picture" cmp -s full.exr kept.exr

# --- a budget that the bootstrap alone uses up -------------------------------------------
check "a short budget" run short --seconds 0.001
check "its black picture is warned of" grep -q "^warning: the run ended during the boot" \
    short.err
check "its p_l was not decided" [ "$(value p_l_lo short.yaml) $(value p_l_hi short.yaml)" = \
    "0 1" ]
"$etalon" startup scene.yaml --seconds 0.001 >/dev/null 2>startup.err
check "startup warns too" grep -q "^warning: the budget ended before" startup.err

# --- the verdict -------------------------------------------------------------------------
check "too short to judge" grep -qx 'verdict: "too short"' reference.yaml
"$etalon" render scene.yaml -i pt --spp 8 -o short.exr --require-converged >short.out 2>&1
check "not converged: status 3" [ $? -eq 3 ]
check "with all written" [ -s short.exr ]
check "a line that says so" grep -q "^verdict *too short: " short.out
check "converged" run long -i pt --spp 640 --size 8x6 --require-converged
check "a line that says that" grep -qE "^verdict *converged: [0-9]+ of [0-9]+ tiles disagree" long.out
check "an R-hat is told if there is one" [ "$(grep -c "^error .*R-hat" short.out) \
$(grep -c "^error .*R-hat [0-9]" long.out)" = "0 1" ]
check "layers" [ "$(grep -aoE '(se|rhat|ess)\.Y' long.exr | sort -u | wc -l)" = 3 ]
"$etalon" render scene.yaml -i pssmlt --seconds .001 -o early.exr >early.out 2>&1
check "over before it began: not \"no light\"" grep -qE \
    "^verdict +too short: the run ended before its chains moved$" early.out
check "no replicas, no verdict" run none -i pt --spp 64 --set replicas=1
check "and no bars" [ "$(grep -c '^verdict: "*none"*$' none.yaml) $(grep -ac 'se\.Y' none.exr)" = "1 0" ]

# --- what needs no chain, and what no sample can be of -----------------------------------
write_wall() { # write_wall [SHAPE]: a wall and a point light
    cat <<YAML
camera: {position: [0, 0, 5], target: [0, 0, 0], fov: 40}
film: {width: 16, height: 16}
max_depth: 5
materials: {grey: {type: diffuse, reflectance: 0.5}, mirror: {type: mirror}}
shapes:
  - {type: rectangle, material: grey}
  $*
lights: [{type: point, position: [0, 0, 2], intensity: [1, 1, 1]}]
YAML
}
write_wall >wall.yaml
write_wall '- {type: rectangle, material: mirror, transform: [{rotate: {axis: [0, 1, 0], degrees: -90}}, {translate: [1, 0, 1]}]}' >mirror.yaml
for integrator in mmlt pfmlt; do
    "$etalon" render wall.yaml -i $integrator "${few[@]}" --mpp 128 --set direct=separate -o wall.exr \
        --stats wall.stats --require-converged >wall.out 2>wall.err
    check "$integrator, no chain needed: converged, status 0" [ $? -eq 0 ]
    check "$integrator, no chain needed: nothing on stderr" [ ! -s wall.err ]
    check "$integrator, no chain needed: p_l says so" grep -q '^p_l_reason: "no chain is needed' wall.stats
    check "$integrator, blind to nothing" [ "$(value blind_to wall.stats)" = '' ]
done
for integrator in pt "pssmlt --set builder=pt" bdpt; do
    blind="LS+E, LS+(DS+)+E"
    [ "$integrator" = bdpt ] || blind="$blind, LS(S|D)*DE, LS(S|D)*DD(S|D)*SE"
    "$etalon" render mirror.yaml -i $integrator "${few[@]}" --mpp 400 --set chains=16 -o mirror.exr --stats mirror.stats \
        --require-converged >mirror.out 2>mirror.err
    check "$integrator, blind: status 4" [ $? -eq 4 ]
    check "$integrator, blind: a warning" grep -qF "cannot sample all light of point and spot lights: LS+E (" mirror.err
    check "$integrator, blind: the verdict" grep -qF "converged, but blind to $blind: " mirror.out
    check "$integrator, blind: statistics" [ "$(value blind_to mirror.stats)" = "$blind" ]
    check "$integrator, blind: so is its verdict" [ "$(value verdict mirror.stats)" = "converged, but blind" ]
done
check "info tells" grep -qF "LS(S|D)*DE (caustics" <("$etalon" info mirror.yaml -i pt)
check "so does its JSON" grep -qF '"blind_to": "LS+E, LS+(DS+)+E"' <("$etalon" info mirror.yaml --json)
"$etalon" startup mirror.yaml "${few[@]}" --mpp 8 >/dev/null 2>startup.err
check "and startup" grep -q "^warning: pssmlt cannot sample all light" startup.err

# --- an end before the budget ------------------------------------------------------------
for integrator in pt mmlt; do
    for threads in 1 3; do
        "$etalon" render wall.yaml -i $integrator "${few[@]}" --spp 5000 --until-converged --threads $threads \
            --set direct=separate -o until$threads.exr --stats until$threads.stats >until.out 2>until.err
        check "$integrator until converged: status 0" [ $? -eq 0 ]
    done
    check "$integrator until converged: says why" [ "$(value ended_by until1.stats) \
$(value verdict until1.stats) $(value until_converged until1.stats)" = "until converged true" ]
    check "$integrator until converged: the summary too" grep -q "^ended *by its until condition after" until.out
    check "$integrator until converged: before its budget" awk "BEGIN {
        exit !($(value mutations_per_pixel until1.stats) < 1000) }"
    check "$integrator until converged: 1 = 3 threads" same until1 until3
done
check "a budget that is too short for it" run tight --mpp 16 --until-relmse 1e-9
check "says so" grep -q "^warning: the budget ended before the until condition" tight.err
check "in the statistics" [ "$(value ended_by tight.yaml)" = budget ]
"$etalon" render scene.yaml --mpp 16 --until-relmse x -o bad.exr 2>bad.err
check "--until-relmse wants a number" [ $? -eq 2 ]
# Stopped and resumed it looks where it would have looked.
"$etalon" render wall.yaml -i pt --spp 100 --until-converged --checkpoint until.ck -o half.exr \
    >/dev/null 2>&1
"$etalon" render wall.yaml -i pt --spp 5000 --until-converged --resume until.ck -o until3.exr \
    --stats until3.stats >/dev/null 2>&1
"$etalon" render wall.yaml -i pt --spp 5000 --until-converged -o until1.exr --stats until1.stats \
    >/dev/null 2>&1
check "resumed: ends at the same place" [ "$(grep -E '^(paths|until|ended|b)' until1.stats)" = \
    "$(grep -E '^(paths|until|ended|b)' until3.stats)" ]
check "resumed: with the same picture" same until1 until3

# --- the rule tours ----------------------------------------------------------------------
for integrator in pssmlt mmlt pfmlt; do
    options=(-i $integrator --mpp 64 --set chains=64 --set bootstrap=3000)
    "$etalon" render scene.yaml "${options[@]}" --threads 1 -o t1.exr --stats t1.yaml >t1.out
    "$etalon" render scene.yaml "${options[@]}" --threads 3 -o t3.exr --stats t3.yaml >/dev/null
    "$etalon" compare t1.exr t3.exr >compare.out
    check "tours, $integrator: the same bits by 3 threads" [ \
        "$(value p_l t1.yaml) $(value predicted_relmse t1.yaml)" = \
        "$(value p_l t3.yaml) $(value predicted_relmse t3.yaml)" ]
    check "tours, $integrator: the same picture" grep -qx "rmse: 0" compare.out
    for key in predicted_p predicted_relmse predicted_cost; do
        check "tours, $integrator: $key in the picture" \
            grep -qaF "etalon:$key" t1.exr
        check "tours, $integrator: with its values" \
            [ "$(value $key t1.yaml | wc -w)" = 16 -a \
            "$(grep -caF "$(value $key t1.yaml)" t1.exr)" = 1 ]
    done
    check "tours, $integrator: a reason in words" grep -q "predicted relMSE at the end" t1.out
done
"$etalon" startup scene.yaml -i mmlt "${few[@]}" --mpp 64 --set chains=64 >tours.out
check "startup prints the curve" grep -qE "^#  0\.500 +[0-9.e-]+ +[0-9.]+ +[0-9.]+$" tours.out
check "startup marks what is chosen" grep -qE "<- chosen" tours.out
check "startup marks the published value" grep -q "<- .*zsolnai2013" tours.out
check "startup draws the curve" [ "$(grep -cE '^# +[0-9.]+ \|' tours.out)" = 9 ]
check "startup gives the interval" grep -qE '^# +\[.*\].* 99 % interval' tours.out
check "startup gives the reason" grep -qxF "# $(value p_l_reason tours.out)" tours.out
check "startup's curve is a comment" [ -z "$(grep -vE '^(#|[a-z0-9_]+: )' tours.out)" ]
# What the rule has too little to go by falls back to the published rule, bit by bit, and
# says so.
falls_back() { # falls_back WHY OPTIONS...
    local why=$1
    shift
    "$etalon" render scene.yaml "${few[@]}" "$@" -o f1.exr --stats f1.yaml >f1.out 2>/dev/null
    "$etalon" render scene.yaml "${few[@]}" "$@" --set rule=zsolnai2013 --set s2="$(value s2 f1.yaml)" \
        -o f2.exr --stats f2.yaml >/dev/null 2>&1
    "$etalon" compare f1.exr f2.exr >compare.out
    check "$why: said" grep -qE "^p_l .* not by predicted errors, as $why, but by zsolnai2013: " \
        f1.out
    check "$why: p_l of the published rule" [ "$(value p_l f1.yaml) $(value p_l_se f1.yaml)" = \
        "$(value p_l f2.yaml) $(value p_l_se f2.yaml)" ]
    check "$why: the same picture" grep -qx "rmse: 0" compare.out
}
falls_back "the run is too short" --mpp 32
falls_back "the run is too short" -i mmlt --set per=length --mpp 32
falls_back "there are too few chains" --mpp 64 --set chains=8
# Where the start has too few tours even at its cap, or contradicts itself.
"$etalon" render "$root/scenes/glass-caustic/scene.yaml" -i mmlt --size 24x16 --mpp 64 \
    --set chains=16 --set bootstrap=3000 --set start_cap=0.06 -o d.exr --stats d.yaml >d.out
check "a doubtful start: said" grep -qE "^p_l .* not by predicted errors, as \
(halves of the chains disagree|there are too few tours or visits), but by zsolnai2013: " d.out
check "a doubtful start: was doubled" [ "$(value start_looks d.yaml)" -ge 2 ]
check "a doubtful start: p_l of the published rule" [ \
    "$(value p_l d.yaml)" = "$(value p_l_zsolnai2013 d.yaml)" ]
check "the published value is told under either rule" [ \
    "$(value p_l_zsolnai2013 f1.yaml)" = "$(value p_l f2.yaml)" -a \
    "$(value p_l_zsolnai2013 f2.yaml)" = "$(value p_l f2.yaml)" ]
"$etalon" render scene.yaml -i pfmlt --set mode=paper --set rule=tours -o no.exr 2>tours.err
check "no rule tours where failures are no states" [ $? -eq 2 -a "$(wc -l <tours.err)" -eq 1 ]

# --- no light reaches the camera ---------------------------------------------------------
write_scene | sed 's/translate: \[0, 1.98, 0\]/translate: [0, 9, 0]/' >dark.yaml
for integrator in pssmlt mmlt pfmlt bdpt pt; do
    "$etalon" render dark.yaml -i $integrator "${few[@]}" --mpp 4 -o dark.exr --stats dark_stats.yaml \
        >dark.out 2>dark.err
    check "$integrator in the dark: status 0" [ $? -eq 0 ]
    check "$integrator in the dark: a warning" grep -qE \
        "^warning: no light-carrying path found in [1-9][0-9]* samples" dark.err
    check "$integrator in the dark: b is 0" [ "$(value b dark_stats.yaml)" = 0 ]
    "$etalon" compare dark.exr reference.exr >compare.out
    check "$integrator in the dark: black" grep -qx "mean_ratio: 0" compare.out
done
finish
