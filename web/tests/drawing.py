"""Compiles programs and writes what comes of them: run in Node. The first argument is the folder for the
files, the others are programs.
"""

from pathlib import Path

import aidl_lang

folder, *programs = (Path("/host" + each) for each in globals()["ARGUMENTS"])
for program in programs:
    made = aidl_lang.compile(program)
    for suffix in (".svg", ".json", ".dxf"):
        (folder / f"{program.parent.name}-{program.stem}{suffix}").write_bytes(made.export(suffix))
