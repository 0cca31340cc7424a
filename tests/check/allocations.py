#!/usr/bin/env python3
"""Makes each kind of allocation of `dalcs check` fail, one after the other: it ends by itself with a status and a
message, or with the whole answer if it could do without that memory.

usage: allocations.py PROGRAM LIBRARY"""

import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "alloc")]
from preload import ONCE, calls_to_fail, refused_runs, runs_apart  # noqa: E402

NETLISTS = {
    "bridge": """bridge
V1 a b PWL(0 0 1m 0 1m 1)
R0 b 0 1
D1 a p
D2 b p
D3 m a
D4 m b
C1 p m 100u
S1 p q a b sw
R1 q m 1k
.model sw SW(Ron=0)
.tran 1m 30m
.end
""",
    "amplifier": """amplifier
D1 0 a
R1 a 0 1
D2 0 b
R2 b 0 1
C2 b 0 1u
G1 b 0 a 0 10
V1 c 0 1
D3 c d
C3 d 0 1
R3 d 0 -1
.op
.end
""",
}


def main(program, library):
    failures = 0
    for name, text in NETLISTS.items():
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "circuit.cir").write_text(text)
            command = [program, "check", "circuit.cir", "--json"]
            done, whole, numbers = calls_to_fail(library, command, folder)
            if done.returncode != 0:
                print(f"FAILED {name}: status {done.returncode}")
                return 1
            noticed = 0
            runs = runs_apart(library, command, folder, numbers) if name == "amplifier" else \
                refused_runs(library, command, folder, [(number, ONCE) for number in numbers])
            for again in runs:  # sdpa is asked about the amplifier
                error = again.stderr.decode(errors="replace").strip()
                good = again.returncode == 0 and again.stdout == done.stdout or \
                    1 <= again.returncode <= 4 and error
                noticed += again.returncode != 0
                if not good or again.tally.refused == 0:
                    failures += 1
                    print(f"FAILED {name} at {again.number}: status {again.returncode}: {error}")
            if noticed <= len(numbers) // 2:
                failures += 1
                print(f"FAILED {name}: only {noticed} of {len(numbers)} were noticed")
            print(f"{name}: {len(numbers)} of {whole.calls} allocations, {noticed} ended with an error")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
