#!/usr/bin/env bash
# The page of `etalon report` in a browser: a small experiment, then test_report.py looks at
# its page. Wants chromium, chromedriver and selenium (Debian: chromium-driver,
# python3-selenium); where one is missing it is skipped. SHOTS=DIR keeps pictures of the page.
set -u
. "$(dirname "$0")/../cli/lib.bash"

. "$root/tests/page/browser.bash"

write_scene >scene.yaml
"$etalon" render scene.yaml -i bdpt --spp 64 --seed 99 -o ref.exr >/dev/null || exit 1
cat >e.yaml <<'END_OF_EXPERIMENT'
experiment: page
bootstrap: 2000
scenes: [{scene: scene.yaml, label: "box"}]
integrators:
  - pssmlt
  - {integrator: pfmlt, mode: paper, label: "<b>paper</b> & \"co\" </script>"}
large_step_probability: [auto, 0.02, 0.1, 0.6]
seeds: 4
budget: {mutations_per_pixel: 24}
reference: ref.exr
END_OF_EXPERIMENT
"$etalon" bench e.yaml -o results >/dev/null || exit 1
# Where a table that does not name its reference has it looked for.
mkdir -p references/box-0123456789abcdef
cp ref.exr references/box-0123456789abcdef/mean.exr
# Not by time: which curves have it in common is then another matter each time.
check "a report" "$etalon" report results --axis mutations_per_pixel
"$python" "$root/tests/page/test_report.py" "$PWD/results/report.html" "$PWD/ref.png" \
    "${SHOTS:-}" || failures=$((failures + 1))
finish
