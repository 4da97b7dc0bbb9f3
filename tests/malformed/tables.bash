# Experiments, and what bench, report and regress read.
kind="experiment .yaml"
experiment() { # experiment WHAT STATUS WORDS SED: in/e.yaml, changed
    sed "$4" in/tiny.yaml >in/e.yaml
    refuse "$1" "$2" "$3" bench ../in/e.yaml -o r "${@:5}"
}
refuse "missing file" 1 'cannot open ?../in/no.yaml?: No such file or directory' bench ../in/no.yaml -o r
refuse "a folder" 1 'cannot read ?../in/folder.yaml?: not a regular file but a directory' bench ../in/folder.yaml -o r
refuse "a scene" 1 '../in/good.yaml:1:1: unknown key ?camera?*; allowed' bench ../in/good.yaml -o r
: >in/e.yaml && refuse "empty file" 1 '../in/e.yaml: the file is empty' bench ../in/e.yaml -o r
cp in/garbage in/e.yaml && refuse "binary garbage" 1 '../in/e.yaml:1:1: invalid leading UTF-8 octet' bench ../in/e.yaml -o r
head -c 40 in/tiny.yaml >in/e.yaml && refuse "cut short" 1 '../in/e.yaml:4:1: while scanning a simple key: could not find expected ?:?' bench ../in/e.yaml -o r
experiment "no name" 1 '../in/e.yaml:1:1: ?experiment? is missing: its name' '/^experiment/d'
experiment "an empty name" 1 '../in/e.yaml:1:13: experiment: ?? is to name a folder: letters, digits, ?_?, ?-? and ?.?, not' 's/^experiment.*/experiment: ""/'
experiment "a name that leads elsewhere" 1 '../in/e.yaml:1:13: experiment: ?../../x? is to name a folder: letters, digits, ?_?, ?-? and ?.?,' 's/^experiment.*/experiment: ..\/..\/x/'
experiment "unknown key" 1 '../in/e.yaml:4:1: unknown key ?sedes? (did you mean ?seeds?\?); allowed' 's/^seeds/sedes/'
experiment "a key twice" 1 '../in/e.yaml:5:1: key ?seeds? is already given at line 4' 's/^seeds.*/&\n&/'
experiment "no scenes" 1 '../in/e.yaml:1:1: ?scenes? is missing: a list' '/^scenes/d'
experiment "an empty list of scenes" 1 '../in/e.yaml:2:9: scenes: expected a list with something in it' 's/^scenes.*/scenes: []/'
experiment "missing scene" 1 '../in/e.yaml:2:10: cannot open ?../in/no.yaml?: No such file or directory' 's/good.yaml/no.yaml/'
experiment "a bad scene" 1 '../in/tiny.yaml:1:1: unknown key ?experiment?; allowed' 's/good.yaml/tiny.yaml/'
experiment "the same scene twice" 1 '../in/e.yaml:2:21: two scenes are called ?good?; tell them apart: {scene: FILE, label: NAME}' 's/^scenes.*/scenes: [good.yaml, good.yaml]/'
experiment "no integrators" 1 '../in/e.yaml:3:14: integrators: expected a list with something in it' 's/^integrators.*/integrators: []/'
experiment "unknown integrator" 2 '../in/e.yaml:3:15: integrator: ?ptt? is not possible; give pssmlt, mmlt, pfmlt, rjmlt, smlt, mlt, bdpt, pt or auto: the algorithm (default' 's/^integrators.*/integrators: [ptt]/'
experiment "the same integrator twice" 1 '../in/e.yaml:1:1: two jobs are the same: ?good pt mpp=1 seed=2? and ?good pt mpp=1 seed=2?' 's/^integrators.*/integrators: [pt, pt]/'
experiment "0 seeds" 1 '../in/e.yaml:4:8: seeds: 0 is not possible; give a count in \[1,100000], or a list' 's/^seeds.*/seeds: 0/'
experiment "-1 seeds" 1 '../in/e.yaml:4:8: seeds: -1 is not possible; give a count in \[1,100000], or a list' 's/^seeds.*/seeds: -1/'
experiment "1e9 seeds" 1 '../in/e.yaml:4:8: expected a whole number, got ?1e9?' 's/^seeds.*/seeds: 1e9/'
experiment "1.5 seeds" 1 '../in/e.yaml:4:8: expected a whole number, got ?1.5?' 's/^seeds.*/seeds: 1.5/'
experiment "a seed of NaN" 1 '../in/e.yaml:4:9: expected a whole number, got ?.nan?' 's/^seeds.*/seeds: [.nan]/'
experiment "the same seed twice" 1 '../in/e.yaml:1:1: two jobs are the same: ?good bdpt mpp=1 seed=1? and ?good bdpt mpp=1 seed=1?' 's/^seeds.*/seeds: [1, 1]/'
experiment "no budget" 1 '../in/e.yaml:5:9: budget is empty: there would be no job' 's/^budget.*/budget: {}/'
experiment "a budget of another unit" 1 '../in/e.yaml:5:10: unknown key ?hours?; allowed' 's/^budget.*/budget: {hours: 1}/'
experiment "a budget without a unit" 1 '../in/e.yaml:5:9: expected a map, got ?60?' 's/^budget.*/budget: 60/'
experiment "a budget of 0" 2 '../in/e.yaml:5:19: seconds: ?0? is not possible; give a number of seconds in \[0.001,1e9]' 's/^budget.*/budget: {seconds: 0}/'
experiment "a budget of NaN" 2 '../in/e.yaml:5:19: seconds: ?.nan? is not possible; give a number of seconds in \[0.001,1e9]' 's/^budget.*/budget: {seconds: .nan}/'
experiment "a budget of 1e300 s" 2 '../in/e.yaml:5:19: seconds: ?1e300? is not possible; give a number of seconds in \[0.001,1e9]' 's/^budget.*/budget: {seconds: 1e300}/'
experiment "p_l of 2" 2 '../in/e.yaml:6:32: large_step_probability: ?2? is not possible; give auto or a number in (0,1]' '$alarge_step_probability: [auto, 2]'
experiment "p_l of 0" 2 '../in/e.yaml:2:10: good pt: large_step_probability: 0 leaves a chain where it starts; give a number' '$alarge_step_probability: [0]'
experiment "size of 0x0" 2 '../in/e.yaml:6:7: size: ?0x0? is not possible; give WIDTHxHEIGHT in pixels, each in \[1,65536]' '$asize: 0x0'
experiment "unknown setting" 1 '../in/e.yaml:6:1: unknown key ?sigmoid? (did you mean ?sigma?\?); allowed' '$asigmoid: 1'
experiment "settings that exclude one another" 2 '../in/e.yaml:2:10: good pfmlt kernel=exponential: pfmlt in mode exact needs a kernel whose density' 's/^integrators.*/integrators: [{integrator: pfmlt, kernel: exponential}]/'
experiment "missing reference" 1 '../in/e.yaml:6:12: cannot open ?../in/no.exr?: No such file or directory' '$areference: no.exr'
experiment "reference is no picture" 1 '../in/e.yaml:6:12: cannot read ?../in/good.yaml?: it is no OpenEXR file' '$areference: good.yaml'
experiment "reference of another size" 1 '../in/e.yaml:6:12: the reference ?small.exr? has 20x20 pixels, the pictures of ?good pt mpp=1' '$areference: small.exr'
experiment "reference of NaN" 1 '../in/e.yaml:6:12: 1 pixels of the reference ?nan.exr? are not finite' '$areference: nan.exr\nsize: 45x37'
experiment "reference of an unknown integrator" 2 '../in/e.yaml:6:25: integrator: ?ptt? is not possible; give pssmlt, mmlt, pfmlt, rjmlt, smlt, mlt, bdpt, pt or auto: the algorithm (default' '$areference: {integrator: ptt, seconds: 1}'
experiment "reference without a budget" 1 '../in/e.yaml:6:12: a reference that is to be rendered needs a budget: seconds or mutations_per_pixel' '$areference: {integrator: bdpt}'
experiment "100 million jobs" 1 '../in/e.yaml:1:1: the experiment has more than 100000 jobs' 's/^seeds.*/seeds: 100000/; $achains: [1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20]'
experiment "no such job" 2 'there is no job 99; the numbers are 1 to 4, see --list' '' --job 99
experiment "job 0" 2 '--job: ?0? is not possible; give a whole number from 1 on' '' --job 0
experiment "-1 at once" 2 '--jobs: ?-1? is not possible; give a whole number from 1 on' '' --jobs -1
experiment "NaN at once" 2 '--jobs: ?nan? is not possible; give a whole number from 1 on' '' --jobs nan
experiment "two deeds" 2 '--list and --collect do not go together' '' --list --collect
experiment "no job of that name" 2 'no job?s name matches ?nothing?; --list shows the names' '' --only nothing
refuse "results into a file" 1 'cannot make the folder ?x.exr?: File exists' bench ../in/tiny.yaml -o x.exr
refuse "results into /proc" 1 'cannot make the folder ?/proc/r?: No such file or directory' bench ../in/tiny.yaml -o /proc/r

kind="runs.csv, for bench"
results() { # results: a copy of good results among the older ones, as r
    cp -r in/results out/r
}
table() { # table WHAT STATUS WORDS COMMAND...: COMMAND makes out/r/runs.csv of in/results/runs.csv
    results
    eval "$4" <in/results/runs.csv >out/r/runs.csv
    remember
}
bench_on() {
    table "$@"
    refuse "$1" "$2" "$3" bench ../in/tiny.yaml -o r --references ../in
}
bench_on "another program's table" 1 'r/runs.csv:1: its columns are not those of this program: it was written by another version; move' 'echo name,value; echo a,1'
bench_on "a row of fewer cells" 1 'r/runs.csv:2: * cells, but the header has' 'sed "2s/,[^,]*$//"'
bench_on "a row of more cells" 1 'r/runs.csv:2: * cells, but the header has' 'sed "2s/$/,1/"'
bench_on "an unterminated string" 1 'r/runs.csv:3: a quotation mark that begins in this row is not closed' "sed '3s/,/,\"/'"
bench_on "binary garbage" 1 'r/runs.csv:1: its columns are not those of this program: it was written by another version; move' 'cat in/garbage'
bench_on "a folder" 1 'cannot read ?r/runs.csv?: not a regular file but a directory' ':; rm out/r/runs.csv; mkdir out/r/runs.csv; exec >/dev/null'

kind="results, for report"
report_on() { # as bench_on
    table "$@"
    refuse "$1" "$2" "$3" report r
}
refuse "missing folder" 1 'there is no runs.csv in ?no?; give a folder that etalon bench has written' report no
refuse "a file" 1 'there is no runs.csv in ?x.exr?; give a folder that etalon bench has written' report x.exr
refuse "an empty folder" 1 'there is no runs.csv in ?../in/folder.yaml?; give a folder that etalon bench has written' report ../in/folder.yaml
report_on "empty table" 1 'r/runs.csv:1: no column ?job?: this is no table of runs' ':'
report_on "a header alone" 1 'r/runs.csv: there are no finished runs in it yet' 'head -n 1'
report_on "another program's table" 1 'r/runs.csv:1: no column ?job?: this is no table of runs' 'echo name,value; echo a,1'
report_on "a row of fewer cells" 1 'r/runs.csv:2: * cells, but the header has' 'sed "2s/,[^,]*$//"'
report_on "a row of more cells" 1 'r/runs.csv:2: * cells, but the header has' 'sed "2s/$/,1/"'
report_on "an unterminated string" 1 'r/runs.csv:3: a quotation mark that begins in this row is not closed' "sed '3s/,/,\"/'"
report_on "binary garbage" 1 'r/runs.csv:1: no column ?job?: this is no table of runs' 'cat in/garbage'
report_on "a column twice" 1 'r/runs.csv:1: the column ?p_l? is here twice' 'sed "s/\$/,p_l/"'
report_on "NUL bytes" 1 'r/runs.csv:1: a zero byte: the file is damaged, or no table' 'tr "\n" "\0"'
table "" 0 "" "sed '1s/^/\xef\xbb\xbf/; s/\$/\r/'" && accept "CRLF and a byte order mark" report r --text
table "" 0 "" "sed '2,\$s/,[0-9.e-]*/,.nan/20g'" && accept "figures of NaN" report r --text
results && sed -i '2s/,.*/,x/' out/r/curves.csv && remember
refuse "a broken curve" 1 'r/curves.csv:2: 2 cells, but the header has' report r
results && tee out/r/images/*.exr <in/garbage >/dev/null && remember
warn "pictures of garbage" 'cannot read ?r/images/*.exr?: it is no OpenEXR file: the report does not' report r
results && remember
refuse "unknown axis" 2 '--axis: ?weeks? is not possible; give wall_s, cpu_s or mutations_per_pixel' report r --axis weeks
results && remember
refuse "unknown error" 2 '--error: ?mean? is not possible; give relmse, relmse_trimmed, mse or relmse_estimated' report r --error mean
results && remember
refuse "unknown baseline" 2 'no cell has the label ?nobody?; labels are a column of ?r/runs.csv?' report r --baseline nobody
results && mkdir out/r/report.html && remember
refuse "a folder as page" 1 'cannot write ?r/report.html?: it is a directory' report r

kind="runs.csv and baseline, for regress"
regress_on() {
    table "$@"
    refuse "$1" "$2" "$3" regress r --baseline ../in/baseline.csv
}
regress_on "empty table" 1 'r/runs.csv:1: no column ?label?: this is no table of runs' ':'
regress_on "a header alone" 1 'r/runs.csv: no run is in it' 'head -n 1'
regress_on "another program's table" 1 'r/runs.csv:1: no column ?label?: this is no table of runs' 'echo name,value; echo a,1'
regress_on "a row of fewer cells" 1 'r/runs.csv:2: * cells, but the header has' 'sed "2s/,[^,]*$//"'
regress_on "an unterminated string" 1 'r/runs.csv:3: a quotation mark that begins in this row is not closed' "sed '3s/,/,\"/'"
regress_on "binary garbage" 1 'r/runs.csv:1: no column ?label?: this is no table of runs' 'cat in/garbage'
baseline() { # baseline WHAT WORDS COMMAND...
    eval "$3" <in/baseline.csv >in/bad.csv
    refuse "baseline: $1" 1 "$2" regress ../in/results --baseline ../in/bad.csv
}
refuse "no baseline" 2 '--baseline FILE.csv is missing: what to compare with' regress ../in/results
refuse "missing results" 1 'there is no ?no/runs.csv?' regress no --baseline ../in/baseline.csv
refuse "baseline: missing file" 1 'cannot open ?no.csv?: No such file or directory' regress ../in/results --baseline no.csv
refuse "baseline: a folder" 1 'cannot read ?../in?: not a regular file but a directory' regress ../in/results --baseline ../in
baseline "empty file" '../in/bad.csv:1: no column ?scene_label?: this is no baseline; ?etalon regress RESULTS --baseline' ':'
baseline "binary garbage" '../in/bad.csv:1: the file ends within this line' 'cat in/garbage'
baseline "a header alone" '../in/bad.csv:1: it has no rows' 'head -n 1'
baseline "another table" '../in/bad.csv:1: no column ?budget?: this is no baseline; ?etalon regress RESULTS --baseline FILE' 'cat in/results/runs.csv'
baseline "half a file" '../in/bad.csv:*: the file ends within this line' 'head -c -5'
baseline "no number" '../in/bad.csv:9: value: ?x? is no number' "sed '9s/,[^,]*,[^,]*,[^,]*\$/,x,y,z/'"
baseline "NaN" '../in/bad.csv:9: value: ?.nan? is no number' "sed '9s/,[^,]*,[^,]*,[^,]*\$/,.nan,.nan,.nan/'"
baseline "a column less" '../in/bad.csv:1: no column ?se_within?: this is no baseline; ?etalon regress RESULTS --baseline' "sed 's/,[^,]*\$//'"
baseline "a statistic twice" '../in/bad.csv:10: statistic: ?bootstrap_paths? is here twice' "sed '9s/.*/&\\n&/'"
baseline "a negative standard error" '../in/bad.csv:9: se: ?-1? is no number from 0' "sed '9s/,[^,]*,[^,]*\$/,-1,2/'"
for value in 0 1 2 -1 nan sure; do
    refuse "--level $value" 2 "--level: '$value' is not possible; give a probability in (0,1)" regress ../in/results --baseline ../in/baseline.csv --level $value
done
refuse "an update and a level" 2 '--update compares nothing: without --level, --all and -o' regress ../in/results --baseline b.csv --update --level .1
refuse "an update that cannot be" 1 'cannot write ?no/b.csv?: there is no such folder' regress ../in/results --baseline no/b.csv --update
refuse "a table that cannot be" 1 'cannot write ?no/t.csv?: there is no such folder' regress ../in/results --baseline ../in/baseline.csv -o no/t.csv
put baseline.csv
refuse "a table over the baseline" 2 '-o ?baseline.csv? would overwrite the baseline: give another name' regress ../in/results --baseline baseline.csv -o baseline.csv
results && remember
refuse "a table over the results" 2 '-o ?r/runs.csv? would overwrite the results: give another name' regress r --baseline ../in/baseline.csv -o r/runs.csv
results && remember
refuse "a baseline over the results" 2 '--baseline ?r/runs.csv? would overwrite the results: give another name' regress r --baseline r/runs.csv --update
