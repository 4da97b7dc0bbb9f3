#!/usr/bin/env bash
# The page of a run that is going on in a browser, from a port and from files: test_live.py
# looks at it. Wants what test_report.sh wants, and is skipped where it is missing. SHOTS=DIR
# keeps pictures of the page.
set -u
. "$(dirname "$0")/../cli/lib.bash"
. "$root/tests/page/browser.bash"

write_scene >scene.yaml
common=(-i pssmlt --threads 1 --size 64x48 --set bootstrap=3000 --view-every 0.5)
"$etalon" render scene.yaml -i bdpt --spp 64 --seed 99 --size 64x48 -o ref.exr >/dev/null || exit 1
"$etalon" render scene.yaml "${common[@]}" --mpp 4000 -o long.exr --reference ref.exr --live 0 \
    >long.out 2>long.err &
pid=$!
trap 'kill -9 $pid 2>/dev/null; rm -rf "$tmp"' EXIT
for _ in $(seq 200); do
    url=$(sed -n 's/^live: //p' long.err)
    [ -n "$url" ] && break
    sleep 0.05
done
"$python" "$root/tests/page/test_live.py" "$url" $pid "${SHOTS:-}" || failures=$((failures + 1))
check "a run with a page in a folder" "$etalon" render scene.yaml "${common[@]}" --mpp 60 \
    -o files.exr --live page >/dev/null
"$python" "$root/tests/page/test_live.py" "file://$PWD/page/index.html" 0 "${SHOTS:-}" ||
    failures=$((failures + 1))
finish
