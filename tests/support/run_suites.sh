# shellcheck shell=bash
# run_suites.sh - runs Meson's tests and counts them. Sourced, not run.
#
# `meson test` closes with one line for each outcome; what passed is Ok and Expected Fail, what
# failed is Fail (errors are in it), Unexpected Pass and Timeout.

# run_suites BUILD [arguments of meson test]: sets suites_passed and suites_failed. The run is a short one, unless
# DALCS_TEST_LONG=1 (some_of in dalcs_program.py). Tests in Python need Debian's, whose
# packages tools/packages.sh installs, whatever other comes first in PATH.
run_suites() {
    local build=$1 log scratch
    shift
    log=$(mktemp)
    scratch=$(scratch_folder)
    if [[ ${DALCS_TEST_LONG:-} != 1 ]]; then
        export DALCS_TEST_SHORT=1
    fi
    PATH=/usr/bin:$PATH TMPDIR=$scratch meson test -C "$build" --no-rebuild --print-errorlogs "$@" </dev/null 2>&1 | tee "$log" || true
    # shellcheck disable=SC2034 # for the caller
    suites_passed=$(sum_of_lines '^(Ok|Expected Fail):' "$log")
    suites_failed=$(sum_of_lines '^(Fail|Unexpected Pass|Timeout):' "$log")
    if ! grep -q '^Ok:' "$log"; then # Meson itself gave up
        suites_failed=$((suites_failed + 1))
    fi
    rm -rf "$log" "$scratch"
}

# scratch_folder: where tests write. Each run of the program has a folder of its own there: in memory such a test takes
# three quarters of the time that it takes on a disk. Some tests run programs that they have put there.
scratch_folder() {
    local free folder
    free=$(df --output=avail -k /dev/shm 2>/dev/null | tail -n 1)
    if ((${free:-0} > 4 * 1024 * 1024)) && folder=$(mktemp -d -p /dev/shm); then
        if cp /bin/true "$folder/true" && "$folder/true" 2>/dev/null; then
            echo "$folder"
            return
        fi
        rm -rf "$folder"
    fi
    mktemp -d
}

sum_of_lines() {
    awk -F: -v lines="$1" '$0 ~ lines { sum += $2 } END { print sum + 0 }' "$2"
}

# configure BUILD [options of meson setup]: makes a build folder, or gives an old one these options.
configure() {
    local build=$1
    shift
    if [[ -f $build/build.ninja ]]; then
        meson configure "$build" "$@"
    else
        meson setup "$build" "$@"
    fi
}
