"""Serves the tools over the Model Context Protocol, with guide, examples and reference as resources."""

from __future__ import annotations

import base64
import signal
from collections.abc import Callable
from pathlib import Path
from socket import socket
from typing import Any

from mcp.server.mcpserver import MCPServer
from mcp.server.mcpserver.exceptions import ResourceNotFoundError
from mcp_types import CallToolResult, ContentBlock, ImageContent, TextContent
from mcp_types import Tool as McpTool

from aidl_lang.common import resources
from aidl_lang.common.resources import resource
from aidl_lang.tools.agents.calling import Workers, for_mcp
from aidl_lang.tools.agents.tools import Tools
from aidl_lang.tools.agents.workspace import RefusalError, Workspace
from aidl_lang.version import __version__

INSTRUCTIONS = """\
AIDL is a text language for 2D CAD: say what a part is made of and how its parts relate; a solver finds the
coordinates. Read `guide` once before writing a program. Then write, `check` after every edit, and `compile`;
look at the picture. For a program that does not solve, `explain_conflict` names the constraints and the edits
that mend them: mend one, and do not delete what the user asked for. `search` and `explain` tell about names
and codes.
"""
_MARKDOWN, _AIDL = "text/markdown", "text/plain"


class Server(MCPServer[Any]):
    """Lists the tools as `schema` describes them, and has `workers` answer the calls."""

    def __init__(self, workers: Workers) -> None:
        super().__init__(
            "aidl", title="AIDL", version=__version__, instructions=INSTRUCTIONS, log_level="WARNING"
        )
        self.workers = workers
        _add_resources(self)
        _add_prompts(self)

    async def list_tools(self) -> list[McpTool]:
        return [McpTool.model_validate(tool) for tool in for_mcp()]

    async def call_tool(self, name: str, arguments: dict[str, Any], context: object = None) -> CallToolResult:
        made = await self.workers.answer(name, arguments)
        content: list[ContentBlock] = [TextContent(text=made.text)]
        content += [
            ImageContent(data=base64.b64encode(picture).decode(), mime_type="image/png")
            for picture in made.pictures
        ]
        if made.is_error:
            return CallToolResult(content=content, is_error=True)
        return CallToolResult(content=content, structured_content=dict(made.data))


def _add_resources(server: Server) -> None:
    def add(uri: str, title: str, kind: str, read: Callable[..., str]) -> None:
        name = uri.removeprefix("aidl://").partition("/{")[0]
        server.resource(uri, name=name, title=title, mime_type=kind)(read)

    add("aidl://guide", "The language on a few pages", _MARKDOWN, lambda: Tools().guide().text)
    for path in sorted(resource("examples").glob("*.aidl")):
        title = f"Example: {path.stem.replace('_', ' ')}"
        add(f"aidl://examples/{path.stem}", title, _AIDL, _reader(path))
    schema = _reader(resource("docs/model.schema.json"))
    add("aidl://model.schema.json", "JSON Schema of the solved model", "application/json", schema)
    add("aidl://diagnostics", "All codes of diagnostics", _MARKDOWN, _codes)
    add("aidl://diagnostics/{code}", "What a code means", _MARKDOWN, _page)
    add("aidl://reference/{name}", "All about a name of the library", _MARKDOWN, _page_of_name)


def _reader(file: Path) -> Callable[[], str]:
    return lambda: file.read_text("utf-8")


def _codes() -> str:
    return "\n".join(f"- {code}: {resources.title(code)}" for code in resources.codes())


def _page(code: str) -> str:
    if code.upper() not in resources.codes():
        raise ResourceNotFoundError(f"there is no code `{code[:60]}`; aidl://diagnostics lists all")
    return resources.page(code.upper())


def _page_of_name(name: str) -> str:
    try:
        return Tools().explain(name).text
    except RefusalError as error:
        raise ResourceNotFoundError(str(error)) from None


def _add_prompts(server: Server) -> None:
    def draw(request: str) -> str:
        return (
            f"Draw this with AIDL: {request}\n\nRead the `guide` first. Write the program, `check` it, "
            "`compile` it, and compare the picture with the request. Where sizes matter, `measure` them."
        )

    def mend(program: str) -> str:
        return (
            "Mend this AIDL program without losing anything that it means: `check` it, apply fixes, then "
            f"`compile`; if it does not solve, `explain_conflict` it.\n\n```aidl\n{program}\n```"
        )

    server.prompt("draw", title="Draw a part")(draw)
    server.prompt("mend", title="Mend a program")(mend)


def serve(root: Path | None = None, listener: socket | None = None, path: str = "/mcp") -> None:
    """Serves until the client goes: over standard streams, or HTTP on a bound socket at a secret path."""
    workers = Workers(Tools(Workspace(root)))
    server = Server(workers)
    try:
        if listener is None:
            # The SDK reads in a thread, which would keep an interrupted process waiting for input.
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            server.run("stdio")
        else:
            import uvicorn

            # Named so, the SDK refuses requests that name another host, as web pages could send.
            app = server.streamable_http_app(host="127.0.0.1", streamable_http_path=path)
            uvicorn.Server(uvicorn.Config(app, log_level="warning")).run(sockets=[listener])
    finally:
        workers.close()
