"""What `aidl preview` and `aidl lsp` say when they cannot serve."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from aidl_lang.tools import cli
from aidl_lang.tools.cli import serving


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "part.aidl"
    path.write_text("solid a { body = circle(radius: 5) }\n", "utf-8")
    return str(path)


@pytest.mark.parametrize(
    ("arguments", "code", "what"),
    [(["preview", "part.aidl"], "E0952", "the preview"), (["lsp"], "E0954", "the server")],
)
def test_missing_packages_are_named(
    arguments: list[str], code: str, what: str, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    monkeypatch.setattr(serving, "find_spec", lambda name: None)
    assert cli.main(arguments) == 2
    assert capsys.readouterr().err == (
        f"error[{code}]: {what} needs `aidl_server`, not installed here\n"
        "  = hint: pip install 'aidl-lang[editor]'\n"
    )


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost"])
def test_a_port_that_is_taken_is_told(file: str, host: str, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert cli.main(["preview", file, "--no-open", "--port", str(port), "--host", host]) == 2
    assert f"error[E0953]: port {port} cannot be served: " in capsys.readouterr().err


@pytest.mark.parametrize(
    "options",
    [
        *(("--host", host) for host in ("0.0.0.0", "192.168.0.1", "::", "example.com", "")),
        *(("--port", port) for port in ("65536", "-1", "٣", "http")),
    ],
)
def test_only_this_machine_and_real_ports(
    file: str, options: tuple[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(["preview", file, *options])
    assert ended.value.code == 2
    assert "expected" in capsys.readouterr().err


@pytest.mark.parametrize(("name", "code"), [("-", "E0902"), ("nothing.aidl", "E0901"), (".", "E0902")])
def test_what_is_no_file_cannot_be_previewed(
    name: str, code: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["preview", name, "--no-open"]) == 2
    assert f"error[{code}]" in capsys.readouterr().err
