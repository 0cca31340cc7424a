#!/usr/bin/env bash
# packages.sh - which packages are missing, by false programs in place of those of three releases.
#
# usage: packages.sh TOOLS
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# shellcheck source=tools/packages.sh
source "$1/packages.sh"

program() {
    printf '#!/bin/bash\n%s\n' "$2" >"$folder/$1"
    chmod +x "$folder/$1"
}

# release GCC CLANG SDPA: what a release offers. Nothing is installed but meson.
release() {
    program apt-cache "case \$1/\$2 in
        depends/gcc) echo gcc; echo '  Depends: cpp'; echo '  Depends: gcc-$1'; echo '  Depends: gcc-x86-64-linux-gnu' ;;
        depends/clang) echo clang; echo '  Depends: clang-$2'; echo '  Breaks: <clang-3.2>' ;;
        policy/sdpa) echo sdpa:; echo '  Candidate: $3' ;;
    esac"
}

expect() {
    local got
    got=$(PATH=$folder:$PATH missing_packages "$1" | grep -E "$2" | tr '\n' ' ' || true)
    if [[ $got != "$3" ]]; then
        echo "FAIL: of group $1 is missing '$got', not '$3'" >&2
        exit 1
    fi
}

# shellcheck disable=SC2016 # the program expands it
program dpkg-query '[[ ${*: -1} != meson ]] || echo installed'
release 12 14 7.3.16+dfsg-1
expect build 'meson|gfortran|sdpa' 'libgfortran-12-dev sdpa '
expect ci 'clang-rt|@' 'libclang-rt-14-dev '
release 14 19 '(none)'
expect build 'meson|gfortran|sdpa|[?@]' 'libgfortran-14-dev '
expect ci 'clang-rt' 'libclang-rt-19-dev '
program dpkg-query 'echo installed'
expect build . ''
if missing_packages nonsense 2>/dev/null; then
    echo 'FAIL: there is a group nonsense' >&2
    exit 1
fi
