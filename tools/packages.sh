# shellcheck shell=bash
# packages.sh - the packages of Debian 12 and 13 that each part of the project needs. Sourced, not run.
#
#   source tools/packages.sh
#   need_packages build test      installs what is missing of these groups
#
# `libgfortran-@gcc-dev` is the one for the gcc of this release. The project does without `sdpa?` where a release
# has none: Debian 13.

packages_of() {
    case $1 in
        build) echo gcc libc6-dev meson ninja-build pkg-config libsuitesparse-dev liblapacke-dev \
            libgfortran-@gcc-dev libglpk-dev libjansson-dev libjs-dygraphs libltdl-dev sdpa? uthash-dev ;;
        test) echo check g++ mandoc mkdocs mypy python3 python3-jsonschema python3-matplotlib \
            parallel python3-distributed python3-joblib python3-numpy python3-pandas python3-scipy python3-xarray ;;
        plot) echo gnuplot-nox ;;
        latex) echo texlive-latex-base ;;
        browser) echo chromium chromium-driver firefox-esr python3-selenium ;;
        wasm) echo emscripten dpkg-dev ;;
        crosscheck) echo lepton-eda libngspice0-dev ngspice python3 ;;
        kicad) echo kicad kicad-demos openbox xdotool xvfb ;;
        ci) echo clang libclang-rt-@clang-dev lld llvm valgrind clang-format codespell cppcheck python3-proselint shellcheck fish zsh ;;
        *)
            echo "packages.sh: no package group '$1'" >&2
            return 1
            ;;
    esac
}

package_is_installed() {
    [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# missing_packages GROUP...: one a line. The lists of a bare machine are empty: then versions are not yet known.
missing_packages() {
    local group name names compiler version
    for group in "$@"; do
        names=$(packages_of "$group") || return 1
        for name in $names; do
            if [[ $name =~ @([a-z]+) ]]; then
                compiler=${BASH_REMATCH[1]}
                version=$(apt-cache depends "$compiler" 2>/dev/null |
                    sed -n "s/^ *Depends: $compiler-\([0-9][0-9]*\)\$/\1/p")
                name=${name/@$compiler/$version}
            fi
            if package_is_installed "${name%'?'}"; then
                continue
            fi
            if [[ $name != *'?' ]] || apt-cache policy "${name%'?'}" 2>/dev/null | grep -q 'Candidate: [^(]'; then
                echo "${name%'?'}"
            fi
        done
    done
}

need_packages() {
    local missing as_root=()
    missing=$(missing_packages "$@") || return 1
    if [[ -z $missing ]]; then
        return 0
    fi
    if ((EUID != 0)); then
        as_root=(sudo)
    fi
    "${as_root[@]}" apt-get -q update >&2
    mapfile -t missing < <(missing_packages "$@")
    echo "Installing the Debian packages ${missing[*]}" >&2
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get -q install -y --no-install-recommends "${missing[@]}" >&2
}
