"""Does with the stand-in what `test_manifold.py` does with `manifold3d`: run in Node. The first argument is a
file with the inputs, the second the one for what comes out.
"""

import json
import sys
from pathlib import Path

ARGUMENTS = globals()["ARGUMENTS"]
sys.path.insert(0, "/host" + ARGUMENTS[2])
import booleans  # noqa: E402 - beside this file
import manifold3d  # noqa: E402 - the stand-in

given = json.loads(Path("/host" + ARGUMENTS[0]).read_text("utf-8"))
Path("/host" + ARGUMENTS[1]).write_text(json.dumps([booleans.told(manifold3d, each) for each in given]))
