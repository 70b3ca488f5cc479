"""What is loaded later of the package that writes SVG is the real thing once it is asked for."""

import subprocess
import sys

SCRIPT = """
import sys
from aidl_lang.export.svg import svgwrite

svg = svgwrite()
assert svg is sys.modules["svgwrite"] is svgwrite()
assert not {"urllib.request", "svgwrite.data.svgparser", "ssl"} & set(sys.modules)

checker = svg.drawing.SVG(debug=True).validator.typechecker  # it asks the real parser
assert checker.check("path-data", "M 0 0 L 1 1")
assert not checker.check("path-data", "no path")
assert "svgwrite.data.svgparser" in sys.modules

from urllib.request import Request

assert Request("http://localhost").host == "localhost"
try:
    svg.container.urlopen("none:")
except OSError as reason:
    assert "none" in str(reason)
else:
    raise AssertionError("an address that is none was opened")
"""

MEANWHILE = """
import sys
from aidl_lang.export.svg import _loaded_later

with _loaded_later("urllib.request", "urlopen"):
    from urllib.request import Request, urlopen  # as another thread does meanwhile
assert sys.modules["urllib.request"].Request is Request
assert Request.__module__ == "urllib.request"
try:
    urlopen("none:")
except OSError as reason:
    assert "none" in str(reason)
else:
    raise AssertionError("an address that is none was opened")
"""


def test_what_is_loaded_later_is_the_real_thing() -> None:
    subprocess.run([sys.executable, "-c", SCRIPT], check=True, timeout=60)


def test_who_asks_for_more_meanwhile_gets_the_module() -> None:
    subprocess.run([sys.executable, "-c", MEANWHILE], check=True, timeout=60)
