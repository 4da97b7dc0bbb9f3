#!/usr/bin/env bash
# check_links.sh [ROOT]: every file that a page (*.md) links to or shows is there, and so is
# the heading, where a link names one.
set -u
cd "${1:-$(dirname "$0")/..}" || exit 1

# anchors FILE: the names that GitHub gives its headings.
anchors() {
    sed -nE 's/^#+ +//p' "$1" | tr '[:upper:]' '[:lower:]' | sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'
}

status=0
for page in $(find . -name '*.md' -not -path './build/*' -not -path './results/*/*'); do
    for link in $(grep -oE '\]\([^) ]+\)|src="[^"]+"' "$page" | sed -E 's/^\]\(|\)$|^src="|"$//g'); do
        case $link in http*) continue ;; esac
        file=${link%%#*} target=$page
        [ -z "$file" ] || target=$(dirname "$page")/$file
        if [ ! -e "$target" ]; then
            echo "$page: $link: there is no $target"
            status=1
        elif [ "$link" != "$file" ] && ! anchors "$target" | grep -qxF "${link#*#}"; then
            echo "$page: $link: $target has no such heading"
            status=1
        fi
    done
done
exit $status
