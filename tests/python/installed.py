#!/usr/bin/env python3
"""The module as `meson install` leaves it: where Python looks, whole, and it finds its library.

usage: installed.py SOURCE_FOLDER BUILD_FOLDER
"""

import os
import pathlib
import subprocess
import sys
import sysconfig
import tempfile

PROGRAM = """
import dalcs
print(dalcs.__file__)
print(dalcs.run("divider\\nV1 in 0 1\\nR1 in out 1\\nR2 out 0 3\\n.op\\n")["v(out)"][0])
"""


def main():
    build = sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["meson", "install", "-C", build, "--no-rebuild", "--destdir", folder], check=True,
                       stdout=subprocess.DEVNULL)
        root = pathlib.Path(folder)
        module, = root.rglob("dalcs/__init__.py")
        library = next(root.rglob("libdalcs.so.1")).parent
        place = module.parent.parent
        prefix = next(root.rglob("bin/dalcs")).parent.parent.relative_to(root)
        installed = "/" + str(place.relative_to(root))
        if prefix == pathlib.Path("usr/local") and "dist-packages" in sysconfig.get_path("purelib"):
            assert installed in sys.path or not os.path.exists(installed), f"Python does not look into {installed}"
            assert installed == sysconfig.get_path("purelib"), installed
        environment = {**os.environ, "PYTHONPATH": str(place), "LD_LIBRARY_PATH": str(library)}
        printed = subprocess.run([sys.executable, "-c", PROGRAM], check=True, capture_output=True, text=True,
                                 env=environment, cwd=folder).stdout
        assert printed.split() == [str(module), "0.75"], printed
        assert (module.parent / "py.typed").exists()
    print(f"installed in {installed}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
