#!/usr/bin/env bash
# render --live and --tev as a user has them: a page in a folder and at a port; what it
# serves; viewers of which one never reads, and a hundred malformed requests
# (tests/data/http_requests.txt; the answers: tests/unit/test_live_site.c), that change no
# bit of the picture; and what is refused before any work. The protocol of --tev: tests/unit/test_live_tev.c; the page in a browser:
# tests/page/test_live.sh. Broken once to see it fail: a server that hands out any file, and
# a look that advances the run.
set -u
. "$(dirname "$0")/lib.bash"
write_scene >scene.yaml
common=(-i pssmlt --threads 1 --seed 3 --set bootstrap=3000)

port=
url() { sed -n 's/^live: //p' "$1"; }
wait_url() { # wait_url ERR: until the server says where it is
    for _ in $(seq 200); do
        port=$(url "$1" | sed -n 's|^http://127.0.0.1:\([0-9]*\)/$|\1|p')
        [ -n "$port" ] && return
        sleep 0.05
    done
    return 1
}
get() { # get PATH: the answer, with its head
    exec 3<>"/dev/tcp/127.0.0.1/$port" || return 1
    printf 'GET %s HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n' "$1" >&3
    timeout 10 cat <&3
    exec 3<&-
}
holds() { grep -qF -- "$2" <<<"$(get "$1")"; } # holds PATH WORDS
send_malformed() ( # each on a connection of its own, which is then hung up
    trap '' PIPE
    while IFS= read -r request; do
        exec 4<>"/dev/tcp/127.0.0.1/$port" || return 1
        printf '%b' "$request" >&4 2>/dev/null
        exec 4<&-
    done <"$root/tests/data/http_requests.txt"
)
refused() { # refused WORDS ARGS...: one line that says so, before any work
    local words=$1
    shift
    "$etalon" render scene.yaml "${common[@]}" -o "${out:-no.exr}" "$@" >refused.out 2>refused.err && return 1
    [ "$(wc -l <refused.err)" -eq 1 ] && grep -qF -- "$words" refused.err && [ ! -e no.exr ] && [ ! -e no.part ]
}

# --- at a port -----------------------------------------------------------------------------
"$etalon" render scene.yaml "${common[@]}" --mpp 300 -o alone.exr >alone.out || exit 1
"$etalon" render scene.yaml "${common[@]}" --mpp 300 -o seen.exr --live 0 --view-every 0.1 \
    --tev localhost:9 >seen.out 2>seen.err &
pid=$!
check "the server says where it is" wait_url seen.err
exec 5<>"/dev/tcp/127.0.0.1/$port" # a viewer that never reads
printf 'GET / HTTP/1.1\r\nHost: x\r\n\r\nGET / HTTP/1.1\r\nHost: x\r\n\r\n' >&5
check "the page" holds / '<main id="live"'
check "its state" holds "/live.js?1" 'etalonState({'
check "no other file" holds /seen.exr "404 Not Found"
check "malformed requests are survived" send_malformed
check "the page is still there" holds / '<main id="live"'
check "and the run" kill -0 $pid
wait $pid
check "the run ends well" test $? -eq 0
exec 5<&-
"$etalon" compare alone.exr seen.exr >compare.out
check "bit for bit the picture" grep -qx "rmse: 0" compare.out

# --- in a folder ---------------------------------------------------------------------------
"$etalon" render scene.yaml "${common[@]}" --mpp 40 --reference alone.exr -o files.exr \
    --live page --view-every 0.1 >files.out 2>files.err
check "says where the page is" test "$(url files.err)" = page/index.html
for name in index.html live.js picture.js reference.js bars.js; do
    check "$name" test -s page/$name
done
check "nothing else" test "$(find page -type f | wc -l)" -eq 5
check "the end" grep -q '"ended": true' page/live.js
check "the verdict" grep -qF "$(sed -n 's/^verdict *\([a-z ]*\).*/\1/p' files.out)" page/live.js

# --- refusals ------------------------------------------------------------------------------
"$etalon" render scene.yaml "${common[@]}" --mpp 1e9 -o long.exr --live 0 >long.out 2>long.err &
pid=$!
wait_url long.err
check "a port in use" refused "in use; give another port" --live "$port"
kill -9 $pid
wait $pid 2>/dev/null
check "a folder that is a file" refused "this is no folder" --live scene.yaml
check "a folder without a parent" refused "cannot make this folder" --live no/such/folder
check "a folder that is not ours" refused "/proc" --live /proc/self
check "no such host" refused "no address of" --tev no.such.host.invalid:14158
check "no port" refused "give HOST:PORT" --tev localhost
check "a port of letters" refused "a number from 1 to 65535" --tev localhost:tev
check "an interval of nothing" refused "give a number of seconds above 0" --live page --view-every 0
check "an interval without a viewer" refused "needs a viewer" --view-every 1
out=no.part
check "a part" refused "needs the whole run" --live page --part 1/2
finish
