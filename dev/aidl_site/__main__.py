"""`python -m aidl_site ROOT OUT`: builds the site (`make site`)."""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from aidl_site import checking
from aidl_site.blocks import PLAYGROUND
from aidl_site.staging import Staging

CONFIGURATION = Path(__file__).parent / "zensical.toml"


def build(root: Path, work: Path, builder: str, address: str | None, has_playground: bool) -> list[str]:
    """Builds the site into `work/site`, from pages that are written to `work/site-source`. Returns links that
    lead nowhere; nothing is built if there are any in the Markdown.
    """
    source = work / "site-source"
    staging = Staging(root, source / "pages", has_playground)
    staging.write()
    if staging.dead:
        return staging.dead
    shutil.rmtree(source / "site", ignore_errors=True)
    text = CONFIGURATION.read_text("utf-8")
    if address:
        text = text.replace("[project]\n", f'[project]\nsite_url = "{address}"\n', 1)
    (source / "zensical.toml").write_text(text, "utf-8")
    (source / "pages" / "aidl.css").write_bytes((CONFIGURATION.parent / "aidl.css").read_bytes())
    subprocess.run(
        [builder, "build", "--clean", "--config-file", "zensical.toml"],
        cwd=source,
        env=_environment(root),
        check=True,
    )
    _replace(work / "site", source / "site")
    return checking.dead(work / "site") if not has_playground else []


def _replace(old: Path, new: Path) -> None:
    """Puts what was built in the place of what there was; the playground, which is built by itself, stays."""
    old.mkdir(exist_ok=True)
    for path in old.iterdir():
        if path.is_dir() and path.name != PLAYGROUND.rstrip("/"):
            shutil.rmtree(path)
        elif path.is_file():
            path.unlink()
    for path in new.iterdir():
        path.rename(old / path.name)


def _environment(root: Path) -> dict[str, str]:
    """Returns the environment in which the builder, whose packages are its own, finds AIDL's lexer."""
    lark = find_spec("lark")
    assert lark is not None
    assert lark.origin is not None
    packages = Path(lark.origin).parent.parent
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(root), str(packages)]), "NO_COLOR": "1"}


def main() -> int:
    """Returns the exit code: 1 if a link leads nowhere."""
    parser = argparse.ArgumentParser(description="Build the site, or look for dead links in it.")
    parser.add_argument("root", type=Path, help="the checkout")
    parser.add_argument("--builder", default="zensical", metavar="COMMAND", help="Zensical's command")
    parser.add_argument("--address", metavar="URL", help="where the site will be found")
    parser.add_argument("--playground", action="store_true", help="link programs to the playground")
    parser.add_argument("--check", action="store_true", help="only look for dead links in what is built")
    options = parser.parse_args()
    root, work = options.root.resolve(), options.root.resolve() / "build"
    if options.check:
        dead = checking.dead(work / "site")
    else:
        builder = shutil.which(options.builder)
        if builder is None:
            parser.error(f"there is no command `{options.builder}`; `make site` installs it")
        try:
            dead = build(root, work, os.path.abspath(builder), options.address, options.playground)
        except (OSError, subprocess.CalledProcessError) as reason:
            sys.exit(f"the site is not built: {reason}")
    for link in dead:
        sys.stderr.write(f"dead link: {link}\n")
    return bool(dead)


if __name__ == "__main__":
    sys.exit(main())
