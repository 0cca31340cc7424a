# shellcheck shell=bash
# packages.sh - the Debian 12 packages that each part of the project needs. Sourced, not run.
#
#   source tools/packages.sh
#   need_packages build test      installs what is missing of these groups

packages_of() {
    case $1 in
        build) echo gcc libc6-dev meson ninja-build pkg-config libsuitesparse-dev liblapacke-dev \
            libgfortran-12-dev libglpk-dev libjansson-dev libjs-dygraphs libltdl-dev sdpa uthash-dev ;;
        test) echo check g++ mandoc mkdocs mypy python3 python3-jsonschema python3-matplotlib \
            parallel python3-distributed python3-joblib python3-numpy python3-pandas python3-scipy python3-xarray ;;
        plot) echo gnuplot-nox ;;
        latex) echo texlive-latex-base ;;
        browser) echo chromium chromium-driver firefox-esr python3-selenium ;;
        wasm) echo emscripten dpkg-dev ;;
        crosscheck) echo lepton-eda libngspice0-dev ngspice python3 ;;
        kicad) echo kicad kicad-demos openbox xdotool xvfb ;;
        ci) echo clang libclang-rt-14-dev lld llvm valgrind clang-format codespell cppcheck python3-proselint shellcheck fish zsh ;;
        *)
            echo "packages.sh: no package group '$1'" >&2
            return 1
            ;;
    esac
}

package_is_installed() {
    [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

need_packages() {
    local group names package missing=() as_root=()
    for group in "$@"; do
        names=$(packages_of "$group") || return 1
        for package in $names; do
            package_is_installed "$package" || missing+=("$package")
        done
    done
    if ((${#missing[@]} == 0)); then
        return 0
    fi
    echo "Installing the Debian packages ${missing[*]}" >&2
    if ((EUID != 0)); then
        as_root=(sudo)
    fi
    "${as_root[@]}" apt-get -q update >&2
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get -q install -y --no-install-recommends "${missing[@]}" >&2
}
