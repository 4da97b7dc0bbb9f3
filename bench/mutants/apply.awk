# awk -v root=DIR [-v check=1] -f apply.awk NN-name.edit: applies an edit to the files below
# DIR, or with check only looks whether it could. An edit is a diff without places:
#
#     breaks: what is wrong with the program now
#     expects: stat/test_x unit/test_y ...
#     file: src/room/file.c
#     -the lines that go
#     +the lines that come
#
# Lines are found by what they say, indentation aside; they must stand together, and in one
# place only. Ends with 1 and a line on stderr if not.
function fail(text) {
    print FILENAME ": " text >"/dev/stderr"
    failed = 1
    exit 1
}
function trim(text) {
    gsub(/^[ \t]+|[ \t]+$/, "", text)
    return text
}
function load(i, path) {
    path = root "/" file
    count = 0
    while ((getline line <path) > 0)
        lines[++count] = line
    close(path)
    if (count == 0)
        fail("no " file)
}
function store(path, i) {
    path = root "/" file
    for (i = 1; i <= count; i++)
        print lines[i] >path
    close(path)
}
function replace(at, i, n, k) {
    if (gone == 0)
        return
    n = 0
    for (i = 1; i + gone - 1 <= count; i++) {
        for (k = 1; k <= gone && trim(lines[i + k - 1]) == trim(old[k]); k++)
            ;
        if (k > gone) {
            at = i
            n++
        }
    }
    if (n != 1)
        fail(file ": '" trim(old[1]) "' stands there " n " times")
    for (i = count; i >= at + gone; i--)
        lines[i + 1000] = lines[i]
    for (i = 1; i <= come; i++)
        lines[at + i - 1] = new[i]
    for (i = at + gone; i <= count; i++)
        lines[i + come - gone] = lines[i + 1000]
    count += come - gone
    gone = come = 0
}
function finish() {
    if (file == "")
        return
    replace()
    if (!check)
        store()
}
/^file:/ {
    finish()
    file = trim(substr($0, 6))
    load()
}
/^-/ {
    if (come > 0)
        replace()
    old[++gone] = substr($0, 2)
}
/^\+/ { new[++come] = substr($0, 2) }
END {
    if (!failed)
        finish()
    exit failed
}
