# Sourced by the tests of pages: $python with selenium, and a browser, or the test is skipped.
# Not executable on its own.

skip() {
    echo "$*"
    exit 77
}
command -v chromium >/dev/null || skip "no chromium"
command -v chromedriver >/dev/null || skip "no chromedriver (chromium-driver)"
python=
for candidate in python3 /usr/bin/python3; do
    $candidate -c 'import selenium' 2>/dev/null && python=$candidate && break
done
[ -n "$python" ] || skip "no selenium (python3-selenium)"
