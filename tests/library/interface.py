#!/usr/bin/env python3
"""What programs were built against: symbols, structs, values of constants, the soname.

usage: interface.py BUILD_FOLDER HEADER LIST [--write]

A program that runs with one library must run with the next one of the same DALCS_ABI. LIST says what
it relies on. Where this test fails and the change is meant: raise DALCS_ABI in the header if a
release with the old number is out there, then run it again with --write.
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))

from public_header import text_of  # noqa: E402


def output_of(*command):
    return subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=True).stdout


def fields(plain, name):
    """A number that changes with what stands between the braces of a struct."""
    start = end = plain.index(f"struct {name} {{")
    while plain.count("{", start, end) == 0 or (plain.count("{", start, end)
                                                > plain.count("}", start, end)):
        end += 1
    return f"{zlib.crc32(' '.join(plain[start:end].split()).encode()):08x}"


def measure(header, text):
    """Sizes of all structs whose contents a program sees, values of all enumerators and macros."""
    plain = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    structs = re.findall(r"\bstruct (dalcs_\w+) \{", plain)
    constants = re.findall(r"^#define (DALCS_(?:ABI|TOLERANCE\w+)) ", plain, re.MULTILINE)
    constants += re.findall(r"\bENTRY\((DALCS_\w+),", plain)
    for body in re.findall(r"\benum dalcs_\w+ \{([^}#]*)\}", plain):
        constants += re.findall(r"\b(DALCS_\w+)", body)
    assert len(structs) > 8 and len(constants) > 15, (structs, constants)
    lines = [f'printf("struct {name} %zu {fields(plain, name)}\\n", sizeof(struct {name}));'
             for name in structs]
    lines += [f'printf("constant {name} %g\\n", (double){name});' for name in constants]
    with tempfile.TemporaryDirectory() as folder:
        source, program = pathlib.Path(folder) / "a.c", pathlib.Path(folder) / "a"
        source.write_text(f'#include "{pathlib.Path(header).resolve()}"\n#include <stdio.h>\n'
                          "int main(void) { " + "\n".join(lines) + " return 0; }\n")
        output_of("gcc", source, "-o", program)
        return output_of(program).splitlines()


def main():
    build, header, committed = sys.argv[1:4]
    text = text_of(header)
    library = pathlib.Path(build) / "src" / "libdalcs.so"
    dynamic = output_of("readelf", "-d", library)
    found = ["soname " + re.search(r"soname: \[(.*)\]", dynamic)[1]]
    found += sorted("symbol " + line.split()[-1]
                    for line in output_of("nm", "-D", "--defined-only", library).splitlines())
    found += sorted(measure(header, text))
    if "--write" in sys.argv:
        pathlib.Path(committed).write_text("\n".join(found) + "\n", encoding="utf-8")
    wanted = pathlib.Path(committed).read_text(encoding="utf-8").splitlines()
    for line in sorted(set(wanted) - set(found)):
        print(f"gone: {line}")
    for line in sorted(set(found) - set(wanted)):
        print(f"new:  {line}")
    number = re.search(r"#define DALCS_ABI (\d+)", text)[1]
    if found[0] != f"soname libdalcs.so.{number}":
        print(f"{found[0]}, but DALCS_ABI is {number}")
        return 1
    if found != wanted:
        print("\nthe interface is not the one that is committed; see the start of this file")
        return 1
    print(f"{len(found)} lines agree")
    return 0


if __name__ == "__main__":
    sys.exit(main())
