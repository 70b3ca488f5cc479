"""Files are the same in every process, whatever the seed of its hashes and whatever it wrote before."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import ezdxf

import aidl_lang
from tests.amount import TRIES_ALL
from tests.documents import ROOT

KEY = ROOT / "examples" / "key.aidl"
BEGINNINGS = {".svg": b"<?xml", ".dxf": b"  0\nSECTION", ".pdf": b"%PDF", ".json": b"{"}
SCRIPT = """
import pathlib, sys, aidl_lang
key = aidl_lang.compile(pathlib.Path(sys.argv[1]))
for suffix in sys.argv[2:]:
    pathlib.Path("key" + suffix).write_bytes(key.export(suffix))
"""


def test_the_same_bytes_in_every_process(tmp_path: Path) -> None:
    here = aidl_lang.compile(KEY)
    for seed in "1234" if TRIES_ALL else "1":
        environment = os.environ | {"PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)}
        words = [sys.executable, "-c", SCRIPT, str(KEY), *BEGINNINGS]
        subprocess.run(words, cwd=tmp_path, env=environment, check=True)
        for suffix, beginning in BEGINNINGS.items():
            data = (tmp_path / f"key{suffix}").read_bytes()
            assert data == here.export(suffix), suffix
            assert data.startswith(beginning)
            assert str(ROOT).encode() not in data
    assert not ezdxf.options.write_fixed_meta_data_for_testing
