"""The script in the README answers for a model."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from aidl_lang.tools.cli import main

README = (Path(__file__).parents[2] / "README.md").read_text("utf-8")
PLATE = "solid plate { outline = rectangle(width: 60, height: 40) }\n"
MODEL = """import sys
prompt = sys.stdin.read()
assert prompt.startswith("[system]\\n# AIDL in a few pages"), prompt[:60]
assert "[user]\\nWrite a program that draws this: a hinge" in prompt
print("```aidl\\n" + open("plate.aidl").read() + "```")
"""


def test_the_script_of_the_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scripts = [s for s in re.findall(r"```python\n(.*?)```", README, re.S) if "reply.py" in s]
    (tmp_path / "reply.py").write_text(scripts[0], "utf-8")
    (tmp_path / "model.py").write_text(MODEL, "utf-8")
    (tmp_path / "plate.aidl").write_text(PLATE, "utf-8")
    monkeypatch.chdir(tmp_path)
    provider = f"exec:{sys.executable} reply.py {sys.executable} model.py"
    assert main(["generate", "a hinge", "-o", "hinge.aidl", "--provider", provider]) == 0
    assert (tmp_path / "hinge.aidl").read_text("utf-8") == PLATE
