#!/usr/bin/env bash
# expect_messages.sh - checks the messages about one netlist, word by word.
#
# usage: expect_messages.sh PROGRAM NAME.cir [--update]
#
# NAME.err beside the netlist holds what stderr must be, empty for no message. The exit status must be 3 when an
# error is among the messages, else 0. With --update, NAME.err is written instead: read it before you keep it.
# A shell, for there are hundreds of netlists, and Python takes longer to start than any of them to be read.
set -uo pipefail
program=$(realpath "$1")
# In the netlist's folder, so that the names in the messages and of included files are short.
cd "$(dirname "$2")" || exit 1
netlist=$(basename "$2")
expected=${netlist%.cir}.err

if [[ ${3-} == --update ]]; then
    "$program" "$netlist" 2>"$expected" >/dev/null
    exit 0
fi

status=0
if grep -qE '^[^[:space:]].*: error: ' "$expected"; then
    status=3
fi
"$program" "$netlist" 2>&1 >/dev/null | diff -u --label expected --label said "$expected" -
ended=("${PIPESTATUS[@]}")
if ((ended[0] != status)); then
    echo "exit status ${ended[0]}, expected $status"
fi
((ended[0] == status && ended[1] == 0))
