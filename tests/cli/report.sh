#!/usr/bin/env bash
# `etalon report` as a user runs it, without a browser: what the page holds, that it needs
# nothing beside itself, names that look like HTML, tables of other programs and broken
# ones, a folder that cannot be written, no gnuplot.
set -u
. "$(dirname "$0")/lib.bash"
write_scene >scene.yaml

cat >e.yaml <<'END_OF_EXPERIMENT'
experiment: whole
threads: 1
bootstrap: 1000
scenes:
  - {scene: scene.yaml, label: "box & <i>co"}
integrators:
  - pssmlt
  - {integrator: pfmlt, mode: paper, label: "\"paper\" </script><b>"}
large_step_probability: [auto, 0.3]
seeds: 2
budget: {mutations_per_pixel: 16}
reference: {integrator: bdpt, mutations_per_pixel: 32}
END_OF_EXPERIMENT
"$etalon" bench e.yaml -o r --references references >/dev/null 2>&1 || exit 1

report() { # report ARGS...: what it says in out and err
    "$etalon" report "$@" >out 2>err
}
has() { # has TEXT: the page, as it stands
    grep -qF -- "$1" r/report.html
}
hasnt() {
    ! has "$1"
}
count() { # count REGEX: lines of the page that match
    grep -cE -- "$1" r/report.html
}

# --- the page ----------------------------------------------------------------------------
# Not by time: which curves have it in common is then another matter each time.
check "a report" report r --axis mutations_per_pixel
check "says where" grep -qE '^r/report.html \([0-9.]+ MB\)$' out
check "nothing half-written" [ -z "$(find r -name '*.part*')" ]
check "no address of the net" [ "$(grep -oE '(https?|ftp|wss?):' r/report.html | wc -l)" = 0 ]
check "no source but data" [ -z "$(grep -oE '\b(src|srcset|href|action)="[^"]*"' \
    r/report.html | grep -vE '="(#|data:)')" ]
check "no import" [ -z "$(grep -E '@import|url\(' r/report.html)" ]
check "names are escaped" has 'box &amp; &lt;i&gt;co'
check "quotes too" has '&quot;paper&quot; &lt;/script&gt;&lt;b&gt;'
check "no name is HTML" hasnt '<i>co'
check "nor ends a script" [ "$(grep -o '</script>' r/report.html | wc -l)" = \
    "$(grep -o '<script' r/report.html | wc -l)" ]
check "the experiment's name" has '<h1>whole</h1>'
check "a row a cell" [ "$(sed -n '/id="errors-0"/,/<\/table>/p' r/report.html |
    grep -c '<tr><td class="method">')" = 4 ]
check "biased cells say so" [ "$(sed -n '/id="errors-0"/,/<\/table>/p' r/report.html |
    grep -c 'class="biased"')" = 2 ]
check "five pictures" [ "$(count '^<script type="application/octet-stream" id="picture-')" = 5 ]
check "one is the reference" [ "$(count '"isReference": true')" = 1 ]
check "the reference's noise" grep -qE 'references/box .*mean.exr</td>.*data-value="' r/report.html
check "whole runs" has '8 finished runs: 4 cells, 2 seeds.'
check "begins with the outcome" [ "$(grep -o '<section id="[a-z_]*"' r/report.html | head -n 1)" = \
    '<section id="outcome"' ]
check "who is best, by both errors" [ "$(grep -oE \
    'By relMSE (without the worst 1 % of pixels|of all pixels): [^<]* times its error[^<]*; 2 seeds\.' \
    r/report.html | wc -l)" = 2 ]
# pfmlt alone has a layer unasked, its map of failures; each of its two cells shows it.
check "layers" [ "$(grep -c '<h3>Layers: ' r/report.html)" = 2 ]
check "a legend each" [ "$(grep -c 'class="layers-legend"' r/report.html)" = 2 ]
check "a picture each" [ "$(grep -c 'src="data:image/png;base64,iVBORw0KGgo' r/report.html)" = 2 ]
check "both errors are columns" [ "$(sed -n '/id="errors-0"/,/<\/table>/p' r/report.html |
    grep -oE '>(trimmed )?relMSE</button>' | tr '\n' ' ')" = \
    '>trimmed relMSE</button> >relMSE</button> ' ]
check "variance and bias have errors" [ "$(sed -n '/id="split-0"/,/<\/table>/p' r/report.html |
    grep -c '±.*±.*2 seeds: not tested')" = 4 ]
job=$(sed -n 2p r/runs.csv | cut -d, -f 1)
for key in commit compiler flags; do
    value=$("$etalon" render scene.yaml --mpp 1 --set bootstrap=100 -o x.exr \
        --stats x.yaml >/dev/null 2>&1 && value $key x.yaml | tr -d '"')
    check "environment: $key" has "$value"
done
if command -v gnuplot >/dev/null; then
    check "plots" [ "$(count '^<svg')" -ge 4 ]
    check "no notes" hasnt 'id="notes"'
    check "nothing on stderr" [ ! -s err ]
fi
cp r/report.html first.html
check "again" report r --axis mutations_per_pixel
check "the same page" cmp first.html r/report.html

# --- without gnuplot ---------------------------------------------------------------------
PATH=/nowhere report r
check "without gnuplot: status 0" [ $? -eq 0 ]
check "one line says so" [ "$(grep -c . err)/$(grep -c '^warning: cannot run gnuplot' err)" = 1/1 ]
check "and a note in the page" has 'cannot run gnuplot'
check "no plots" [ "$(count '^<svg')" = 0 ]

# --- as text, other axes -----------------------------------------------------------------
rm r/report.html
check "as text" report r --text
check "has a line for the scene" grep -qF 'box & <i>co' out
check "and one in words" grep -qE '^  box & <i>co, 16 mutations per pixel: .* times its error.*2 seeds$' out
check "no error is nan" [ "$(grep -c 'variance .*+- [0-9.e-]*, bias^2 .*+- [0-9.e-]* (2 seeds' out)" = 4 ]
check "the trimmed noise is told" grep -qE '^Noise of the reference: relmse_trimmed [0-9]' out
check "another error" report r --text --error relmse
check "which regret goes by" grep -qF ': relmse against cpu_s ===' out
check "writes no page" [ ! -e r/report.html ]
check "by wall time, trimmed" report r --axis wall_s --error relmse_trimmed
check "says so" has 'at equal wall time'
check "in its tables too" has '>trimmed relMSE</button>'
check "another baseline" report r --baseline 'pssmlt p_l=0.3'

# --- what is missing ---------------------------------------------------------------------
mv references elsewhere
check "without the reference" report r
check "is noted" grep -q 'the reference that they were measured against was not found' err
check "references elsewhere" report r --references elsewhere
check "are found" [ "$(count '"isReference": true')" = 1 ]
mv elsewhere references
mv "r/images/$job.exr" kept.exr
check "without a picture" report r
check "is noted, in one line" [ "$(grep -c 'the report does not show it' err)" = 1 ]
check "and left out" [ "$(count '^<script type="application/octet-stream" id="picture-')" = 4 ]
mv kept.exr "r/images/$job.exr"
mv r/curves.csv kept.csv
check "without curves" report r
check "is noted too" has 'there is no curves.csv'
mv kept.csv r/curves.csv

# Few columns, as a table of long ago has them.
mkdir old
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; print "job,label,scene_label,seed,relmse"; next }
    { print $1 ",old " NR % 2 ",box," int(NR / 2) ",0.0" NR }' r/runs.csv >old/runs.csv
"$etalon" report old >out 2>err
check "a table of few columns" [ $? -eq 0 ]
check "has its cells" [ "$(grep -c '<tr><td class="method">old [01]' old/report.html)" -ge 2 ]

finish
