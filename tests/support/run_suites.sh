# shellcheck shell=bash
# run_suites.sh - runs Meson's tests and counts them. Sourced, not run.
#
# `meson test` closes with one line for each outcome; what passed is Ok and Expected Fail, what
# failed is Fail (errors are in it), Unexpected Pass and Timeout.

# run_suites BUILD [arguments of meson test]: sets suites_passed and suites_failed.
run_suites() {
    local build=$1 log
    shift
    log=$(mktemp)
    meson test -C "$build" --no-rebuild --print-errorlogs "$@" </dev/null 2>&1 | tee "$log" || true
    # shellcheck disable=SC2034 # for the caller
    suites_passed=$(sum_of_lines '^(Ok|Expected Fail):' "$log")
    suites_failed=$(sum_of_lines '^(Fail|Unexpected Pass|Timeout):' "$log")
    if ! grep -q '^Ok:' "$log"; then # Meson itself gave up
        suites_failed=$((suites_failed + 1))
    fi
    rm -f "$log"
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
